/* Laps: one drive cycle from a start speed, region by region. */
#ifndef TRUM_ORBIT_LAP_H
#define TRUM_ORBIT_LAP_H

/* A point's search for its orbit. */
typedef struct {
  const trum_orbit_in* in;
  trum_orbit_out* out;
  const trum_slopes_in* slopes_in; /* or none */
  trum_slopes_out* slopes_out;
  double start[TRUM_REGIONS][4], pulses[TRUM_REGIONS]; /* phasors at the start of the regions; their drive periods */
  double slopes[2][TRUM_REGIONS][4];                   /* of the phasors, by resonance and difference */
  double low, high, v0;               /* bracket of the start speed, guess */
  double gain_low, gain_high;         /* of the laps from the bracket's ends */
  double last_away, last_noise, keeps; /* Newton's last step, a lap's error then, and the share of a step that is left */
  double scale, level;                /* speed that errors are measured by, error of a step */
  double growth, size_f[TRUM_SLOPE_PARAMETERS_COUNT], size_angle[TRUM_SLOPE_PARAMETERS_COUNT]; /* what a lap with slopes adds up, from the last one */
  int stage, region, laps, finer, halves; /* halves: whether the bracket is to be halved next */
  int sized;                              /* laps with slopes of the held rotor so far */
} trum_job;

enum { HELD, ROUGH, FINE };
static const int trum_most_laps = 60;
static const double trum_most_tries = 3000.0; /* steps in a drive period, accepted or not */

/* Puts the next region of the lap that has any length into the lane; 0 if the lap is over. */
static int trum_next_region(trum_lanes* l, int i, trum_job* job) {
  static const double gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
  const double* start;
  do {
    if (++job->region == TRUM_REGIONS) return 0;
  } while (job->pulses[job->region] < 0.5);
  start = job->start[job->region];
  put(&l->region.f_A_re, i, start[0]), put(&l->region.f_A_im, i, start[1]);
  put(&l->region.f_B_re, i, start[2]), put(&l->region.f_B_im, i, start[3]);
  put(&l->region.g_A, i, gates_A[job->region]), put(&l->region.g_B, i, gates_B[job->region]);
  if (l->slopes) {
    const double *by_resonance = job->slopes[0][job->region], *by_difference = job->slopes[1][job->region];
    trum_region_slopes* slopes = &l->region_slopes;
    put(&slopes->f_A_re_omega_n, i, by_resonance[0]), put(&slopes->f_A_im_omega_n, i, by_resonance[1]);
    put(&slopes->f_B_re_omega_n, i, by_resonance[2]), put(&slopes->f_B_im_omega_n, i, by_resonance[3]);
    put(&slopes->f_A_re_Delta_omega, i, by_difference[0]), put(&slopes->f_A_im_Delta_omega, i, by_difference[1]);
    put(&slopes->f_B_re_Delta_omega, i, by_difference[2]), put(&slopes->f_B_im_Delta_omega, i, by_difference[3]);
  }
  put(&l->tau, i, 0.0), put(&l->left, i, job->pulses[job->region] * get(&l->period, i));
  put(&l->h, i, get(&l->natural, i));
  put(&l->bend, i, 0.0), put(&l->target, i, -1.0), put(&l->tries, i, 0.0);
  return 1;
}

static void trum_start_lap(trum_lanes* l, int i, trum_job* job) {
  const double period = get(&l->period, i), whole = get(&l->whole, i), push = job->in->push;
  const int held = job->stage == HELD, friction = held && job->sized == 1, contact = held && job->sized == 2;
  double reach = held ? whole : job->scale / push, allowed;
  int k;
  if (reach > whole) reach = whole;
  allowed = job->level * reach / job->in->m;
  put(&l->push, i, held ? 0.0 : push), put(&l->drag, i, held ? 0.0 : job->in->drag);
  put(&l->v0, i, job->v0), put(&l->per_allowed, i, 1.0 / allowed);
  put(&l->per_growth, i, job->in->m / (job->in->tolerance * job->growth));
  for (k = 0; l->slopes && k < TRUM_SLOPE_PARAMETERS_COUNT; ++k) {
    put(&l->per_f[k], i, contact ? 0.0 : job->in->m / (job->in->tolerance * job->size_f[k]));
    put(&l->per_angle[k], i, friction ? 0.0 : job->in->m / (job->in->tolerance * job->size_angle[k]));
  }
  put(&l->event_error, i, trum_event * cbrt(allowed * allowed * period));
  put(&l->kink_error, i, trum_kink * allowed);
  put(&l->newton_error, i, held ? 0.0 : allowed * push * sqrt(trum_newton * job->in->m / job->level));
  put(&l->begins, i, HUGE_VAL), put(&l->ends, i, HUGE_VAL);
  if (l->slopes && (held ? job->sized : job->stage == FINE)) {
    put(&l->begins, i, trum_begins * period), put(&l->ends, i, trum_ends * period);
    put(&l->newton_error, i, trum_closes * get(&l->newton_error, i));
  }
  put(&l->patience, i, trum_most_tries * job->in->m);
  put(&l->natural, i, trum_first * period);
  put(&l->x, i, 0.0), put(&l->S, i, 1.0), put(&l->f, i, 0.0), put(&l->f_v, i, 0.0), put(&l->theta, i, 0.0);
  put(&l->lap.x, i, 0.0), put(&l->lap.xx, i, 0.0), put(&l->lap.S, i, 0.0), put(&l->lap.xS, i, 0.0);
  put(&l->lap.low, i, 0.0), put(&l->lap.high, i, 0.0), put(&l->lap.S_low, i, 1.0), put(&l->lap.S_high, i, 1.0);
  put(&l->lap.friction, i, 0.0), put(&l->lap.angle, i, 0.0);
  put(&l->lap.full, i, 0.0), put(&l->lap.fastest, i, 0.0), put(&l->lap.error, i, 0.0);
  for (k = 0; l->slopes && k < TRUM_SLOPE_PARAMETERS_COUNT; ++k) {
    put(&l->d[k], i, 0.0), put(&l->changes.f[k], i, 0.0), put(&l->changes.ln_E[k], i, 0.0);
    put(&l->changes.ln_R_v[k], i, 0.0), put(&l->lap.size_f[k], i, 0.0), put(&l->lap.size_angle[k], i, 0.0);
    put(&l->lap.d_x[k], i, 0.0), put(&l->lap.d_xx[k], i, 0.0);
    put(&l->lap.d_low[k], i, 0.0), put(&l->lap.d_high[k], i, 0.0);
    put(&l->lap.d_friction[k], i, 0.0), put(&l->lap.d_angle[k], i, 0.0);
  }
  put(&l->changes.theta_E, i, 0.0), put(&l->changes.R_v_rate, i, 0.0), put(&l->changes.W_c_rate, i, 0.0);
  put_mask(&l->cold, i, 1), put_mask(&l->lost, i, 0), put_mask(&l->active, i, 1);
  put_mask(&l->contact, i, contact);
  job->region = -1;
  trum_next_region(l, i, job);
}

#endif
