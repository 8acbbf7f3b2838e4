/* Both phases, the contact and the rotor as one system, through a drive cycle.  Formulas live in the generated C
 * (derivations/coupling.py); here are only steps in time and what they sum to.
 *
 * A phase's own swing is exact: what Dormand and Prince's rule of order 5 steps is a state less what that swing has made of
 * it since the drive period began, which only the drive's and the contact's forces change, and the rotor's height and speed.
 * A step is as long as its estimated error allows.  Steps end with drive periods, where phases are switched.  Where contact
 * or friction has a kink the rule is of a lower order, and steps become short by themselves until they may pass it.
 *
 * A phase that is off has short terminals, or open ones whose charge makes a force (derivations/port.py).
 *
 * With both phases off, friction stops wave and rotor in a finite time.  Once no more is left than it holds, both rest until
 * a phase is driven again.
 *
 * Lane 0 is the lap; the others are beside it, one in each number of the state, and take its steps: their differences are
 * the slopes of what those steps make of a state, exact but for the second order.
 *
 * Over lanes of points where coupled.inc includes it, one by one in the C library (trum_coupled_point.h). */
#ifndef TRUM_COUPLED_H
#define TRUM_COUPLED_H

#include "trum_coupled_step.h"

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
        sums[g].of[k] += TRUM_NUMBER(s->h * within[trum_coupled_last][i]) * s->sums[i][g].of[k];
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
        sums[g].of[0] += TRUM_NUMBER(-p->v * left), sums[g].of[1] += TRUM_NUMBER(p->v * p->v * left);
        sums[g].of[3] += TRUM_NUMBER(pi * left);
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
  p->gates.g_A = in->driven_A, p->gates.g_B = in->driven_B;
  p->place.D = in->D, p->place.F_c = in->F_c, p->place.k_N = in->k_N, p->place.k_c = in->k_c, p->place.mu = in->mu;
  p->place.n_j = in->n_j;
  trum_coupled_call_engagement(&p->place, &p->carried);
  p->mode.omega_n0 = in->omega_n0, p->mode.xi = in->xi;
  for (g = 0; g < trum_coupled_groups; ++g)
    p->pull[g].A = TRUM_NUMBER(in->pull_A), p->pull[g].B = TRUM_NUMBER(in->pull_B);
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
static void trum_coupled_follow(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, trum_real* slopes) {
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
    const trum_gates before = p.gates;
    p.gates = trum_coupled_gates(in, period);
    if (in->K_o > 0) trum_coupled_charge(&p, before, s.to);
    p.spare = trum_coupled_spare(in, p.gates);
    p.resting = p.resting && p.spare > 0;
    done = trum_coupled_period(&p, &s, &h, trum_fmin(1, in->m - (trum_real)period), sums, out);
  }
  if (!(in->mass > 0))
    for (g = 0; g < p.groups; ++g)
      s.to[g].y[4] = trum_coupled_height(&p, trum_sqrt(s.to[g].y[0] * s.to[g].y[0] + s.to[g].y[2] * s.to[g].y[2]));
  for (k = 0; k < trum_coupled_size; ++k) *state[k] = done ? lane_value(&s.to[0].y[k], 0) : TRUM_NAN;
  out->pull_A = lane_value(&p.pull[0].A, 0), out->pull_B = lane_value(&p.pull[0].B, 0);
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
