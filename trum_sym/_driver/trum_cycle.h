/* Loops around the generated kernels: where the load balances, and what one drive cycle's determinant sums to.
 * Formulas live in the generated C; here are only root finding, quadrature and bookkeeping.
 *
 * C99 without allocation or globals, which is also C++. */
#ifndef TRUM_CYCLE_H
#define TRUM_CYCLE_H

#include "trum_kernels.h"
#include "trum_plain_calls.h"
#include "trum_quadrature.h"

/* A function of one variable and its slope. */
typedef void (*trum_curve)(void* of, trum_real x, trum_real* value, trum_real* slope);

/* Newton on a bracketed root, with bisection whenever Newton leaves the bracket or stalls.
 * Zero counts as positive, so f(low) = 0 < f's later fall is no root yet; f(low) and f(high) have different signs in
 * that sense, and 0 <= low < high. */
static inline trum_real trum_bracketed_root(trum_curve f, void* of, trum_real low, trum_real high) {
  trum_real value, slope, smallest, x, width_before;
  int i, rising;
  f(of, low, &value, &slope);
  rising = value < 0;
  smallest = TRUM_EITHER(1e-16, 6e-8) * (high - low);
  x = TRUM_C(0.5) * (low + high), width_before = high - low;
  for (i = 0; i < 200; ++i) {
    trum_real width, next, change;
    int usable;
    f(of, x, &value, &slope);
    if ((value < 0) == rising) low = x;
    else high = x;
    width = high - low;
    next = x - value / slope;
    usable = next > low && next < high && (i % 3 != 2 || width < TRUM_C(0.5) * width_before);
    if (i % 3 == 2) width_before = width;
    if (!usable) next = TRUM_C(0.5) * (low + high);
    change = next > x ? next - x : x - next;
    if (width <= smallest || change <= TRUM_EITHER(2e-16, 1.2e-7) * next) return next;
    x = next;
  }
  return x;
}

static inline void trum_balance_at(void* of, trum_real theta, trum_real* value, trum_real* slope) {
  trum_balance_values at;
  trum_plain_winkler_balance((const trum_balance*)of, &at, theta);
  *value = at.residual, *slope = at.slope;
}

/* Half-angle in (0, pi] at which the Winkler layer carries the prepressure; pi: the whole wave is in contact. */
static inline trum_real trum_half_angle(trum_real F_c, trum_real k_N, trum_real W, trum_real k_c, trum_real n_j) {
  const trum_real pi = TRUM_C(3.14159265358979323846);
  trum_balance b;
  trum_real residual, slope;
  b.F_c = F_c, b.k_N = k_N, b.W = W, b.k_c = k_c, b.n_j = n_j;
  trum_balance_at(&b, pi, &residual, &slope);
  if (!(residual < 0)) return F_c == F_c && W == W ? pi : F_c + W;
  return trum_bracketed_root(trum_balance_at, &b, 0, pi);
}

/* One drive cycle: what the determinant needs to be evaluated anywhere in it. */
typedef struct {
  trum_cycle_constants constants;
  trum_free_motion before; /* t1 */
  trum_real duration[TRUM_REGIONS];
  trum_free_motion start[TRUM_REGIONS]; /* of the regions */
  trum_free_motion state;               /* at the start of the region entered last */
  trum_gates gates;                     /* of that region */
  trum_phases at;                       /* filled by trum_cycle_at */
} trum_cycle;

/* Fills the regions of a cycle whose constants and motion before t1 are set. */
static inline void trum_cycle_regions(trum_cycle* c) {
  trum_real out[trum_regions_n_res];
  int r;
  trum_plain_regions(&c->constants, &c->before, out);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    const trum_real* start = &out[trum_regions_out_a_A_redu + 4 * r];
    c->duration[r] = out[trum_regions_out_time_redu + r];
    c->start[r].a_A = start[0], c->start[r].b_A = start[1], c->start[r].a_B = start[2], c->start[r].b_B = start[3];
  }
}

static inline void trum_cycle_enter(trum_cycle* c, int region) {
  static const trum_real gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
  c->state = c->start[region];
  c->gates.g_A = gates_A[region], c->gates.g_B = gates_B[region];
}

/* Both phases and the determinant, tau after the start of the region entered last. */
static inline void trum_cycle_at(trum_cycle* c, trum_real tau) {
  trum_plain_response(&c->constants, &c->state, &c->gates, &c->at, tau);
}

