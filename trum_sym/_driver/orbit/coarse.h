/* Where the orbit is, about: laps of equal steps, by Adams and Moulton's rule of order 3 with one evaluation of surface and
 * friction a step.  They prove nothing; the laps that do begin where these end, so that far fewer of them are needed. */
#ifndef TRUM_ORBIT_COARSE_H
#define TRUM_ORBIT_COARSE_H

/* Coarse laps in the lanes: the rate of x at the last node and the one before, and friction's slope there; where the segment
 * begins in its region, the length of its steps, how many it has and how many are done. */
typedef struct {
  real rate, rate_before, slope, since, h, steps, done;
} trum_coarse;

/* Begins a segment in a lane, whose region is there: whole steps, about of equal length. */
static void trum_begin_coarse_segment(const trum_search* search, int i, trum_coarse* c) {
  const trum_segment* segment = &search->segment_of[search->segment];
  const trum_real per_period = search->laps ? trum_coarse_steps : trum_first_coarse_steps;
  const trum_real steps = trum_ceil(per_period * segment->duration / search->period - TRUM_C(1e-6));
  set_lane(&c->since, i, segment->since), set_lane(&c->h, i, segment->duration / steps);
  set_lane(&c->steps, i, steps), set_lane(&c->done, i, 0);
}

/* Begins a coarse lap. */
static void trum_begin_coarse_lap(trum_lanes* lanes, int i, trum_search* search, trum_coarse* c) {
  search->in_turn = 1, trum_prepare_lap(search, 0), search->segment = 0;
  trum_start_segment(lanes, i, search, 0);
  trum_begin_coarse_segment(search, i, c);
}

/* Rates at the start of laps. */
static void trum_coarse_starts(trum_lanes* lanes, trum_coarse* c) {
  trum_surface at;
  trum_friction_state friction;
  const mask here = lanes->status.at_lap_start;
  trum_surface_at(&lanes->constants, &lanes->region, with_hertz(lanes), lanes->step.tau, &at);
  trum_friction_at(&at, lanes->equation.v0 + lanes->start.x, &friction);
  c->rate = where(here, lanes->equation.push * friction.f - lanes->equation.drag, c->rate);
  c->slope = where(here, minimum(REAL(0), friction.f_v), c->slope);
  lanes->status.at_lap_start = mask_all(0);
}

/* A step on the lanes whose segment has not ended, given the surface at its end. */
static void trum_coarse_step(trum_lanes* lanes, trum_coarse* c, const trum_surface* at) {
  const mask active = lanes->status.active & less_than(c->done, c->steps), first = less_than(c->done, REAL(0.5));
  const real h = c->h, push = lanes->equation.push, x = lanes->start.x, most = h * (push + absolute(lanes->equation.drag));
  const real weight = where(first, REAL(0.5), REAL(TRUM_GRID_NEW_WEIGHT)); /* what a segment's first step lacks is the rate before */
  const real known = x + h * where(first, REAL(0.5) * c->rate,
                                  REAL(TRUM_GRID_OLD_WEIGHT) * c->rate + REAL(TRUM_GRID_BEFORE_WEIGHT) * c->rate_before);
  const real guess = x + h * c->rate;
  trum_lap* lap = &lanes->lap;
  trum_friction_state friction;
  real next, slope, f, stiff, S;
  trum_friction_at(at, lanes->equation.v0 + guess, &friction);
  slope = minimum(REAL(0), friction.f_v);
  next = guess + (known + weight * h * (push * friction.f - lanes->equation.drag) - guess) *
                     reciprocal(REAL(1) - weight * h * push * slope);
  next = maximum(x - most, minimum(x + most, next));
  f = maximum(REAL(-1), minimum(REAL(1), friction.f + slope * (next - guess)));
  stiff = REAL(-0.5) * h * push * (slope + c->slope);
  S = lanes->start.S * trum_decay(minimum(REAL(1), stiff)); /* friction's slope has no bound next to saturation */
  lap->stiffest = where(active, maximum(lap->stiffest, REAL(-1) * h * push * maximum(slope, c->slope)), lap->stiffest);
  lap->S = where(active, lap->S + REAL(0.5) * h * (lanes->start.S + S), lap->S);
  lap->low = where(active, minimum(lap->low, next), lap->low), lap->high = where(active, maximum(lap->high, next), lap->high);
  lap->fastest = where(active, maximum(lap->fastest, at->R_v), lap->fastest);
  lanes->start.S = where(active, S, lanes->start.S), lanes->start.x = where(active, next, x);
  c->rate_before = where(active, c->rate, c->rate_before);
  c->rate = where(active, push * f - lanes->equation.drag, c->rate), c->slope = where(active, slope, c->slope);
  c->done = where(active, c->done + REAL(1), c->done);
}

