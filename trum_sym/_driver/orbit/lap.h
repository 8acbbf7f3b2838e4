/* Laps: one drive cycle from a start speed, region by region (eqs. 9, 10: the phases' gates change between regions). */
#ifndef TRUM_ORBIT_LAP_H
#define TRUM_ORBIT_LAP_H

/* The search for a point's orbit: shooting, in laps from a start speed. */
typedef struct {
  const trum_orbit_in* in;
  trum_orbit_out* out;
  const trum_slopes_in* slopes_in; /* or none */
  trum_slopes_out* slopes_out;
  double region_start[TRUM_REGIONS][4],
      pulses[TRUM_REGIONS];                      /* phasors at the start of the regions; their drive periods */
  double region_slopes[2][TRUM_REGIONS][4];      /* of the phasors, by resonance and difference */
  double bracket_low, bracket_high, start_speed; /* bracket of the start speed, guess */
  double gain_low, gain_high;                    /* of the laps from the bracket's ends */
  double last_newton_step, last_lap_error,
      contraction;           /* Newton's last step, a lap's error then, and the share of a step that is left */
  double speed_scale, level; /* speed that errors are measured by, error of a step */
  double growth_scale, friction_scale[PARAMETERS],
      angle_scale[PARAMETERS];                       /* what a lap with slopes adds up, from the last one */
  int stage, region, laps, refinements, bisect_next; /* halves: whether the bracket is to be halved next */
  int held_laps;                                     /* laps with slopes of the held rotor so far */
} trum_search;

enum { STAGE_HELD, STAGE_ROUGH, STAGE_FINE };
static const int trum_max_laps = 60;
static const double trum_max_steps_per_period = 3000.0; /* steps in a drive period, accepted or not */

/* Puts the next region of non-zero length into the lane; returns 0 at the lap's end. */
static int trum_enter_next_region(trum_lanes* lanes, int i, trum_search* search) {
  static const double gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
  const double* start;
  do {
    if (++search->region == TRUM_REGIONS) return 0;
  } while (search->pulses[search->region] < 0.5);
  start = search->region_start[search->region];
  set_lane(&lanes->region.f_A_re, i, start[0]), set_lane(&lanes->region.f_A_im, i, start[1]);
  set_lane(&lanes->region.f_B_re, i, start[2]), set_lane(&lanes->region.f_B_im, i, start[3]);
  set_lane(&lanes->region.g_A, i, gates_A[search->region]), set_lane(&lanes->region.g_B, i, gates_B[search->region]);
  if (lanes->slopes) {
    const double *by_resonance = search->region_slopes[0][search->region],
                 *by_difference = search->region_slopes[1][search->region];
    trum_region_slopes* slopes = &lanes->region_slopes;
    set_lane(&slopes->f_A_re_omega_n, i, by_resonance[0]), set_lane(&slopes->f_A_im_omega_n, i, by_resonance[1]);
    set_lane(&slopes->f_B_re_omega_n, i, by_resonance[2]), set_lane(&slopes->f_B_im_omega_n, i, by_resonance[3]);
    set_lane(&slopes->f_A_re_Delta_omega, i, by_difference[0]),
        set_lane(&slopes->f_A_im_Delta_omega, i, by_difference[1]);
    set_lane(&slopes->f_B_re_Delta_omega, i, by_difference[2]),
        set_lane(&slopes->f_B_im_Delta_omega, i, by_difference[3]);
  }
  set_lane(&lanes->tau, i, 0.0),
      set_lane(&lanes->time_left, i, search->pulses[search->region] * lane_value(&lanes->period, i));
  set_lane(&lanes->h, i, lane_value(&lanes->step_size, i));
  set_lane(&lanes->curvature, i, 0.0), set_lane(&lanes->target_event, i, -1.0), set_lane(&lanes->retries, i, 0.0);
  return 1;
}