/* Integrals over a cycle of Q's positive part, of its negative part's magnitude, and of their squares. */
typedef struct {
  trum_real q_plus, q_minus, p_plus, p_minus;
} trum_sums;

typedef struct {
  trum_real tau, Q, rate;
} trum_sample;

static inline trum_sample trum_sample_at(trum_cycle* c, trum_real tau) {
  trum_sample here;
  trum_cycle_at(c, tau);
  here.tau = tau, here.Q = c->at.Q, here.rate = c->at.Q_rate;
  return here;
}

static inline void trum_determinant_at(void* of, trum_real tau, trum_real* value, trum_real* slope) {
  const trum_sample here = trum_sample_at((trum_cycle*)of, tau);
  *value = here.Q, *slope = here.rate;
}

static inline void trum_add(trum_sums* sums, trum_real integral, trum_real square) {
  if (integral >= 0) sums->q_plus += integral, sums->p_plus += square;
  else sums->q_minus -= integral, sums->p_minus += square;
}

/* Gauss-Legendre over [from, to], where Q keeps its sign, taken off what the panel has left. */
static inline void trum_piece(trum_cycle* c, trum_sums* sums, trum_real from, trum_real to, trum_real* integral_left,
                              trum_real* square_left) {
  static const trum_real nodes[] = TRUM_GAUSS_NODES, weights[] = TRUM_GAUSS_WEIGHTS;
  const trum_real half = TRUM_C(0.5) * (to - from), middle = TRUM_C(0.5) * (to + from);
  trum_real integral = 0, square = 0;
  int i;
  for (i = 0; i < TRUM_GAUSS_POINTS; ++i) {
    const trum_real Q = trum_sample_at(c, middle + half * (trum_real)nodes[i]).Q;
    integral += (trum_real)weights[i] * Q;
    square += (trum_real)weights[i] * Q * Q;
  }
  *integral_left -= half * integral, *square_left -= half * square;
  trum_add(sums, half * integral, half * square);
}

/* The extremum between two samples, by bisection on the rate; exact enough to see Q's sign there. */
static inline trum_sample trum_extremum(trum_cycle* c, const trum_sample* p, const trum_sample* q) {
  trum_real low = p->tau, high = q->tau;
  trum_sample here = *p;
  int i;
  for (i = 0; i < 40; ++i) {
    here = trum_sample_at(c, TRUM_C(0.5) * (low + high));
    if ((here.Q >= 0) != (p->Q >= 0)) break;
    if ((here.rate < 0) == (p->rate < 0)) low = here.tau;
    else high = here.tau;
  }
  return here;
}

/* Zero counts as positive, as in the sign changes: a phase at rest starts a region with Q = 0. */
static inline int trum_towards_zero(const trum_sample* p) { return p->Q >= 0 ? p->rate < 0 : p->rate > 0; }

/* Whether |Q| dips between two samples of one sign, so near to zero that it may cross it: samples stand so close that
 * the steeper of their slopes, doubled, bounds those between. */
static inline int trum_may_dip(const trum_sample* p, const trum_sample* q) {
  const trum_real fall = p->rate < 0 ? -p->rate : p->rate, rise = q->rate < 0 ? -q->rate : q->rate;
  const trum_real depth = 2 * (q->tau - p->tau) * (fall > rise ? fall : rise);
  const trum_real low = p->Q < 0 ? -p->Q : p->Q, high = q->Q < 0 ? -q->Q : q->Q;
  return trum_towards_zero(p) && !trum_towards_zero(q) && (low < high ? low : high) <= depth;
}

/* Gauss-Legendre on a panel short against the fastest oscillation of Q; a panel in which Q changes sign is cut at
 * every crossing, so that each piece is smooth and of one sign. */