/* A coarse lap has ended: Newton's step, and whether there is to be another. */
static int trum_finish_coarse_lap(const trum_lanes* lanes, int i, trum_search* search) {
  trum_lap_summary s;
  trum_real next, change;
  int k;
  trum_read_lap(lanes, i, &search->lap);
  search->lap.remainder = trum_coarse_error * trum_larger(trum_fabs(search->lap.low), trum_fabs(search->lap.high));
  search->lap.error = search->jumps = 0;
  s = trum_summarise_lap(search);
  trum_compare_laps(search, &s);
  trum_update_bracket(search, &s);
  next = trum_next_start(search, &s), change = next - search->start_speed;
  search->newton.last_step = trum_fabs(change);
  trum_record_lap(search, &s);
  search->start_speed = next;
  for (k = 1; k < search->segments; ++k) search->at[k].speed += search->at[k].S * change;
  return s.certain && trum_fabs(change) > trum_coarse_enough * s.top && search->laps < trum_most_coarse_laps;
}

/* Begins the coarse laps of a point, unless it has no need of them. */
static int trum_begin_coarse_orbit(trum_lanes* lanes, int i, trum_search* search, const trum_orbit_in* in, trum_orbit_out* unused,
                                   trum_coarse* c) {
  trum_begin_task(lanes, search, in, unused);
  trum_begin_roughly(search);
  trum_begin_coarse_lap(lanes, i, search, c);
  return trum_has_cycle(search) && in->push > trum_fabs(in->drag) && !search->repetition.is_long && !trum_is_balance(in);
}

/* What coarse laps have found, unless they have gone astray. */
static void trum_keep_coarse_orbit(const trum_search* search, trum_coarse_orbit* found) {
  int k;
  found->found = trum_fabs(search->start_speed) < TRUM_HUGE;
  found->start_speed = search->start_speed, found->top = search->top, found->stiff = search->lap.stiffest > trum_coarse_stiff;
  found->newton = search->newton, found->bracket = search->bracket;
  for (k = 0; k < search->segments; ++k) found->at[k] = search->at[k];
}

/* Counts an attempt at a step, of those that a call may still take (null: any number); 0 if there is none left. */
static int trum_may_attempt(int_least32_t* attempts) {
  if (!attempts) return 1;
  if (*attempts <= 0) return 0;
  --*attempts;
  return 1;
}

/* Coarse laps of as many points as there are lanes at most.  Where few lanes have one, several nodes ahead are evaluated at
 * once.  Eight steps count as an attempt at one of the others; returns 0 if these were used up. */
static int trum_coarse_orbits(trum_lanes* lanes, trum_search* searches, const trum_orbit_in* in, trum_coarse_orbit* found,
                              int count, int_least32_t* attempts) {
  trum_coarse c;
  int rounds = 0;
  trum_orbit_out unused;
  int busy[TRUM_LANES], i, j;
  c.rate = c.rate_before = c.slope = TRUM_NUMBER(0);
  for (i = 0; i < TRUM_LANES; ++i) {
    busy[i] = trum_begin_coarse_orbit(lanes, i, &searches[i], &in[i < count ? i : 0], &unused, &c) && i < count;
    set_lane_mask(&lanes->status.active, i, busy[i]);
    if (i < count) found[i].found = busy[i];
  }
  while (any_lane(lanes->status.active)) {
    real tau[TRUM_LANES];
    trum_surface at[TRUM_LANES];
    mask ended;
    int ahead;
    if (++rounds % 8 == 0 && !trum_may_attempt(attempts)) return 0;
    if (any_lane(lanes->status.at_lap_start)) trum_coarse_starts(lanes, &c);
    trum_share_lanes(lanes, busy);
    ahead = trum_places(lanes);
    for (j = 0; j < ahead; ++j) tau[j] = c.since + c.h * (c.done + TRUM_NUMBER(j + 1));
    trum_evaluate_surfaces(lanes, tau, at, ahead);
    for (j = 0; j < ahead; ++j) trum_coarse_step(lanes, &c, &at[j]);
    ended = lanes->status.active & at_most(c.steps, c.done);
    for (i = 0; any_lane(ended) && i < TRUM_LANES; ++i) {
      if (!mask_in_lane(ended, i)) continue;
      if (trum_enter_next_segment(lanes, i, &searches[i])) {
        trum_begin_coarse_segment(&searches[i], i, &c);
      } else if (trum_finish_coarse_lap(lanes, i, &searches[i])) {
        trum_begin_coarse_lap(lanes, i, &searches[i], &c);
      } else {
        trum_keep_coarse_orbit(&searches[i], &found[i]);
        busy[i] = 0, set_lane_mask(&lanes->status.active, i, 0);
      }
    }
  }
  return 1;
}

#endif
