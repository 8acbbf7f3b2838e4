/* Steps and events: a step ends at the first event that it meets.
 *
 * Time in a step is t = h s (1 + c (1 - s)) for s from 0 to 1.  With curvature c = 1 time runs as a square before the
 * step's end, with c = -1 after its start: a square root of time there is smooth in s. */
#ifndef TRUM_ORBIT_EVENT_STEPS_H
#define TRUM_ORBIT_EVENT_STEPS_H

/* The next attempt of every lane: length, curvature and the event that it is to end at (-1: none). */
typedef struct {
  real h, curvature, target_event;
  real root_error; /* of the integral of f, by ending beside a square root */
  mask retry, at_target; /* repeat the step; it has ended at its target */
  trum_cubic saturation; /* R_v^2 - v^2 in the step */
} trum_next_step;

/* The distance at which a step counts as having reached an event: smaller with slopes (of_slopes).  A held rotor
 * is as fast as the surface only where the surface stands still, without crossing: there the larger one holds. */
static real trum_event_tolerance(const trum_lanes* lanes, real event, real of_slopes) {
  const mask speed = trum_is_event(event, REAL(EVENT_SATURATION));
  const mask full = trum_is_event(event, REAL(EVENT_FULL_CONTACT));
  const real tolerance = where(speed | full, lanes->tolerances.root, lanes->tolerances.kink);
  return where(speed & at_most(lanes->equation.push, REAL(0)), tolerance, minimum(tolerance, of_slopes));
}

/* Shortens a step that meets an event so that it ends there, and corrects one that should have ended there, until the
 * distance is within tolerance. */
static trum_next_step trum_adjust_to_events(trum_lanes* lanes, trum_trial_step* trial, mask minimal) {
  const mask aimed = at_most(REAL(0), lanes->step.target_event);
  const mask starts_at_root = less_than(lanes->step.curvature, REAL(0));
  const mask may_retry = less_than(lanes->step.retries, REAL(10)) & mask_not(minimal); /* a bound on repetitions */
  trum_next_step next;
  trum_cubic cubic[EVENT_COUNT];
  real location, event, tolerance;
  mask meets_event, is_root, close, ahead, at_start, misses = mask_all(0);
  int j, k;
  next.h = lanes->step.h, next.curvature = lanes->step.curvature, next.target_event = lanes->step.target_event;
  next.at_target = mask_all(0), next.root_error = REAL(0);
  trum_locate_first_event(lanes, trial->z, trial->events, cubic, &location, &event);
  next.saturation = cubic[EVENT_SATURATION];
  /* stiff motion goes to and fro over events until it is damped */
  meets_event = may_retry & less_than(location, REAL(1.5)) & mask_not(trial->damped);
  is_root = trum_is_event(event, REAL(EVENT_SATURATION)) | trum_is_event(event, REAL(EVENT_FULL_CONTACT));
  tolerance = trum_event_tolerance(lanes, event, lanes->tolerances.slope_start);
  { /* the error of passing a kink is in proportion to its distance times the pressure on the way there */
    real weight = REAL(0);
    for (k = EVENT_LARGER_PRESSURE; k <= EVENT_SMALLER_PRESSURE; ++k)
      weight = where(trum_is_event(event, REAL(k)),
                     absolute(where(lanes->start.at_event[k], trial->events[1][k], trial->events[0][k])), weight);
    close = at_most(location * lanes->step.h * where(is_root, REAL(1), weight), tolerance); /* to the step's start */
  }
  if (any_lane(aimed)) {
    real root = REAL(1), distance = REAL(0);
    mask same;
    trum_cubic q = cubic[0];
    for (k = 0; k < EVENT_COUNT; ++k) {
      const mask is_this = trum_is_event(lanes->step.target_event, REAL(k));
      q.e0 = where(is_this, cubic[k].e0, q.e0), q.d1 = where(is_this, cubic[k].d1, q.d1);
      q.d2 = where(is_this, cubic[k].d2, q.d2), q.d3 = where(is_this, cubic[k].d3, q.d3);
      distance = where(is_this, absolute(trial->events[LAST_NODE][k]), distance);
    }
    for (j = 0; j < 3; ++j) { /* Newton; the event may lie beyond the step's end */
      const real slope = trum_cubic_slope(&q, root);
      const mask usable = less_than(REAL(trum_no_slope), absolute(slope));
      root = where(usable, root - trum_cubic_at(&q, root) * reciprocal(where(usable, slope, REAL(1))), root);
      root = maximum(REAL(1), minimum(REAL(1.25), root));
    }
    same = trum_is_event(event, lanes->step.target_event) & mask_not(close);
    root = where(same, location, root);
    is_root = trum_is_event(lanes->step.target_event, REAL(EVENT_SATURATION)) |
              trum_is_event(lanes->step.target_event, REAL(EVENT_FULL_CONTACT));
    distance = absolute(root - REAL(1)) * lanes->step.h * where(is_root, REAL(1), distance);
    tolerance = trum_event_tolerance(lanes, lanes->step.target_event, lanes->tolerances.slope_end);
    next.at_target = aimed & less_than(root, REAL(1.24)); /* else there is no event after all */
    misses = next.at_target & may_retry & less_than(tolerance, distance);
    { /* f goes as the root of the time to the event: what that sums up to over the distance, before it and after it */
      const real time = absolute(root - REAL(1)) * lanes->step.h;
      const real steepness = absolute(trial->f[LAST_NODE] - trial->f[2]) * REAL(1 / 0.27639320225002103);
      next.root_error = where(is_root & next.at_target,
                              REAL(2) * steepness * time * square_root(time * reciprocal(lanes->step.h)), REAL(0));
    }
    next.at_target = next.at_target & mask_not(misses);
    /* another event before the target comes first */
    meets_event = meets_event & mask_not((next.at_target | misses) & same);
    next.h = where(misses, lanes->step.h * root, next.h);
  }
  is_root = trum_is_event(event, REAL(EVENT_SATURATION)) | trum_is_event(event, REAL(EVENT_FULL_CONTACT));
  ahead = meets_event & mask_not(close);
  at_start = meets_event & mask_not(ahead);
  { /* a step has curvature at one end only, so one that begins at a square root goes half the way to the next */
    const mask half = ahead & starts_at_root & is_root;
    next.h = where(ahead, lanes->step.h * location * where(half, REAL(0.5), REAL(1)), next.h);
    next.target_event = where(ahead, where(half, REAL(-1), event), next.target_event);
    next.curvature = where(ahead & mask_not(starts_at_root), where(is_root, REAL(1), REAL(0)), next.curvature);
  }
  next.retry = ahead | misses;
  for (k = 0; k < EVENT_COUNT; ++k) { /* an event within tolerance of the step's start: the step begins at it */
    const mask is_this = at_start & trum_is_event(event, REAL(k)) & mask_not(lanes->start.at_event[k]);
    lanes->start.at_event[k] = lanes->start.at_event[k] | is_this;
    next.retry = next.retry | is_this;
    if (k == EVENT_SATURATION || k == EVENT_FULL_CONTACT) next.curvature = where(is_this, REAL(-1), next.curvature);
    /* with slopes a kink at the start leaves the target: the step may be curved towards it */
    if (!with_slopes(lanes) || k == EVENT_SATURATION || k == EVENT_FULL_CONTACT)
      next.target_event = where(is_this, REAL(-1), next.target_event);
  }
  return next;
}

#endif