static inline void trum_panel(trum_cycle* c, trum_sums* sums, const trum_sample* left, const trum_sample* right,
                              trum_real from, trum_real to) {
  static const trum_real nodes[] = TRUM_GAUSS_NODES, weights[] = TRUM_GAUSS_WEIGHTS;
  const trum_real half = TRUM_C(0.5) * (to - from), middle = TRUM_C(0.5) * (to + from);
  trum_sample s[TRUM_GAUSS_POINTS + 2];
  trum_real integral = 0, square = 0, start = from;
  int i, k, count;
  s[0] = *left, s[TRUM_GAUSS_POINTS + 1] = *right;
  for (i = 0; i < TRUM_GAUSS_POINTS; ++i) {
    s[i + 1] = trum_sample_at(c, middle + half * (trum_real)nodes[i]);
    integral += (trum_real)weights[i] * s[i + 1].Q;
    square += (trum_real)weights[i] * s[i + 1].Q * s[i + 1].Q;
  }
  integral *= half, square *= half;
  for (i = 0; i <= TRUM_GAUSS_POINTS; ++i) {
    const trum_sample *p = &s[i], *q = &s[i + 1];
    trum_real cuts[2];
    count = 0;
    if ((p->Q >= 0) != (q->Q >= 0)) {
      cuts[count++] = trum_bracketed_root(trum_determinant_at, c, p->tau, q->tau);
    } else if (trum_may_dip(p, q)) {
      const trum_sample dip = trum_extremum(c, p, q);
      if ((dip.Q >= 0) != (p->Q >= 0)) {
        cuts[count++] = trum_bracketed_root(trum_determinant_at, c, p->tau, dip.tau);
        cuts[count++] = trum_bracketed_root(trum_determinant_at, c, dip.tau, q->tau);
      }
    }
    for (k = 0; k < count; ++k) {
      trum_piece(c, sums, start, cuts[k], &integral, &square);
      start = cuts[k];
    }
  }
  trum_add(sums, integral, square);
}

/* The time of a region that the determinant's panels cover: all of it, or, in a long schedule, that in which the phases' free
 * motion dies away to nothing beside the drive's.  What is left has one determinant, the steady wave's, or none. */
static inline trum_real trum_covered(const trum_cycle* c, int region) {
  const trum_cycle_constants* k = &c->constants;
  const trum_free_motion* z = &c->start[region];
  const trum_real decay = k->xi * k->omega_n;
  trum_real omega_d, A, B, size, time;
  if (!(k->m > TRUM_C(0.5) + TRUM_REPEATS_BEYOND && decay > 0)) return c->duration[region];
  omega_d = k->omega_n * trum_sqrt(1 - k->xi * k->xi);
  A = (z->b_A + decay * z->a_A) / omega_d, B = (z->b_B + decay * z->a_B) / omega_d;
  size = trum_sqrt(z->a_A * z->a_A + A * A + (z->a_B * z->a_B + B * B));
  time = size > 0 ? trum_log(size / (TRUM_C(1e-20) * k->W)) / decay : 0;
  return time < 0 ? 0 : time < c->duration[region] ? time : c->duration[region];
}

/* Adds what the region entered last has beyond that time. */
static inline void trum_add_steady(trum_cycle* c, trum_sums* sums, int region) {
  const trum_real covered = trum_covered(c, region), left = c->duration[region] - covered;
  if (left > 0) {
    const trum_real Q = trum_sample_at(c, covered).Q;
    trum_add(sums, left * Q, left * Q * Q);
  }
}

/* How many panels a region takes, at so many in a period of the faster of drive and resonance. */
static inline trum_real trum_panel_count(const trum_cycle* c, int region, trum_real panels_per_period) {
  const trum_real omega_n = c->constants.omega_n, driven = omega_n + c->constants.Delta_omega;
  const trum_real fastest = omega_n < driven ? driven : omega_n;
  const trum_real turns = panels_per_period * trum_covered(c, region) * fastest / TRUM_C(6.283185307179586);
  return trum_ceil(turns - TRUM_EITHER(1e-9, 1e-4));
}

/* The sums of a cycle whose constants and motion before t1 are set, on so many panels in a period. */
static inline trum_sums trum_cycle_sums(trum_cycle* c, trum_real panels_per_period) {
  trum_sums sums = {0, 0, 0, 0};
  int region;
  trum_cycle_regions(c);
  for (region = 0; region < TRUM_REGIONS; ++region) {
    const trum_real length = trum_covered(c, region), count = trum_panel_count(c, region, panels_per_period);
    trum_sample left;
    trum_real i;
    if (!(c->duration[region] > 0)) continue;
    trum_cycle_enter(c, region);
    trum_add_steady(c, &sums, region);
    left = trum_sample_at(c, 0);
    for (i = 0; i < count; ++i) {
      const trum_real from = length * (i / count), to = length * ((i + 1) / count);
      const trum_sample right = trum_sample_at(c, to);
      trum_panel(c, &sums, &left, &right, from, to);
      left = right;
    }
  }
  return sums;
}

#endif
