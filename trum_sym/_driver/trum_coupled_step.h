/* A step of both phases, the contact and the rotor as one system (trum_coupled.h), and what its error is. */
#ifndef TRUM_COUPLED_STEP_H
#define TRUM_COUPLED_STEP_H

#include "trum_coupled_calls.h"

/* w_A, v_A, w_B, v_B, height, climb, v: in the order of TRUM_COUPLED_LAP_IN */
enum { trum_coupled_size = 7, trum_coupled_groups = (trum_coupled_size + 1) / TRUM_LANES };
enum { trum_coupled_stages = TRUM_RUNGE_KUTTA_STAGES, trum_coupled_last = trum_coupled_stages - 1 };
enum { trum_coupled_stage_groups = (trum_coupled_stages + TRUM_LANES - 1) / TRUM_LANES };
/* what is summed over time: speed less that at the start, its square, power, touching */
enum { trum_coupled_sums = 4 };

static const trum_real trum_coupled_aside = TRUM_EITHER(1e-6, 1e-3); /* of a size, to a state beside */
static const trum_real trum_coupled_shortest = TRUM_C(1e-6);         /* step, of a drive period */
static const long trum_coupled_most = 2000000;       /* steps in a drive period, those that are tried */

typedef struct {
  real y[trum_coupled_size];
} trum_coupled_vector;

typedef struct {
  real of[trum_coupled_sums];
} trum_coupled_sum;

/* Modal forces of the charges that open electrodes hold, at no displacement. */
typedef struct {
  real A, B;
} trum_coupled_pull;

typedef struct {
  const trum_coupled_lap_in* in;
  trum_coupled_place place;
  trum_carried carried;
  trum_mode mode;
  trum_gates gates;
  trum_coupled_pull pull[trum_coupled_groups];
  trum_real sizes[trum_coupled_size];
  trum_real v; /* at the start of the lap */
  int groups;  /* of lanes that are in use */
  int resting; /* friction holds wave and rotor */
  trum_real spare; /* height of a wave that it holds beside the drive */
} trum_coupled_point;

/* A step from a state: states and rates at its stages, the last at its end, and what is summed there. */
typedef struct {
  trum_coupled_vector from[trum_coupled_groups], to[trum_coupled_groups];
  trum_coupled_vector rates[trum_coupled_stages][trum_coupled_groups];
  trum_coupled_sum sums[trum_coupled_stages][trum_coupled_groups];
  trum_flow swing[trum_coupled_stage_groups]; /* of the phases from the period's begin to each stage, a lane each */
  trum_real tau, h;                           /* since the period began */
  trum_real wave, growing; /* of lane 0 at the rates that were asked for last: W_c, and the half of W_c^2's rate */
} trum_coupled_step;

/* Height of a rotor without a mass, which the layer carries at every instant. */
static inline real trum_coupled_height(trum_coupled_point* p, real W_c) {
  p->carried.W_c = W_c;
  trum_coupled_call_filling(&p->carried);
  p->carried.fullness_root = cube_root(p->carried.fullness);
  trum_coupled_call_contact_winkler(&p->carried);
  return -p->carried.share / p->carried.engagement_per_height;
}

/* Which phases are driven in a drive period of the lap. */
static inline trum_gates trum_coupled_gates(const trum_coupled_lap_in* in, long period) {
  const trum_real now = (trum_real)period;
  trum_gates gates;
  gates.g_A = now >= in->off_A && now < in->on_A ? 0 : 1;
  gates.g_B = now >= in->off_B && now < in->on_B ? 0 : 1;
  return gates;
}

/* Height of a wave that friction holds beside the forces on the phases: what it holds without, less what the largest of
 * them bends the stator by.  An open phase that is off may keep the charge of its largest force. */
static inline trum_real trum_coupled_spare(const trum_coupled_lap_in* in, trum_gates gates) {
  const int open = in->K_o > 0;
  const trum_real g_A = open ? TRUM_C(1) : gates.g_A, g_B = open ? TRUM_C(1) : gates.g_B;
  const trum_real a = g_A * in->force_A, b = g_B * in->force_B_along, c = g_B * in->force_B_ahead;
  const trum_real even = a * a + b * b - c * c, odd = 2 * b * c, both = a * a + b * b + c * c;
  const trum_real force = in->F_q * trum_sqrt(open ? both : (both + trum_sqrt(even * even + odd * odd)) / 2);
  const trum_real* arg[trum_mode_swing_n_arg] = {NULL}; /* at rest: omega_q is 0 */
  trum_real* res[trum_mode_swing_n_res] = {NULL};
  trum_real bent = 0;
  arg[trum_mode_swing_in_F_q] = &force, arg[trum_mode_swing_in_M_q] = &in->M_q;
  arg[trum_mode_swing_in_omega_n0] = &in->omega_n0, arg[trum_mode_swing_in_xi] = &in->xi;
  res[trum_mode_swing_out_swing] = &bent;
  (void)trum_mode_swing(arg, res, 0, 0, 0);
  return in->held - bent;
}

