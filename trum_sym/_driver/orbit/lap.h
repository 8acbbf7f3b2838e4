/* Laps: one drive cycle from a start speed, region by region (eqs. 9, 10: the phases' gates change between regions). */
#ifndef TRUM_ORBIT_LAP_H
#define TRUM_ORBIT_LAP_H

/* The error that a fine lap's steps may have, over the speed's scale. */
static trum_real trum_fine_level(trum_real tolerance) {
  return trum_step_share * (tolerance < trum_coarsest ? tolerance : trum_coarsest);
}

/* That of the held rotor's lap: finer tolerances have more steps, whose errors add up. */
static trum_real trum_held_level(trum_real tolerance) {
  const trum_real share = tolerance < TRUM_C(1e-6) ? trum_pow(tolerance / TRUM_C(1e-6), TRUM_C(0.2)) : 1;
  return share * trum_fine_level(tolerance);
}

/* A drive cycle: its regions' start phasors and lengths in drive periods, and the phasors' derivatives by resonance and
 * frequency difference. */
typedef struct {
  trum_real start[TRUM_REGIONS][4], pulses[TRUM_REGIONS], slopes[2][TRUM_REGIONS][4];
} trum_cycle_phasors;

/* Start speeds that are too low and too high, and the gain of speed of the laps from there; those of fine laps. */
typedef struct {
  trum_real low, high, gain_low, gain_high, sure_low, sure_high;
  int bisect_next;
} trum_bracket;

/* The lap before: its change of the start speed, start, decay, gain without its errors and what that is uncertain by;
 * how far around it laps draw speeds together alike, and by what share their slope is off. */
typedef struct {
  trum_real last_step, start, decay, exact_gain, uncertainty, trusted, slope_error;
  int probes; /* laps beside a start whose gain has no certain sign */
} trum_newton_record;

/* What errors are measured by: a speed; with slopes the sums of the lap before. */
typedef struct {
  trum_real speed, growth, friction[PARAMETERS], angle[PARAMETERS];
} trum_scales;

/* A lap of the held rotor; laps far from the orbit; laps whose steps meet the tolerance. */
enum { STAGE_HELD, STAGE_ROUGH, STAGE_FINE };

/* The search for a point's orbit: shooting, in laps from a start speed. */
typedef struct {
  const trum_orbit_in* in;
  trum_orbit_out* out;
  const trum_slopes_in* slopes_in; /* or none */
  trum_slopes_out* slopes_out;
  trum_cycle_phasors cycle;
  trum_bracket bracket;
  trum_newton_record newton;
  trum_scales scales;
  trum_repetition repetition;
  trum_real start_speed;    /* of the lap */
  trum_real level;          /* the error that its steps may have, per drive period, over the speed's scale */
  int stage, region;     /* of the lap */
  int laps, refinements; /* so far; those that were repeated with shorter steps */
  int held_laps;         /* with slopes, of the held rotor */
} trum_search;

/* Puts the next region of non-zero length into the lane; returns 0 at the lap's end. */
static int trum_enter_next_region(trum_lanes* lanes, int i, trum_search* search) {
  static const trum_real gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
  const trum_real* start;
  if (search->repetition.is_long && search->region >= 0 && trum_next_piece(lanes, i, &search->repetition, search->in)) return 1;
  do {
    if (++search->region == TRUM_REGIONS) return 0;
  } while (search->cycle.pulses[search->region] < TRUM_C(0.5));
  start = search->cycle.start[search->region];
  set_lane(&lanes->region.f_A_re, i, start[0]), set_lane(&lanes->region.f_A_im, i, start[1]);
  set_lane(&lanes->region.f_B_re, i, start[2]), set_lane(&lanes->region.f_B_im, i, start[3]);
  set_lane(&lanes->region.g_A, i, gates_A[search->region]), set_lane(&lanes->region.g_B, i, gates_B[search->region]);
  if (with_slopes(lanes)) {
    const trum_real* by_resonance = search->cycle.slopes[0][search->region];
    const trum_real* by_difference = search->cycle.slopes[1][search->region];
    trum_region_slopes* slopes = &lanes->region_slopes;
    set_lane(&slopes->f_A_re_omega_n, i, by_resonance[0]), set_lane(&slopes->f_A_im_omega_n, i, by_resonance[1]);
    set_lane(&slopes->f_B_re_omega_n, i, by_resonance[2]), set_lane(&slopes->f_B_im_omega_n, i, by_resonance[3]);
    set_lane(&slopes->f_A_re_Delta_omega, i, by_difference[0]);
    set_lane(&slopes->f_A_im_Delta_omega, i, by_difference[1]);
    set_lane(&slopes->f_B_re_Delta_omega, i, by_difference[2]);
    set_lane(&slopes->f_B_im_Delta_omega, i, by_difference[3]);
  }
  set_lane(&lanes->step.tau, i, 0);
  set_lane(&lanes->step.time_left, i, search->cycle.pulses[search->region] * lane_value(&lanes->equation.period, i));
  set_lane(&lanes->step.h, i, lane_value(&lanes->step.free_h, i));
  set_lane(&lanes->step.curvature, i, 0), set_lane(&lanes->step.target_event, i, -1);
  set_lane(&lanes->step.retries, i, 0);
  if (search->repetition.is_long)
    trum_begin_long_region(lanes, i, &search->repetition, search->in, search->cycle.pulses[search->region],
                           trum_repetition_share * search->level * (search->stage == STAGE_HELD ? 1 : search->scales.speed));
  return 1;
}

