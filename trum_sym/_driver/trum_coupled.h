/* Both phases, the contact and the rotor as one system, through a drive cycle.  Formulas live in the generated C
 * (derivations/coupling.py); here are only steps in time and what they sum to.
 *
 * A phase's own swing is exact: Runge and Kutta's rule of fourth order steps what is left of it after that (Lawson's), the
 * drive's and the contact's forces, and the rotor's height and speed.  Steps end where phases are switched.  Where contact or
 * friction has a kink within a step the order is lower: who wants to know how much takes half the steps as well.
 *
 * With both phases off, friction stops wave and rotor in a finite time.  Once no more is left than it holds, both rest until
 * a phase is driven again.
 *
 * C99 without allocation or globals, which is also C++. */
#ifndef TRUM_COUPLED_H
#define TRUM_COUPLED_H

#include "trum_orbit_fields.h"
#include "trum_plain_calls.h"

/* w_A, v_A, w_B, v_B, height, climb, v: in the order of TRUM_COUPLED_LAP_IN */
enum { trum_coupled_size = 7 };
typedef struct {
  trum_real y[trum_coupled_size];
} trum_coupled_vector;

typedef struct {
  const trum_coupled_lap_in* in;
  trum_coupled_place place;
  trum_carried carried;
  trum_gates gates;
  trum_real power, touching, wave; /* at the instant that was asked for last */
} trum_coupled_point;

/* Height of a rotor without a mass, which the layer carries at every instant. */
static inline trum_real trum_coupled_height(trum_coupled_point* p, trum_real W_c) {
  p->carried.W_c = W_c;
  trum_plain_filling(&p->carried);
  p->carried.fullness_root = trum_cbrt(p->carried.fullness);
  trum_plain_contact_winkler(&p->carried);
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
  const trum_real held = in->held * in->omega_n0, a = y->y[0] * in->omega_n0, b = y->y[2] * in->omega_n0;
  return held > 0 && p->gates.g_A == 0 && p->gates.g_B == 0 && trum_fabs(y->y[6]) <= in->D * in->k_c * held &&
         a * a + b * b + y->y[1] * y->y[1] + y->y[3] * y->y[3] <= held * held;
}

/* Both phases and the rotor's turning at rest; a rotor with a mass goes on up and down. */
static inline void trum_coupled_rest(trum_coupled_vector* y) {
  y->y[0] = y->y[1] = y->y[2] = y->y[3] = y->y[6] = 0;
}

/* Rates of a state at a phase of the drive, without the phases' own swing. */
static inline trum_coupled_vector trum_coupled_rates(trum_coupled_point* p, const trum_coupled_vector* of, trum_real phase) {
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
  trum_plain_coupled_instant(&p->place, &s, &surface);
  trum_plain_coupled_forces(&p->place, &s, &surface, &acting);
  rate.y[0] = 0, rate.y[1] = (on_A + in->reaction * acting.Q_A) / in->M_q;
  rate.y[2] = 0, rate.y[3] = (on_B + in->reaction * acting.Q_B) / in->M_q;
  rate.y[4] = in->mass > 0 ? of->y[5] : 0;
  rate.y[5] = in->mass > 0 ? (acting.F_z - in->F_c) / in->mass : 0;
  rate.y[6] = in->r_c * (in->r_c * acting.F_x - in->T_load) / in->J_total;
  p->power = on_A * s.v_A + on_B * s.v_B;
  p->touching = surface.theta, p->wave = surface.W_c;
  return rate;
}

/* a + h b */
static inline trum_coupled_vector trum_coupled_add(const trum_coupled_vector* a, trum_real h, const trum_coupled_vector* b) {
  trum_coupled_vector sum;
  int k;
  for (k = 0; k < trum_coupled_size; ++k) sum.y[k] = a->y[k] + h * b->y[k];
  return sum;
}

/* What the phases' own swing makes of a state or of a rate; the rotor's part stays. */
static inline trum_coupled_vector trum_coupled_swung(const trum_flow* by, const trum_coupled_vector* of) {
  trum_coupled_vector to = *of;
  int k;
  for (k = 0; k < 4; k += 2) {
    to.y[k] = by->w_w * of->y[k] + by->w_v * of->y[k + 1];
    to.y[k + 1] = by->v_w * of->y[k] + by->v_v * of->y[k + 1];
  }
  return to;
}

