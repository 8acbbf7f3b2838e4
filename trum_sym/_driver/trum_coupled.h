/* Both phases, the contact and the rotor as one system, through a drive cycle.  Formulas live in the generated C
 * (derivations/coupling.py); here are only steps in time and what they sum to.
 *
 * A phase's own swing is exact: what Dormand and Prince's rule of order 5 steps is a state less what that swing has made of
 * it since the drive period began, which only the drive's and the contact's forces change, and the rotor's height and speed.
 * A step is as long as its estimated error allows.  Steps end with drive periods, where phases are switched.  Where contact
 * or friction has a kink the rule is of a lower order, and steps become short by themselves until they may pass it.
 *
 * With both phases off, friction stops wave and rotor in a finite time.  Once no more is left than it holds, both rest until
 * a phase is driven again.
 *
 * Lane 0 is the lap; the others are beside it, one in each number of the state, and take its steps: their differences are
 * the slopes of what those steps make of a state, exact but for the second order.
 *
 * Over lanes of points; included by coupled.inc. */
#ifndef TRUM_COUPLED_H
#define TRUM_COUPLED_H

#include "trum_coupled_calls.h"

/* w_A, v_A, w_B, v_B, height, climb, v: in the order of TRUM_COUPLED_LAP_IN */
enum { trum_coupled_size = 7, trum_coupled_groups = (trum_coupled_size + 1) / TRUM_LANES };
enum { trum_coupled_stages = TRUM_RUNGE_KUTTA_STAGES, trum_coupled_last = trum_coupled_stages - 1 };
enum { trum_coupled_stage_groups = (trum_coupled_stages + TRUM_LANES - 1) / TRUM_LANES };
/* what is summed over time: speed less that at the start, its square, power, touching */
enum { trum_coupled_sums = 4 };

static const trum_real trum_coupled_aside = 1e-6;    /* of a size, to a state beside */
static const trum_real trum_coupled_shortest = 1e-6; /* step, of a drive period */
static const long trum_coupled_most = 2000000;       /* steps in a drive period, those that are tried */

typedef struct {
  real y[trum_coupled_size];
} trum_coupled_vector;

typedef struct {
  real of[trum_coupled_sums];
} trum_coupled_sum;

typedef struct {
  const trum_coupled_lap_in* in;
  trum_coupled_place place;
  trum_carried carried;
  trum_mode mode;
  trum_gates gates;
  trum_real sizes[trum_coupled_size];
  trum_real v; /* at the start of the lap */
  int groups;  /* of lanes that are in use */
  int resting; /* friction holds wave and rotor */
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
  trum_lanes_filling(&p->carried);
  p->carried.fullness_root = cube_root(p->carried.fullness);
  trum_lanes_contact_winkler(&p->carried);
  return -p->carried.share / p->carried.engagement_per_height;
}

/* Which phases are driven in a drive period of the lap. */
static inline trum_gates trum_coupled_gates(const trum_coupled_lap_in* in, long period) {
  trum_gates gates;
  gates.g_A = period >= in->off_A && period < in->on_A ? 0 : 1;
  gates.g_B = period >= in->off_B && period < in->on_B ? 0 : 1;
  return gates;
}

/* Whether friction stops wave and rotor and then holds them: neither phase is driven, what is left of the wave is at most
 * what it holds, and the rotor is no faster than the surface of such a wave. */
static inline int trum_coupled_stops(const trum_coupled_point* p, const trum_coupled_vector* y) {
  const trum_coupled_lap_in* in = p->in;
  const trum_real held = in->held * in->omega_n0, v = lane_value(&y->y[6], 0);
  const trum_real a = lane_value(&y->y[0], 0) * in->omega_n0, b = lane_value(&y->y[2], 0) * in->omega_n0;
  const trum_real v_A = lane_value(&y->y[1], 0), v_B = lane_value(&y->y[3], 0);
  return held > 0 && p->gates.g_A == 0 && p->gates.g_B == 0 && trum_fabs(v) <= in->D * in->k_c * held &&
         a * a + b * b + v_A * v_A + v_B * v_B <= held * held;
}