static void trum_start_lap(trum_lanes* lanes, int i, trum_search* search) {
  const double period = lane_value(&lanes->period, i), whole = lane_value(&lanes->cycle_time, i),
               push = search->in->push;
  const int held = search->stage == STAGE_HELD, friction = held && search->held_laps == 1,
            contact = held && search->held_laps == 2;
  double reach = held ? whole : search->speed_scale / push, allowed;
  int k;
  if (reach > whole) reach = whole;
  allowed = search->level * reach / search->in->m;
  set_lane(&lanes->push, i, held ? 0.0 : push), set_lane(&lanes->drag, i, held ? 0.0 : search->in->drag);
  set_lane(&lanes->v0, i, search->start_speed), set_lane(&lanes->inverse_step_tolerance, i, 1.0 / allowed);
  set_lane(&lanes->inverse_growth_tolerance, i, search->in->m / (search->in->tolerance * search->growth_scale));
  for (k = 0; lanes->slopes && k < PARAMETERS; ++k) {
    set_lane(&lanes->inverse_friction_tolerance[k], i,
             contact ? 0.0 : search->in->m / (search->in->tolerance * search->friction_scale[k]));
    set_lane(&lanes->inverse_angle_tolerance[k], i,
             friction ? 0.0 : search->in->m / (search->in->tolerance * search->angle_scale[k]));
  }
  set_lane(&lanes->root_tolerance, i, trum_root_share * cbrt(allowed * allowed * period));
  set_lane(&lanes->kink_tolerance, i, trum_kink_share * allowed);
  set_lane(&lanes->newton_tolerance, i,
           held ? 0.0 : allowed * push * sqrt(trum_newton_share * search->in->m / search->level));
  set_lane(&lanes->slope_start_tolerance, i, HUGE_VAL), set_lane(&lanes->slope_end_tolerance, i, HUGE_VAL);
  if (lanes->slopes && (held ? search->held_laps : search->stage == STAGE_FINE)) {
    set_lane(&lanes->slope_start_tolerance, i, trum_slope_start_tolerance * period),
        set_lane(&lanes->slope_end_tolerance, i, trum_slope_end_tolerance * period);
    set_lane(&lanes->newton_tolerance, i, trum_slope_newton_factor * lane_value(&lanes->newton_tolerance, i));
  }
  set_lane(&lanes->steps_left, i, trum_max_steps_per_period * search->in->m);
  set_lane(&lanes->step_size, i, trum_first_step * period);
  set_lane(&lanes->x, i, 0.0), set_lane(&lanes->S, i, 1.0), set_lane(&lanes->f, i, 0.0), set_lane(&lanes->f_v, i, 0.0),
      set_lane(&lanes->theta, i, 0.0);
  set_lane(&lanes->lap.x, i, 0.0), set_lane(&lanes->lap.xx, i, 0.0), set_lane(&lanes->lap.S, i, 0.0),
      set_lane(&lanes->lap.xS, i, 0.0);
  set_lane(&lanes->lap.low, i, 0.0), set_lane(&lanes->lap.high, i, 0.0), set_lane(&lanes->lap.S_low, i, 1.0),
      set_lane(&lanes->lap.S_high, i, 1.0);
  set_lane(&lanes->lap.friction, i, 0.0), set_lane(&lanes->lap.angle, i, 0.0);
  set_lane(&lanes->lap.full_contact, i, 0.0), set_lane(&lanes->lap.fastest, i, 0.0),
      set_lane(&lanes->lap.error, i, 0.0);
  for (k = 0; lanes->slopes && k < PARAMETERS; ++k) {
    set_lane(&lanes->slopes_x[k], i, 0.0), set_lane(&lanes->derivatives.f[k], i, 0.0),
        set_lane(&lanes->derivatives.ln_E[k], i, 0.0);
    set_lane(&lanes->derivatives.ln_R_v[k], i, 0.0), set_lane(&lanes->lap.sum_abs_friction[k], i, 0.0),
        set_lane(&lanes->lap.sum_abs_angle[k], i, 0.0);
    set_lane(&lanes->lap.d_x[k], i, 0.0), set_lane(&lanes->lap.d_xx[k], i, 0.0);
    set_lane(&lanes->lap.d_low[k], i, 0.0), set_lane(&lanes->lap.d_high[k], i, 0.0);
    set_lane(&lanes->lap.d_friction[k], i, 0.0), set_lane(&lanes->lap.d_angle[k], i, 0.0);
  }
  set_lane(&lanes->derivatives.theta_E, i, 0.0), set_lane(&lanes->derivatives.R_v_rate, i, 0.0),
      set_lane(&lanes->derivatives.W_c_rate, i, 0.0);
  set_lane_mask(&lanes->at_lap_start, i, 1), set_lane_mask(&lanes->failed, i, 0), set_lane_mask(&lanes->active, i, 1);
  set_lane_mask(&lanes->contact_only, i, contact);
  search->region = -1;
  trum_enter_next_region(lanes, i, search);
}

#endif