/* The drive periods over which the errors of a lap's steps add up: all of them, or, where most are counted, those in which
 * friction could bring the rotor to `reach`, which is a time. */
static trum_real trum_counted_periods(const trum_search* search, trum_real reach, trum_real period) {
  if (!search->repetition.is_long || search->stage == STAGE_HELD) return search->in->m;
  return reach > trum_least_counted * period ? reach / period : trum_least_counted;
}

/* The tolerances of a lap's steps, from the level of its search. */
static void trum_set_tolerances(trum_lanes* lanes, int i, const trum_search* search) {
  const trum_orbit_in* in = search->in;
  const trum_real period = lane_value(&lanes->equation.period, i);
  const trum_real cycle_time = lane_value(&lanes->equation.cycle_time, i);
  const int held = search->stage == STAGE_HELD, of_friction = held && search->held_laps == 1;
  const int of_contact = held && search->held_laps == 2;
  const int close = with_slopes(lanes) && (held ? search->held_laps > 0 : search->stage == STAGE_FINE);
  trum_tolerances* t = &lanes->tolerances;
  trum_real reach = held ? cycle_time : search->scales.speed / in->push, allowed, periods;
  int k;
  if (reach > cycle_time) reach = cycle_time;
  periods = trum_counted_periods(search, reach, period);
  allowed = search->level * reach / periods;
  set_lane(&t->inverse_step, i, 1 / allowed);
  set_lane(&t->inverse_growth, i, periods / (in->tolerance * search->scales.growth));
  for (k = 0; with_slopes(lanes) && k < PARAMETERS; ++k) {
    set_lane(&t->inverse_friction[k], i, of_contact ? 0 : periods / (in->tolerance * search->scales.friction[k]));
    set_lane(&t->inverse_angle[k], i, of_friction ? 0 : periods / (in->tolerance * search->scales.angle[k]));
  }
  set_lane(&t->root, i, trum_root_share * trum_cbrt(allowed * allowed * period));
  set_lane(&t->kink, i, trum_kink_share * allowed);
  set_lane(&t->newton, i, held ? 0 : allowed * in->push * trum_sqrt(trum_newton_share * periods / search->level));
  set_lane(&t->slope_start, i, close ? trum_slope_start_tolerance * period : TRUM_HUGE);
  set_lane(&t->slope_end, i, close ? trum_slope_end_tolerance * period : TRUM_HUGE);
  if (close) set_lane(&t->newton, i, trum_slope_newton_factor * lane_value(&t->newton, i));
}

/* Sets a lap's errors to none. */
static void trum_clear_lap_errors(trum_lap* lap, int i, trum_real x) {
  set_lane(&lap->error, i, 0), set_lane(&lap->remainder, i, 0);
  set_lane(&lap->error_sum, i, 0), set_lane(&lap->remainder_sum, i, 0);
  set_lane(&lap->error_square, i, 0), set_lane(&lap->error_S, i, 0), set_lane(&lap->SS, i, 0);
  set_lane(&lap->remainder_square, i, 0), set_lane(&lap->inside, i, 0);
  set_lane(&lap->low_error, i, 0), set_lane(&lap->low_remainder, i, 0);
  set_lane(&lap->high_error, i, 0), set_lane(&lap->high_remainder, i, 0);
  set_lane(&lap->lowest, i, x), set_lane(&lap->highest, i, x), set_lane(&lap->kept, i, 1);
  set_lane(&lap->friction_error, i, 0), set_lane(&lap->friction_remainder, i, 0);
  set_lane(&lap->angle_error, i, 0), set_lane(&lap->angle_remainder, i, 0);
}

