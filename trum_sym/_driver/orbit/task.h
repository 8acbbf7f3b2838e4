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

/* The level of laps of which nothing is known, and a speed to measure their errors by. */
static void trum_begin_roughly(trum_search* search) {
  const trum_orbit_in* in = search->in;
  search->stage = STAGE_ROUGH, search->level = trum_step_share * trum_first_lap_tolerance;
  search->scales.speed = TRUM_C(0.1) * in->D * in->k_c * in->W * (in->omega_n + in->Delta_omega);
}

/* Begins the search for an orbit about where it is known to be. */
static void trum_start_from(trum_search* search, const trum_coarse_orbit* about) {
  const trum_real fine_level = trum_fine_level(search->in->tolerance), level = trum_side_by_side_level(search->in->tolerance);
  int k;
  search->start_speed = about->start_speed, search->top = about->top;
  search->newton = about->newton, search->newton.last_step = TRUM_HUGE;
  search->bracket = about->bracket, search->bracket.coarse = 1;
  for (k = 0; k < search->segments; ++k) search->at[k] = about->at[k];
  search->stage = level > 4 * fine_level ? STAGE_ROUGH : STAGE_FINE;
  search->level = search->stage == STAGE_ROUGH ? level : fine_level;
  search->scales.speed = trum_scale_of(search, about->top, about->newton.decay);
  search->laps = search->passed = 1;
  if (!about->stiff) return;
  trum_integrate_in_turn(search);
  search->stage = STAGE_ROUGH, search->level = trum_rough_level(search->in->tolerance);
}

/* Starts the search for an orbit from rest, or from a known start speed (else NaN); 0 if no speed balances the load. */
static int trum_start_search(trum_lanes* lanes, int i, trum_search* search, trum_real known) {
  const trum_orbit_in* in = search->in;
  const trum_coarse_orbit* about = search->about;
  int k;
  if (!(in->push > trum_fabs(in->drag))) {
    search->out->flags += trum_runaway;
    return 0;
  }
  if ((known != known) && trum_solve_balance(lanes, i, search)) return 0;
  trum_begin_roughly(search);
  if (!(known != known)) {
    search->start_speed = known, search->laps = 1, search->passed = about->found;
    if (!search->passed) trum_integrate_in_turn(search);
    for (k = 1; k < search->segments && search->passed; ++k)
      search->at[k].speed = about->at[k].speed, search->at[k].S = search->at[k].error = 0;
  } else if (about->found) {
    trum_start_from(search, about);
  }
  trum_prepare_lap(search, 0);
  return 1;
}

/* Begins a task of a point. */
static void trum_begin_task(const trum_lanes* lanes, trum_search* search, const trum_orbit_in* in, trum_orbit_out* out) {
  trum_cycle_constants cycle;
  trum_free_motion before;
  trum_real results[trum_regions_n_res], phasors[trum_region_phasors_n_res];
  int r, k, phase;
  search->period = TRUM_C(6.283185307179586477) / (in->omega_n + in->Delta_omega), search->cycle_time = search->period * in->m;
  trum_load_cycle(in, &cycle, &before);
  trum_plain_regions(&cycle, &before, results);
  trum_plain_region_phasors(&cycle, &before, phasors);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    search->cycle.pulses[r] = trum_floor(results[trum_regions_out_time_redu + r] / search->period + TRUM_C(0.5));
    for (phase = 0; phase < 2; ++phase) {
      const trum_real* z = &phasors[2 * TRUM_REGIONS * phase + 2 * r];
      search->cycle.start[r][2 * phase] = z[0], search->cycle.start[r][2 * phase + 1] = z[1];
    }
  }
  search->in = in, search->out = out;
  search->repetition.is_long = trum_is_long(in), search->repetition.watched = 0;
  search->laps = search->refinements = search->bracket.bisect_next = search->bracket.coarse = 0;
  search->newton.last_step = TRUM_HUGE, search->newton.start = search->newton.decay = search->newton.exact_gain = 0;
  search->newton.uncertainty = search->newton.trusted = 0, search->newton.slope_error = 1;
  search->newton.last_bound = 0, search->newton.probes = search->newton.in_vain = 0;
  search->stage = STAGE_HELD, search->start_speed = 0;
  search->bracket.low = search->bracket.sure_low = -TRUM_HUGE;
  search->bracket.high = search->bracket.sure_high = TRUM_HUGE;
  search->scales.speed = search->top = 0, search->level = trum_held_level(in->tolerance);
  search->held_laps = 0, trum_reset_slope_scales(search);
  trum_divide_lap(search, TRUM_SEGMENTS);
  search->passed = 0, search->in_turn = search->repetition.is_long, search->steps_level = search->jumps = 0;
  search->about = 0;
  for (k = 0; k < search->segments; ++k) search->at[k].speed = search->at[k].error = search->at[k].step = 0, search->at[k].S = 1;
  if (with_slopes(lanes)) trum_load_region_slopes(search);
}

/* Begins a point's task: its held rotor, or its orbit from a start speed that is known or NaN; the lane is free.  `about` is
 * about where the orbit is, or null.  0 if there is nothing to do. */
static int trum_load_task(trum_lanes* lanes, int i, trum_search* search, const trum_orbit_in* in, trum_orbit_out* out,
                          int held, trum_real known, trum_coarse_orbit* about) {
  trum_begin_task(lanes, search, in, out);
  search->about = about;
  if (!trum_has_cycle(search)) {
    if (!held) out->flags += trum_failed_step;
    return 0;
  }
  if (!held) return trum_start_search(lanes, i, search, known);
  trum_prepare_lap(search, 0);
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