/* One step; adds power and touching, weighted by Simpson's rule. */
static inline trum_coupled_vector trum_coupled_step(trum_coupled_point* p, const trum_coupled_vector* from, const trum_flow* half,
                                                    trum_real h, trum_real phase, trum_coupled_lap_out* sums) {
  const trum_real turn = p->in->omega_q * h / 2, third = h / 3;
  trum_coupled_vector one, two, three, four, at, swung, rates;
  one = trum_coupled_rates(p, from, phase);
  sums->input += p->power / 6, sums->touching += p->touching / 6;
  at = trum_coupled_add(from, h / 2, &one), at = trum_coupled_swung(half, &at);
  two = trum_coupled_rates(p, &at, phase + turn);
  swung = trum_coupled_swung(half, from);
  at = trum_coupled_add(&swung, h / 2, &two);
  three = trum_coupled_rates(p, &at, phase + turn);
  sums->input += 2 * p->power / 3, sums->touching += 2 * p->touching / 3;
  rates = trum_coupled_swung(half, &three);
  swung = trum_coupled_swung(half, &swung);
  at = trum_coupled_add(&swung, h, &rates);
  four = trum_coupled_rates(p, &at, phase + 2 * turn);
  sums->input += p->power / 6, sums->touching += p->touching / 6;
  rates = trum_coupled_swung(half, &one);
  rates = trum_coupled_add(&rates, 2, &two), rates = trum_coupled_add(&rates, 2, &three);
  rates = trum_coupled_swung(half, &rates);
  rates = trum_coupled_add(&rates, 1, &four);
  return trum_coupled_add(&swung, third / 2, &rates);
}

/* Drive periods from a state: the state after them, and means and extremes. */
static inline void trum_coupled_lap(const trum_coupled_lap_in* in, trum_coupled_lap_out* out) {
  const trum_real pi = TRUM_C(3.14159265358979323846);
  const trum_real h = 2 * pi / in->omega_q / in->steps;
  trum_coupled_point p;
  trum_coupled_vector y;
  trum_mode mode;
  trum_flow half;
  long period;
  int resting = 0;
  p.in = in, p.wave = 0;
  p.place.D = in->D, p.place.F_c = in->F_c, p.place.k_N = in->k_N, p.place.k_c = in->k_c, p.place.mu = in->mu;
  p.place.n_j = in->n_j;
  trum_plain_engagement(&p.place, &p.carried);
  mode.omega_n0 = in->omega_n0, mode.xi = in->xi;
  trum_plain_mode_flow(&mode, &half, h / 2);
  y.y[0] = in->w_A, y.y[1] = in->v_A, y.y[2] = in->w_B, y.y[3] = in->v_B;
  y.y[4] = in->height, y.y[5] = in->climb, y.y[6] = in->v;
  out->mean = out->square = out->input = out->touching = out->highest = 0;
  out->low = out->high = in->v;
  for (period = 0; (trum_real)period < in->m; ++period) {
    const long steps = (long)(in->steps * trum_fmin(1, in->m - (trum_real)period) + TRUM_C(0.5));
    long step;
    p.gates = trum_coupled_gates(in, period);
    resting = resting && p.gates.g_A == 0 && p.gates.g_B == 0;
    for (step = 0; step < steps; ++step) {
      const trum_real phase = in->force_phase + 2 * pi * (trum_real)step / in->steps, before = y.y[6];
      resting = resting || trum_coupled_stops(&p, &y);
      if (resting) {
        trum_coupled_rest(&y);
        out->low = trum_fmin(out->low, 0), out->high = trum_fmax(out->high, 0);
        if (!(in->mass > 0)) { /* nothing moves: the whole wave touches */
          out->touching += pi * (trum_real)(steps - step);
          break;
        }
      }
      y = trum_coupled_step(&p, &y, &half, h, phase, out);
      if (resting) {
        trum_coupled_rest(&y);
        continue;
      }
      out->mean += (before + y.y[6]) / 2;
      out->square += (before * before + before * y.y[6] + y.y[6] * y.y[6]) / 3;
      out->low = trum_fmin(out->low, y.y[6]), out->high = trum_fmax(out->high, y.y[6]);
      out->highest = trum_fmax(out->highest, p.wave);
    }
  }
  out->mean /= in->m * in->steps, out->square /= in->m * in->steps;
  out->input /= in->m * in->steps, out->touching /= pi * in->m * in->steps;
  out->w_A = y.y[0], out->v_A = y.y[1], out->w_B = y.y[2], out->v_B = y.y[3];
  out->height = (in->mass > 0) ? y.y[4] : trum_coupled_height(&p, trum_sqrt(y.y[0] * y.y[0] + y.y[2] * y.y[2]));
  out->climb = y.y[5], out->v = y.y[6];
}

#endif