/* Sets a lap's sums to those of no time. */
static void trum_clear_lap(trum_lap* lap, int i, trum_real x, int slopes) {
  int k;
  set_lane(&lap->x, i, 0), set_lane(&lap->xx, i, 0), set_lane(&lap->S, i, 0), set_lane(&lap->xS, i, 0);
  set_lane(&lap->low, i, x), set_lane(&lap->high, i, x);
  set_lane(&lap->S_low, i, 1), set_lane(&lap->S_high, i, 1);
  set_lane(&lap->friction, i, 0), set_lane(&lap->angle, i, 0);
  set_lane(&lap->full_contact, i, 0), set_lane(&lap->fastest, i, 0);
  trum_clear_lap_errors(lap, i, x);
  for (k = 0; slopes && k < PARAMETERS; ++k) {
    set_lane(&lap->sum_abs_friction[k], i, 0), set_lane(&lap->sum_abs_angle[k], i, 0);
    set_lane(&lap->d_x[k], i, 0), set_lane(&lap->d_xx[k], i, 0);
    set_lane(&lap->d_low[k], i, 0), set_lane(&lap->d_high[k], i, 0);
    set_lane(&lap->d_friction[k], i, 0), set_lane(&lap->d_angle[k], i, 0);
  }
}

/* Sets the sensitivities to those of a lap's start: none. */
static void trum_clear_sensitivity(trum_sensitivity* sensitivity, int i, int slopes) {
  trum_derivatives* d = &sensitivity->derivatives;
  int k;
  for (k = 0; slopes && k < PARAMETERS; ++k) {
    set_lane(&sensitivity->x[k], i, 0);
    set_lane(&d->f[k], i, 0), set_lane(&d->ln_E[k], i, 0), set_lane(&d->ln_R_v[k], i, 0);
  }
  set_lane(&d->theta_E, i, 0), set_lane(&d->R_v_rate, i, 0), set_lane(&d->W_c_rate, i, 0);
}

/* The speed that a lap's are differences to: its start's, so that small changes keep their digits; 0 where friction can
 * turn the speed round many times in a drive period, so that small speeds do. */
static trum_real trum_reference_speed(const trum_lanes* lanes, int i, const trum_search* search) {
  const trum_real reach = search->in->push * lane_value(&lanes->equation.period, i);
  return search->stage != STAGE_HELD && reach > 10 * trum_fabs(search->start_speed) ? 0 : search->start_speed;
}

/* Starts a lap in a lane: of the held rotor, which has no equation of motion, or from the search's start speed. */
static void trum_start_lap(trum_lanes* lanes, int i, trum_search* search) {
  const trum_orbit_in* in = search->in;
  const int held = search->stage == STAGE_HELD;
  const trum_real v0 = trum_reference_speed(lanes, i, search), x = search->start_speed - v0;
  trum_step_start* start = &lanes->start;
  set_lane(&lanes->equation.push, i, held ? 0 : in->push), set_lane(&lanes->equation.drag, i, held ? 0 : in->drag);
  set_lane(&lanes->equation.v0, i, v0);
  trum_set_tolerances(lanes, i, search);
  set_lane(&lanes->step.stiffness, i, 0), set_lane(&lanes->step.growth, i, trum_step_growth);
  set_lane(&lanes->step.steps_left, i, trum_max_steps_per_period * in->m);
  set_lane(&lanes->step.free_h, i, trum_first_step * lane_value(&lanes->equation.period, i));
  set_lane(&start->x, i, x), set_lane(&start->S, i, 1);
  set_lane(&start->f, i, 0), set_lane(&start->f_v, i, 0), set_lane(&start->theta, i, 0);
  trum_clear_lap(&lanes->lap, i, x, with_slopes(lanes));
  trum_clear_sensitivity(&lanes->sensitivity, i, with_slopes(lanes));
  set_lane_mask(&lanes->status.at_lap_start, i, 1), set_lane_mask(&lanes->status.failed, i, 0);
  set_lane_mask(&lanes->status.active, i, 1);
  set_lane_mask(&lanes->status.rough, i,
                search->stage == STAGE_ROUGH && search->level > trum_fine_level(in->tolerance) * TRUM_C(1.0001));
  set_lane_mask(&lanes->status.contact_only, i, held && search->held_laps == 2);
  search->region = -1, search->repetition.watched = 0;
  trum_enter_next_region(lanes, i, search);
}

#endif
