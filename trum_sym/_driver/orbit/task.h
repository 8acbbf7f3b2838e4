/* Tasks: what a lane is given to do for a point, its held rotor or the search for its orbit. */
#ifndef TRUM_ORBIT_TASK_H
#define TRUM_ORBIT_TASK_H

/* A point's drive cycle as the kernels take it. */
static void trum_load_cycle(const trum_orbit_in* in, trum_cycle_constants* cycle, trum_free_motion* before) {
  cycle->omega_n = (trum_real)in->omega_n, cycle->Delta_omega = (trum_real)in->Delta_omega;
  cycle->xi = (trum_real)in->xi, cycle->psi = (trum_real)in->psi, cycle->s = (trum_real)in->s;
  cycle->m = (trum_real)in->m, cycle->n = (trum_real)in->n;
  cycle->W = (trum_real)in->W, cycle->D = (trum_real)in->D, cycle->k_c = (trum_real)in->k_c;
  before->a_A = (trum_real)in->a_A, before->b_A = (trum_real)in->b_A;
  before->a_B = (trum_real)in->a_B, before->b_B = (trum_real)in->b_B;
}

/* Derivatives of the phasors at the start of the regions. */
static void trum_load_region_slopes(trum_search* search) {
  const trum_orbit_in* in = search->in;
  const trum_slopes_in* given = search->slopes_in;
  trum_cycle_constants cycle;
  trum_free_motion before;
  trum_free_motion_slopes before_slopes;
  trum_real results[trum_regions_slopes_n_res];
  int k, by, phase, r, part;
  trum_load_cycle(in, &cycle, &before);
#define TRUM_LOAD(name, unit) before_slopes.name = (trum_real)given->name;
  TRUM_SLOPES_IN(TRUM_LOAD)
#undef TRUM_LOAD
  trum_plain_regions_slopes(&cycle, &before, &before_slopes, results);
  for (by = k = 0; by < 2; ++by)
    for (phase = 0; phase < 2; ++phase)
      for (r = 0; r < TRUM_REGIONS; ++r)
        for (part = 0; part < 2; ++part) search->cycle.slopes[by][r][2 * phase + part] = results[k++];
}

/* No error control of the next lap's slopes, as nothing is known of their magnitude. */
static void trum_reset_slope_scales(trum_search* search) {
  int k;
  search->scales.growth = trum_unmeasured;
  for (k = 0; k < PARAMETERS; ++k) search->scales.friction[k] = search->scales.angle[k] = trum_unmeasured;
}

/* Starts the search for an orbit from rest, or from a known start speed (else NaN); 0 if no speed balances the load. */
static int trum_start_search(trum_lanes* lanes, int i, trum_search* search, trum_real known) {
  const trum_orbit_in* in = search->in;
  if (!(in->push > trum_fabs(in->drag))) {
    search->out->flags += trum_runaway;
    return 0;
  }
  if ((known != known) && trum_solve_balance(lanes, i, search)) return 0;
  search->stage = STAGE_ROUGH, search->level = trum_step_share * trum_first_lap_tolerance;
  search->scales.speed = TRUM_C(0.1) * in->D * in->k_c * in->W * (in->omega_n + in->Delta_omega);
  if (!(known != known)) search->start_speed = known, search->laps = 1;
  trum_start_lap(lanes, i, search);
  return 1;
}

/* Puts a task of a point into a lane: its held rotor, or its orbit from a start speed that is known or NaN.  0 if there
 * is nothing to do. */
static int trum_load_task(trum_lanes* lanes, int i, trum_search* search, const trum_orbit_in* in, trum_orbit_out* out,
                          int held, trum_real known) {
  const trum_real period = TRUM_C(6.283185307179586477) / (in->omega_n + in->Delta_omega);
  trum_cycle_constants cycle;
  trum_free_motion before;
  trum_real results[trum_regions_n_res], phasors[trum_region_phasors_n_res];
  int r, phase;
  set_lane(&lanes->constants.omega_n, i, in->omega_n), set_lane(&lanes->constants.Delta_omega, i, in->Delta_omega);
  set_lane(&lanes->constants.xi, i, in->xi);
  set_lane(&lanes->constants.s, i, in->s), set_lane(&lanes->constants.W, i, in->W);
  set_lane(&lanes->constants.D, i, in->D), set_lane(&lanes->constants.k_c, i, in->k_c);
  set_lane(&lanes->constants.engagement_per_height, i, in->engagement_per_height);
  set_lane(&lanes->constants.W_full, i, in->W_full);
  set_lane(&lanes->constants.p_re, i, trum_cos(in->psi)), set_lane(&lanes->constants.p_im, i, trum_sin(in->psi));
  set_lane(&lanes->equation.period, i, period), set_lane(&lanes->equation.cycle_time, i, period * in->m);
  trum_load_cycle(in, &cycle, &before);
  trum_plain_regions(&cycle, &before, results);
  trum_plain_region_phasors(&cycle, &before, phasors);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    search->cycle.pulses[r] = trum_floor(results[trum_regions_out_time_redu + r] / period + TRUM_C(0.5));
    for (phase = 0; phase < 2; ++phase) {
      const trum_real* z = &phasors[2 * TRUM_REGIONS * phase + 2 * r];
      search->cycle.start[r][2 * phase] = z[0], search->cycle.start[r][2 * phase + 1] = z[1];
    }
  }
  search->in = in, search->out = out;
  search->repetition.is_long = trum_is_long(in), search->repetition.watched = 0;
  search->laps = search->refinements = search->bracket.bisect_next = 0;
  search->newton.last_step = TRUM_HUGE, search->newton.start = search->newton.decay = search->newton.exact_gain = 0;
  search->newton.uncertainty = search->newton.trusted = 0, search->newton.slope_error = 1;
  search->newton.probes = 0;
  search->stage = STAGE_HELD, search->start_speed = 0;
  search->bracket.low = search->bracket.sure_low = -TRUM_HUGE;
  search->bracket.high = search->bracket.sure_high = TRUM_HUGE;
  search->scales.speed = 0, search->level = trum_held_level(in->tolerance);
  search->held_laps = 0, trum_reset_slope_scales(search);
  if (with_slopes(lanes)) trum_load_region_slopes(search);
  if (!held) return trum_start_search(lanes, i, search, known);
  trum_start_lap(lanes, i, search);
  return 1;
}

/* Lanes without a task. */
static void trum_initialise_lanes(trum_lanes* lanes, int hertz, int slopes) {
  int k;
  lanes->status.active = lanes->status.at_lap_start = lanes->status.failed = lanes->status.rough =
      lanes->status.contact_only = mask_all(0);
  lanes->hertz = hertz, lanes->slopes = slopes, lanes->record = 0;
  for (k = 0; k < EVENT_COUNT; ++k) lanes->start.at_event[k] = mask_all(0), lanes->start.events[k] = TRUM_NUMBER(0);
  lanes->step.tau = lanes->step.time_left = lanes->step.h = lanes->step.free_h = lanes->step.curvature =
      lanes->step.target_event = lanes->step.retries = lanes->step.steps_left = TRUM_NUMBER(0);
  lanes->step.stiffness = lanes->step.growth = TRUM_NUMBER(0);
#if TRUM_LANES > 1
  lanes->sharing.at_work = 0, lanes->sharing.places = 1;
#endif
}

#endif
