/* Where the next step ends: at an event if there is one, and whether time runs as a square next to it. */
#ifndef TRUM_ORBIT_AIM_H
#define TRUM_ORBIT_AIM_H

/* What comes next for every lane: its step, and how that bends towards an event or away from one. */
typedef struct {
  real h, bend, target;
  mask redo, hit; /* the step is to be tried anew; it ends at the event that it was aimed at */
} trum_plan;

/* How near to an event is at it; nearer where slopes are wanted.  A rotor that is held is as fast as the surface where
 * that stands still, which it touches and does not cross: no step gets as near as slopes want. */
static real trum_nearness(const trum_lanes* l, real which, real of_slopes) {
  const mask speed = trum_same(which, N_(SPEED)), full = trum_same(which, N_(FULL));
  const real nearness = sel(speed | full, l->event_error, l->kink_error);
  return sel(speed & at_most(l->push, N_(0)), nearness, least(nearness, of_slopes));
}

/* Steps end at events.  One that meets an event is aimed at it; one that was aimed there is corrected until it hits. */
static trum_plan trum_aim(trum_lanes* l, trum_attempt* t, mask tiny) {
  const mask aimed = at_most(N_(0), l->target), startled = less_than(l->bend, N_(0));
  const mask patient = less_than(l->tries, N_(10)) & no(tiny); /* no step is tried for ever */
  trum_plan p;
  trum_cubic cubic[EVENTS];
  real place, which, tolerance;
  mask meets, singular, distant, late, off_target = is(0);
  int j, k;
  p.h = l->h, p.bend = l->bend, p.target = l->target, p.hit = is(0);
  trum_first_event(l, t->z, t->e, cubic, &place, &which);
  meets = patient & less_than(place, N_(1.5));
  if (any(aimed)) {
    real root = N_(1), missed = N_(0);
    trum_cubic q = cubic[0];
    for (k = 0; k < EVENTS; ++k) {
      const mask mine = trum_same(l->target, N_(k));
      q.e0 = sel(mine, cubic[k].e0, q.e0), q.d1 = sel(mine, cubic[k].d1, q.d1);
      q.d2 = sel(mine, cubic[k].d2, q.d2), q.d3 = sel(mine, cubic[k].d3, q.d3);
      missed = sel(mine, size_of(t->e[EDGE][k]), missed);
    }
    for (j = 0; j < 3; ++j) { /* it may lie beyond the step's end */
      const real slope = trum_cubic_slope(&q, root);
      const mask steep = less_than(N_(1e-200), size_of(slope));
      root = sel(steep, root - trum_cubic_at(&q, root) * inverse_of(sel(steep, slope, N_(1))), root);
      root = most(N_(1), least(N_(1.25), root));
    }
    root = sel(trum_same(which, l->target), place, root);
    singular = trum_same(l->target, N_(SPEED)) | trum_same(l->target, N_(FULL));
    missed = size_of(root - N_(1)) * l->h * sel(singular, N_(1), missed);
    tolerance = trum_nearness(l, l->target, l->ends);
    p.hit = aimed & less_than(root, N_(1.24)); /* else it turned out to be none */
    off_target = p.hit & patient & less_than(tolerance, missed);
    p.hit = p.hit & no(off_target);
    /* another event on the way comes first */
    meets = meets & no((p.hit | off_target) & trum_same(which, l->target));
    p.h = sel(off_target, l->h * root, p.h);
  }
  singular = trum_same(which, N_(SPEED)) | trum_same(which, N_(FULL));
  tolerance = trum_nearness(l, which, l->begins);
  { /* what a kink weighs is its distance times the pressure there */
    const real weight = sel(trum_same(which, N_(LARGER)), size_of(t->e[0][LARGER]), size_of(t->e[0][SMALLER]));
    distant = meets & less_than(tolerance, place * l->h * sel(singular, N_(1), weight));
  }
  late = meets & no(distant);
  { /* towards it; a step cannot bend at both ends, so one that begins at a square root goes half the way */
    const mask half = distant & startled & singular;
    p.h = sel(distant, l->h * place * sel(half, N_(0.5), N_(1)), p.h);
    p.target = sel(distant, sel(half, N_(-1), which), p.target);
    p.bend = sel(distant & no(startled), sel(singular, N_(1), N_(0)), p.bend);
  }
  p.redo = distant | off_target;
  for (k = 0; k < EVENTS; ++k) { /* an event at the very start was passed unseen: begin at it */
    const mask mine = late & trum_same(which, N_(k)) & no(l->fresh[k]);
    l->fresh[k] = l->fresh[k] | mine;
    p.redo = p.redo | mine;
    if (k == SPEED || k == FULL) p.bend = sel(mine, N_(-1), p.bend);
    /* with slopes a kink at the start leaves the aim where it is: the step may be bent to it */
    if (!l->slopes || k == SPEED || k == FULL) p.target = sel(mine, N_(-1), p.target);
  }
  return p;
}

#endif