/* Whether friction stops wave and rotor and then holds them: what is left of the wave is at most what it holds beside the
 * drive, and the rotor is no faster than the surface of such a wave. */
static inline int trum_coupled_stops(const trum_coupled_point* p, const trum_coupled_vector* y) {
  const trum_coupled_lap_in* in = p->in;
  const trum_real held = p->spare * in->omega_n0, v = lane_value(&y->y[6], 0);
  const trum_real a = lane_value(&y->y[0], 0) * in->omega_n0, b = lane_value(&y->y[2], 0) * in->omega_n0;
  const trum_real v_A = lane_value(&y->y[1], 0), v_B = lane_value(&y->y[3], 0);
  return held > 0 && trum_fabs(v) <= in->D * in->k_c * held && a * a + b * b + v_A * v_A + v_B * v_B <= held * held;
}

/* Both phases and the rotor's turning at rest, or their rates; a rotor with a mass goes on up and down. */
static inline void trum_coupled_rest(trum_coupled_vector* y) {
  y->y[0] = y->y[1] = y->y[2] = y->y[3] = y->y[6] = TRUM_NUMBER(0);
}

/* Modal forces of phases that are driven, at a phase of the drive. */
typedef struct {
  trum_real A, B;
} trum_coupled_drive;

static inline trum_coupled_drive trum_coupled_driven(const trum_coupled_lap_in* in, trum_gates gates, trum_real phase) {
  const trum_real cosine = trum_cos(phase), sine = trum_sin(phase);
  trum_coupled_drive on;
  on.A = gates.g_A * in->F_q * in->force_A * cosine;
  on.B = gates.g_B * in->F_q * (in->force_B_along * cosine - in->force_B_ahead * sine);
  return on;
}

/* Where phases are switched off and stay open, the charges of that instant: voltage and displacement tell them. */
static inline void trum_coupled_charge(trum_coupled_point* p, trum_gates before, const trum_coupled_vector* states) {
  const trum_coupled_lap_in* in = p->in;
  const trum_coupled_drive on = trum_coupled_driven(in, before, in->force_phase);
  int g;
  for (g = 0; g < p->groups; ++g) {
    if (before.g_A > p->gates.g_A) p->pull[g].A = on.A + in->K_o * states[g].y[0];
    if (before.g_B > p->gates.g_B) p->pull[g].B = on.B + in->K_o * states[g].y[2];
  }
}

/* Rates of a group's state at a phase of the drive, without the phases' own swing. */
static inline trum_coupled_vector trum_coupled_rates(trum_coupled_point* p, int group, const trum_coupled_vector* of,
                                                     trum_real phase, trum_coupled_sum* sum, trum_coupled_step* step) {
  const trum_coupled_lap_in* in = p->in;
  const trum_coupled_drive on = trum_coupled_driven(in, p->gates, phase);
  real on_A = TRUM_NUMBER(on.A), on_B = TRUM_NUMBER(on.B);
  trum_coupled_state s;
  trum_coupled_surface surface;
  trum_coupled_acting acting;
  trum_coupled_vector rate;
  s.w_A = of->y[0], s.v_A = of->y[1], s.w_B = of->y[2], s.v_B = of->y[3], s.height = of->y[4], s.v = of->y[6];
  if (in->K_o > 0) { /* else the terminals of a phase that is off are short */
    if (!(p->gates.g_A > 0)) on_A = p->pull[group].A - in->K_o * s.w_A;
    if (!(p->gates.g_B > 0)) on_B = p->pull[group].B - in->K_o * s.w_B;
  }
  if (!(in->mass > 0)) s.height = trum_coupled_height(p, trum_sqrt(s.w_A * s.w_A + s.w_B * s.w_B));
  trum_coupled_call_coupled_instant(&p->place, &s, &surface);
  trum_coupled_call_coupled_forces(&p->place, &s, &surface, &acting);
  rate.y[0] = 0, rate.y[1] = (on_A + in->reaction * acting.Q_A) / in->M_q;
  rate.y[2] = 0, rate.y[3] = (on_B + in->reaction * acting.Q_B) / in->M_q;
  rate.y[4] = in->mass > 0 ? of->y[5] : TRUM_NUMBER(0);
  rate.y[5] = in->mass > 0 ? (acting.F_z - in->F_c) / in->mass : TRUM_NUMBER(0);
  rate.y[6] = in->r_c * (in->r_c * acting.F_x - in->T_load) / in->J_total;
  if (p->resting) trum_coupled_rest(&rate);
  sum->of[0] = s.v - p->v, sum->of[1] = sum->of[0] * sum->of[0];
  sum->of[2] = on_A * s.v_A + on_B * s.v_B, sum->of[3] = surface.theta;
  step->wave = lane_value(&surface.W_c, 0);
  step->growing = lane_value(&s.w_A, 0) * lane_value(&s.v_A, 0) + lane_value(&s.w_B, 0) * lane_value(&s.v_B, 0);
  return rate;
}