/* Both phases and the rotor's turning at rest, or their rates; a rotor with a mass goes on up and down. */
static inline void trum_coupled_rest(trum_coupled_vector* y) {
  y->y[0] = y->y[1] = y->y[2] = y->y[3] = y->y[6] = real(0);
}

/* Rates of a state at a phase of the drive, without the phases' own swing. */
static inline trum_coupled_vector trum_coupled_rates(trum_coupled_point* p, const trum_coupled_vector* of, trum_real phase,
                                                     trum_coupled_sum* sum, trum_coupled_step* step) {
  const trum_coupled_lap_in* in = p->in;
  const trum_real cosine = trum_cos(phase), sine = trum_sin(phase);
  const trum_real on_A = p->gates.g_A * in->F_q * in->force_A * cosine;
  const trum_real on_B = p->gates.g_B * in->F_q * (in->force_B_along * cosine - in->force_B_ahead * sine);
  trum_coupled_state s;
  trum_coupled_surface surface;
  trum_coupled_acting acting;
  trum_coupled_vector rate;
  s.w_A = of->y[0], s.v_A = of->y[1], s.w_B = of->y[2], s.v_B = of->y[3], s.height = of->y[4], s.v = of->y[6];
  if (!(in->mass > 0)) s.height = trum_coupled_height(p, trum_sqrt(s.w_A * s.w_A + s.w_B * s.w_B));
  trum_lanes_coupled_instant(&p->place, &s, &surface);
  trum_lanes_coupled_forces(&p->place, &s, &surface, &acting);
  rate.y[0] = 0, rate.y[1] = (on_A + in->reaction * acting.Q_A) / in->M_q;
  rate.y[2] = 0, rate.y[3] = (on_B + in->reaction * acting.Q_B) / in->M_q;
  rate.y[4] = in->mass > 0 ? of->y[5] : real(0);
  rate.y[5] = in->mass > 0 ? (acting.F_z - in->F_c) / in->mass : real(0);
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
    trum_lanes_mode_flow(&p->mode, &s->swing[g], tau);
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
    trum_coupled_vector rates = trum_coupled_rates(p, &at, phase, &s->sums[stage][g], s);
    for (k = 0; k < 4; k += 2) rates.y[k] = -by[1] / span * rates.y[k + 1], rates.y[k + 1] = by[0] / span * rates.y[k + 1];
    s->rates[stage][g] = rates;
  }
}