/* What the phases' own swing makes of a state, by rows of what becomes of w and v; the rotor's part stays. */
static inline trum_coupled_vector trum_coupled_swung(const trum_real by[4], const trum_coupled_vector* of) {
  trum_coupled_vector to = *of;
  int k;
  for (k = 0; k < 4; k += 2) {
    to.y[k] = by[0] * of->y[k] + by[1] * of->y[k + 1];
    to.y[k + 1] = by[2] * of->y[k] + by[3] * of->y[k + 1];
  }
  return to;
}

/* Swing of the phases from the period's begin to all stages of a step. */
static inline void trum_coupled_swing(const trum_coupled_point* p, trum_coupled_step* s) {
  static const trum_real nodes[] = TRUM_RUNGE_KUTTA_NODES;
  int g, i;
  for (g = 0; g < trum_coupled_stage_groups; ++g) {
    real tau = s->tau;
    for (i = 0; i < TRUM_LANES && g * TRUM_LANES + i < trum_coupled_stages; ++i)
      set_lane(&tau, i, s->tau + nodes[g * TRUM_LANES + i] * s->h);
    trum_coupled_call_mode_flow(&p->mode, &s->swing[g], tau);
  }
}

static inline void trum_coupled_swing_to(const trum_coupled_step* s, int stage, trum_real by[4]) {
  const trum_flow* of = &s->swing[stage / TRUM_LANES];
  const int i = stage % TRUM_LANES;
  by[0] = lane_value(&of->w_w, i), by[1] = lane_value(&of->w_v, i);
  by[2] = lane_value(&of->v_w, i), by[3] = lane_value(&of->v_v, i);
}

/* Rates of all states at a stage of a step, seen from the phases' own swing. */
static inline void trum_coupled_seen(trum_coupled_point* p, trum_coupled_step* s, const trum_coupled_vector* of, int stage) {
  static const trum_real nodes[] = TRUM_RUNGE_KUTTA_NODES;
  const trum_real phase = p->in->force_phase + p->in->omega_q * (s->tau + nodes[stage] * s->h);
  trum_real by[4], span;
  int g, k;
  trum_coupled_swing_to(s, stage, by);
  span = by[0] * by[3] - by[1] * by[2];
  for (g = p->groups - 1; g >= 0; --g) {
    const trum_coupled_vector at = trum_coupled_swung(by, &of[g]);
    trum_coupled_vector rates = trum_coupled_rates(p, g, &at, phase, &s->sums[stage][g], s);
    for (k = 0; k < 4; k += 2) rates.y[k] = -by[1] / span * rates.y[k + 1], rates.y[k + 1] = by[0] / span * rates.y[k + 1];
    s->rates[stage][g] = rates;
  }
}

/* a += h b */
static inline void trum_coupled_add(trum_coupled_vector* a, trum_real h, const trum_coupled_vector* b) {
  int k;
  for (k = 0; k < trum_coupled_size; ++k) a->y[k] += TRUM_NUMBER(h) * b->y[k];
}

/* Tries a step from `from`, with its rates in rates[0]; its error in lane 0 over what is allowed. */
static trum_real trum_coupled_try(trum_coupled_point* p, trum_coupled_step* s) {
  static const trum_real within[][trum_coupled_stages] = TRUM_RUNGE_KUTTA_WITHIN, off[] = TRUM_RUNGE_KUTTA_ERROR;
  trum_real square = 0;
  int i, j, g, k;
  trum_coupled_swing(p, s);
  for (i = 1; i < trum_coupled_stages; ++i) {
    for (g = 0; g < p->groups; ++g) {
      s->to[g] = s->from[g];
      for (j = 0; j < i; ++j) trum_coupled_add(&s->to[g], s->h * within[i][j], &s->rates[j][g]);
    }
    trum_coupled_seen(p, s, s->to, i);
  }
  for (k = 0; k < trum_coupled_size; ++k) {
    trum_real error = 0;
    for (i = 0; i < trum_coupled_stages; ++i) error += off[i] * lane_value(&s->rates[i][0].y[k], 0);
    error *= s->h / p->sizes[k], square += error * error;
  }
  return trum_sqrt(square) / p->in->tolerance;
}

#endif