/* a += h b */
static inline void trum_coupled_add(trum_coupled_vector* a, trum_real h, const trum_coupled_vector* b) {
  int k;
  for (k = 0; k < trum_coupled_size; ++k) a->y[k] += real(h) * b->y[k];
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

/* A number of lane 0 and its rate where a step ends. */
typedef struct {
  trum_real at, value, rate;
} trum_coupled_end;

static inline trum_coupled_end trum_coupled_speed_end(const trum_coupled_step* s) {
  const trum_coupled_end end = {s->h, lane_value(&s->to[0].y[6], 0), lane_value(&s->rates[trum_coupled_last][0].y[6], 0)};
  return end;
}

static inline trum_coupled_end trum_coupled_wave_end(const trum_coupled_step* s) {
  const trum_coupled_end end = {s->h, s->wave, s->growing / (s->wave + TRUM_C(1e-30))};
  return end;
}

/* Where between two ends the cubic through both has its extreme, and how high it is there. */
static inline trum_coupled_end trum_coupled_turn(const trum_coupled_end* a, const trum_coupled_end* b) {
  const trum_real h = b->at - a->at, rise = b->value - a->value;
  const trum_real none = h * a->rate, once = 6 * rise - 4 * h * a->rate - 2 * h * b->rate;
  const trum_real twice = 3 * h * (a->rate + b->rate) - 6 * rise; /* its rate is none + once x + twice x^2 */
  const trum_real root = trum_sqrt(trum_fmax(once * once - 4 * none * twice, 0));
  const trum_real sum = -(once + (once < 0 ? -root : root)) / 2;
  trum_real x = none / sum; /* of both places the one that lies between */
  trum_coupled_end turn;
  if (!(x >= 0 && x <= 1)) x = sum / twice;
  if (!(x >= 0 && x <= 1)) x = a->rate / (a->rate - b->rate);
  turn.at = a->at + h * x, turn.value = a->value + x * (none + x * (once / 2 + x * twice / 3)), turn.rate = 0;
  return turn;
}

/* The extreme between two ends of a step whose rates differ in sign, by shorter steps from where it begins. */
static trum_real trum_coupled_extreme(trum_coupled_point* p, const trum_coupled_step* step,
                                      trum_coupled_end (*of)(const trum_coupled_step*), trum_coupled_end a,
                                      trum_coupled_end b) {
  enum { tries = 2 };
  const int groups = p->groups;
  trum_coupled_step s = *step;
  trum_coupled_end at = a;
  int k;
  p->groups = 1;
  for (k = 0; k < tries; ++k) {
    s.h = trum_coupled_turn(&a, &b).at;
    if (!(s.h > 0)) break;
    (void)trum_coupled_try(p, &s);
    at = of(&s);
    if ((at.rate > 0) == (a.rate > 0)) a = at;
    else b = at;
  }
  p->groups = groups;
  return at.value;
}

/* Takes what a step passes into the extremes; `wave` is how high it was where the step began, and its rate. */
static void trum_coupled_pass(trum_coupled_point* p, const trum_coupled_step* s, trum_coupled_end wave,
                              trum_coupled_lap_out* out) {
  const trum_coupled_end a = {0, lane_value(&s->from[0].y[6], 0), lane_value(&s->rates[0][0].y[6], 0)};
  const trum_coupled_end b = trum_coupled_speed_end(s), top = trum_coupled_wave_end(s);
  out->low = trum_fmin(out->low, b.value), out->high = trum_fmax(out->high, b.value);
  out->highest = trum_fmax(out->highest, top.value);
  if (a.rate * b.rate < 0) {
    const trum_real end = a.rate > 0 ? trum_fmax(a.value, b.value) : trum_fmin(a.value, b.value);
    const trum_real far = 2 * trum_coupled_turn(&a, &b).value - end; /* twice as far as the cubic goes */
    if (far > out->high || far < out->low) {
      const trum_real value = trum_coupled_extreme(p, s, trum_coupled_speed_end, a, b);
      out->low = trum_fmin(out->low, value), out->high = trum_fmax(out->high, value);
    }
  }
  if (wave.rate > 0 && top.rate < 0 &&
      2 * trum_coupled_turn(&wave, &top).value - trum_fmax(wave.value, top.value) > out->highest)
    out->highest = trum_fmax(out->highest, trum_coupled_extreme(p, s, trum_coupled_wave_end, wave, top));
}

static inline void trum_coupled_count(const trum_coupled_point* p, const trum_coupled_step* s, trum_coupled_sum* sums) {
  static const trum_real within[][trum_coupled_stages] = TRUM_RUNGE_KUTTA_WITHIN;
  int g, i, k;
  for (g = 0; g < p->groups; ++g)
    for (i = 0; i < trum_coupled_last; ++i)
      for (k = 0; k < trum_coupled_sums; ++k)
        sums[g].of[k] += real(s->h * within[trum_coupled_last][i]) * s->sums[i][g].of[k];
}

/* Brings wave and rotor to rest where friction holds them, and whether they are; `by` is the phases' swing since the period
 * began. */
static inline int trum_coupled_hold(trum_coupled_point* p, trum_coupled_vector* states, const trum_real by[4],
                                    trum_coupled_lap_out* out) {
  const trum_coupled_vector at = trum_coupled_swung(by, &states[0]);
  int g;
  p->resting = p->resting || trum_coupled_stops(p, &at);
  if (!p->resting) return 0;
  for (g = 0; g < p->groups; ++g) trum_coupled_rest(&states[g]);
  out->low = trum_fmin(out->low, 0), out->high = trum_fmax(out->high, 0);
  return 1;
}

/* A drive period, or a share of it, from the states in s->to; false if a step cannot be made. */
static int trum_coupled_period(trum_coupled_point* p, trum_coupled_step* s, trum_real* h, trum_real share,
                               trum_coupled_sum* sums, trum_coupled_lap_out* out) {
  const trum_real pi = TRUM_C(3.14159265358979323846), whole = 2 * pi / p->in->omega_q * share;
  const trum_real shortest = trum_coupled_shortest * whole;
  trum_coupled_end wave;
  trum_real by[4];
  long count;
  int g, stops;
  s->tau = 0, s->h = 0;
  trum_coupled_swing(p, s);
  trum_coupled_swing_to(s, 0, by);
  (void)trum_coupled_hold(p, s->to, by, out);
  for (g = 0; g < p->groups; ++g) s->from[g] = s->to[g];
  trum_coupled_seen(p, s, s->from, 0);
  wave = trum_coupled_wave_end(s);
  for (count = 0; count < trum_coupled_most; ++count) {
    const trum_real left = whole - s->tau;
    const int last = *h >= left;
    trum_real error, change;
    if (p->resting && !(p->in->mass > 0)) { /* nothing moves: the whole wave touches */
      for (g = 0; g < p->groups; ++g) {
        s->to[g] = s->from[g];
        sums[g].of[0] += real(-p->v * left), sums[g].of[1] += real(p->v * p->v * left), sums[g].of[3] += real(pi * left);
      }
      return 1;
    }
    s->h = last ? left : trum_fmin(*h, left / 2);
    error = trum_coupled_try(p, s);
    out->evaluations += trum_coupled_last;
    change = TRUM_C(0.9) * trum_pow(error + TRUM_C(1e-6), TRUM_C(-0.2));
    if (!(error <= 1) && s->h > shortest) {
      *h = trum_fmax(s->h * (change > TRUM_C(0.2) ? change : TRUM_C(0.2)), shortest);
      continue;
    }
    if (!(error < TRUM_HUGE)) return 0;
    trum_coupled_pass(p, s, wave, out);
    trum_coupled_count(p, s, sums);
    if (last) break;
    *h = trum_fmax(s->h * trum_fmin(change, 5), shortest);
    wave = trum_coupled_wave_end(s), wave.at = 0;
    s->tau += s->h;
    trum_coupled_swing_to(s, trum_coupled_last, by);
    stops = !p->resting && trum_coupled_hold(p, s->to, by, out);
    for (g = 0; g < p->groups; ++g) {
      s->from[g] = s->to[g];
      s->rates[0][g] = s->rates[trum_coupled_last][g], s->sums[0][g] = s->sums[trum_coupled_last][g];
    }
    if (stops) { /* the state is another one than where the step ended */
      s->h = 0;
      trum_coupled_swing(p, s);
      trum_coupled_seen(p, s, s->from, 0);
      wave = trum_coupled_wave_end(s);
    }
  }
  if (count == trum_coupled_most) return 0;
  trum_coupled_swing_to(s, trum_coupled_last, by);
  for (g = 0; g < p->groups; ++g) s->to[g] = trum_coupled_swung(by, &s->to[g]);
  return 1;
}

static inline void trum_coupled_begin(trum_coupled_point* p, const trum_coupled_lap_in* in, trum_coupled_vector* states,
                                      int beside) {
  const trum_real speed = in->size * in->omega_n0;
  const trum_real sizes[] = {in->size, speed, in->size, speed, in->size, speed, in->D * in->k_c * speed};
  const trum_real start[] = {in->w_A, in->v_A, in->w_B, in->v_B, in->height, in->climb, in->v};
  int g, i, k;
  p->in = in, p->v = in->v, p->resting = 0, p->groups = beside ? trum_coupled_groups : 1;
  p->place.D = in->D, p->place.F_c = in->F_c, p->place.k_N = in->k_N, p->place.k_c = in->k_c, p->place.mu = in->mu;
  p->place.n_j = in->n_j;
  trum_lanes_engagement(&p->place, &p->carried);
  p->mode.omega_n0 = in->omega_n0, p->mode.xi = in->xi;
  for (k = 0; k < trum_coupled_size; ++k) {
    p->sizes[k] = sizes[k];
    for (g = 0; g < trum_coupled_groups; ++g) {
      states[g].y[k] = start[k];
      for (i = 0; i < TRUM_LANES; ++i)
        if (beside && g * TRUM_LANES + i == k + 1) set_lane(&states[g].y[k], i, start[k] + trum_coupled_aside * sizes[k]);
    }
  }
}

/* Drive periods from a state: the state after them, and means and extremes; with slopes of the state and of the mean speed
 * by the state that it began with, a row each, unless that is null.  What cannot be stepped is not a number. */
static void trum_coupled_lap(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, trum_real* slopes) {
  const trum_real pi = TRUM_C(3.14159265358979323846), cycle = 2 * pi * in->m / in->omega_q;
  trum_real h = 2 * pi / in->omega_q / 16;
  trum_coupled_point p;
  trum_coupled_step s;
  trum_coupled_sum sums[trum_coupled_groups];
  trum_real* const state[] = {&out->w_A, &out->v_A, &out->w_B, &out->v_B, &out->height, &out->climb, &out->v};
  long period;
  int g, i, k, done = 1;
  trum_coupled_begin(&p, in, s.to, slopes != 0);
  for (g = 0; g < p.groups; ++g)
    for (k = 0; k < trum_coupled_sums; ++k) sums[g].of[k] = 0;
  out->evaluations = out->highest = 0, out->low = out->high = in->v;
  for (period = 0; (trum_real)period < in->m && done; ++period) {
    p.gates = trum_coupled_gates(in, period);
    p.resting = p.resting && p.gates.g_A == 0 && p.gates.g_B == 0;
    done = trum_coupled_period(&p, &s, &h, trum_fmin(1, in->m - (trum_real)period), sums, out);
  }
  if (!(in->mass > 0))
    for (g = 0; g < p.groups; ++g)
      s.to[g].y[4] = trum_coupled_height(&p, trum_sqrt(s.to[g].y[0] * s.to[g].y[0] + s.to[g].y[2] * s.to[g].y[2]));
  for (k = 0; k < trum_coupled_size; ++k) *state[k] = done ? lane_value(&s.to[0].y[k], 0) : TRUM_NAN;
  out->mean = lane_value(&sums[0].of[0], 0) / cycle, out->variance = lane_value(&sums[0].of[1], 0) / cycle;
  out->variance -= out->mean * out->mean, out->mean += in->v, out->square = out->variance + out->mean * out->mean;
  out->input = lane_value(&sums[0].of[2], 0) / cycle, out->touching = lane_value(&sums[0].of[3], 0) / cycle / pi;
  if (slopes)
    for (i = 1; i <= trum_coupled_size; ++i) {
      const int of = i / TRUM_LANES, at = i % TRUM_LANES;
      const trum_real aside = trum_coupled_aside * p.sizes[i - 1];
      for (k = 0; k < trum_coupled_size; ++k)
        slopes[k * trum_coupled_size + i - 1] = (lane_value(&s.to[of].y[k], at) - *state[k]) / aside;
      slopes[trum_coupled_size * trum_coupled_size + i - 1] =
          (lane_value(&sums[of].of[0], at) - lane_value(&sums[0].of[0], 0)) / cycle / aside;
    }
}

#endif
