/* The rotor's periodic orbit: time steps, laps of the drive cycle, and the search for the lap that repeats itself.
 *
 * C99 without allocation or globals, which is also C++: with TRUM_LANES defined, `real` is a class of that many
 * points side by side and `mask` their truth values; else `real` is a plain number and there is one lane.  Every
 * operation acts on each lane alone, so a point's results do not depend on its neighbours or on their number.
 *
 * The rim's speed obeys v' = push f(v, t) - drag, and f falls as v rises.  Where v(t) meets the surface's fastest
 * point, f has a square root in time; where a point of equal speed crosses the edge of the contact, f has a kink.
 * Steps end at those events, and next to a square root the time in a step runs as the square of its parameter,
 * where everything is smooth again.  Between events a step is collocation at Lobatto's nodes. */
#ifndef TRUM_ORBIT_H
#define TRUM_ORBIT_H

#ifndef TRUM_LANES
#include <math.h>
#define TRUM_LANES 1
#ifndef casadi_real
#define casadi_real double
#endif
#include "trum_kernels.h"
typedef casadi_real real;
typedef int mask;
#define TRUM_KERNEL(name) name
#define TRUM_NUMBER(x) ((real)(x))
static mask less_than(real a, real b) { return a < b; }
static mask at_most(real a, real b) { return a <= b; }
static mask no(mask a) { return !a; }
static mask is(int a) { return a; }
static int any(mask a) { return a; }
static int in_lane(mask a, int i) { return i == 0 && a; }
static real sel(mask m, real a, real b) { return m ? a : b; }
static mask sel_mask(mask m, mask a, mask b) { return m ? a : b; }
static real least(real a, real b) { return a < b ? a : b; }
static real most(real a, real b) { return a > b ? a : b; }
static real size_of(real a) { return a < 0 ? -a : a; }
static double get(const real* x, int i) { return (void)i, (double)*x; }
static void put(real* x, int i, double value) { (void)i, *x = (real)value; }
static void put_mask(mask* x, int i, int value) { (void)i, *x = value; }
static real root_of(real a) { return (real)sqrt((double)a); }
static real cube_root_of(real a) { return (real)cbrt((double)a); }
static real inverse_of(real a) { return 1 / a; }
#endif
#include "trum_collocation.h"

#define N_ TRUM_NUMBER

enum { trum_converged = 1, trum_full_contact = 2, trum_runaway = 4 };
enum { EDGE = TRUM_COLLOCATION_NODES - 1, NODES = TRUM_COLLOCATION_NODES };

/* What an orbit needs of a point: SI units, angles in rad. */
typedef struct {
  double omega_n, Delta_omega, xi, psi, s, m, n;
  double a_A, b_A, a_B, b_B; /* free motion before t1 */
  double W, D, k_c, engagement_per_height, W_full, hertz, push, drag;
  double tolerance; /* of mean and extremes, relative to the largest speed */
} trum_orbit_in;

/* Speeds of the rim, m/s; means of theta/pi and of the friction fraction on a held rotor. */
typedef struct {
  double mean, low, high, variance, contact, held, start, level, error, flags;
} trum_orbit_out;

/* One lap's figures: sums are over time from its start, x is the rim's speed over that at the start. */
typedef struct {
  real gain, growth;              /* x at the end, and its derivative by the speed at the start */
  real x, xx, S, xS;              /* integrals of x, x^2, S = dv/dv0 and x S */
  real low, high, S_low, S_high;  /* extremes of x, and S there */
  real friction, angle;           /* integrals of f and theta/pi */
  real full, fastest, error;      /* any full contact; largest surface speed; sum of the steps' errors of integral f */
} trum_lap;

/* Events, in the order of the functions that change sign there. */
enum { SPEED, LARGER, SMALLER, FULL, EVENTS };

/* The surface and the contact at an instant. */
typedef struct {
  real R_v, phi, cos_phi, sin_phi, engagement, theta, sin_theta, share, W_c;
} trum_surface;

/* Speed and distance of lane 0 at equal times of a lap. */
typedef struct {
  double *speed, *distance;
  double spacing, since, travelled;
  long count, written;
} trum_record;

/* Lanes of points under way. */
typedef struct {
  real omega_n, Delta_omega, xi, s, W, D, k_c, engagement_per_height, W_full, push, drag, period, whole;
  real free_[4], drive_re, drive_im, g_A, g_B; /* the region's phasors at its start, its gates */
  real v0, per_allowed, event_error, kink_error;   /* of the lap: start speed; 1/error of a step's integral f, 1/s; of events */
  real newton_error;                           /* last change of a step's speeds, whose square is the error left */
  real tau, left, h, natural, bend;            /* place in the region; the step, its size without events, its map */
  real target, tries, patience;                /* the event that the step is to end at, or -1 */
  real x, S, f, f_v, angle0, cos_phi, sin_phi, event[EVENTS];    /* where the step begins */
  mask fresh[EVENTS];                          /* it begins at this event */
  mask active, cold, lost;
  int hertz;
  trum_lap lap;
  trum_record* record;
} trum_lanes;

/* Steps, in drive periods: the longest, a lap's first, the shortest that is ever rejected, and the shortest that has to
 * see the wave turn by less than this cosine from node to node. */
static const double trum_longest = 1.0 / 24.0, trum_first = 1.0 / 24.0, trum_shortest = 1e-9;
static const double trum_sees = 2e-4, trum_cosine = 0.4;
/* A step's length follows the fourth root of its error, with a margin, and grows by no more than this. */
static const double trum_margin = 0.8, trum_grows = 1.5;
/* Shares that make the figures meet the tolerance: error of a step per drive period, of the quadrature's estimate, of
 * an event's place beside a square root and at a kink, of Newton's last change squared.  Measured over the domain. */
static const double trum_level = 0.05, trum_estimate = 0.2, trum_event = 4.0, trum_kink = 100.0, trum_newton = 0.05;

static void trum_turn(const trum_lanes* l, real tau, real* turn) {
  const real* arg[trum_rotation_n_arg];
  real* res[trum_rotation_n_res];
  int k;
  arg[trum_rotation_in_Delta_omega] = &l->Delta_omega, arg[trum_rotation_in_omega_n] = &l->omega_n;
  arg[trum_rotation_in_tau] = &tau, arg[trum_rotation_in_xi] = &l->xi;
  for (k = 0; k < 4; ++k) res[k] = &turn[k];
  TRUM_KERNEL(trum_rotation)(arg, res, 0, 0, 0);
}

static void trum_look(const trum_lanes* l, real tau, trum_surface* at) {
  real turn[4];
  trum_turn(l, tau, turn);
  {
    const real* arg[trum_wave_n_arg];
    real* res[trum_wave_n_res];
    arg[trum_wave_in_omega_n] = &l->omega_n, arg[trum_wave_in_Delta_omega] = &l->Delta_omega;
    arg[trum_wave_in_xi] = &l->xi, arg[trum_wave_in_s] = &l->s, arg[trum_wave_in_W] = &l->W;
    arg[trum_wave_in_D] = &l->D, arg[trum_wave_in_k_c] = &l->k_c;
    arg[trum_wave_in_f_A_re] = &l->free_[0], arg[trum_wave_in_f_A_im] = &l->free_[1];
    arg[trum_wave_in_f_B_re] = &l->free_[2], arg[trum_wave_in_f_B_im] = &l->free_[3];
    arg[trum_wave_in_p_re] = &l->drive_re, arg[trum_wave_in_p_im] = &l->drive_im;
    arg[trum_wave_in_e_re] = &turn[0], arg[trum_wave_in_e_im] = &turn[1];
    arg[trum_wave_in_d_re] = &turn[2], arg[trum_wave_in_d_im] = &turn[3];
    arg[trum_wave_in_g_A] = &l->g_A, arg[trum_wave_in_g_B] = &l->g_B;
    res[trum_wave_out_W_c] = &at->W_c, res[trum_wave_out_R_v] = &at->R_v, res[trum_wave_out_phi] = &at->phi;
    res[trum_wave_out_cos_phi] = &at->cos_phi, res[trum_wave_out_sin_phi] = &at->sin_phi;
    TRUM_KERNEL(trum_wave)(arg, res, 0, 0, 0);
  }
  if (l->hertz) {
    const real* arg[trum_contact_hertz_n_arg];
    real* res[trum_contact_hertz_n_res];
    arg[trum_contact_hertz_in_W_c] = &at->W_c, arg[trum_contact_hertz_in_W_full] = &l->W_full;
    res[trum_contact_hertz_out_theta] = &at->theta, res[trum_contact_hertz_out_sin_theta] = &at->sin_theta;
    res[trum_contact_hertz_out_share] = &at->share, res[trum_contact_hertz_out_engagement] = &at->engagement;
    TRUM_KERNEL(trum_contact_hertz)(arg, res, 0, 0, 0);
  } else {
    real fullness, fullness_root;
    const real* arg[trum_contact_winkler_n_arg];
    real* res[trum_contact_winkler_n_res];
    {
      const real* arg_[trum_filling_n_arg];
      real* res_[trum_filling_n_res];
      arg_[trum_filling_in_W_c] = &at->W_c;
      arg_[trum_filling_in_engagement_per_height] = &l->engagement_per_height;
      res_[trum_filling_out_engagement] = &at->engagement, res_[trum_filling_out_fullness] = &fullness;
      TRUM_KERNEL(trum_filling)(arg_, res_, 0, 0, 0);
    }
    fullness_root = cube_root_of(fullness);
    arg[trum_contact_winkler_in_fullness] = &fullness, arg[trum_contact_winkler_in_fullness_root] = &fullness_root;
    res[trum_contact_winkler_out_theta] = &at->theta, res[trum_contact_winkler_out_sin_theta] = &at->sin_theta;
    res[trum_contact_winkler_out_share] = &at->share;
    TRUM_KERNEL(trum_contact_winkler)(arg, res, 0, 0, 0);
  }
}

/* Friction fraction, its slope, and the larger and smaller pressure at the points as fast as the rotor: where the crest
 * jumps, those two points swap. */
static void trum_rub(const trum_surface* at, real v, real* f, real* f_v, real* larger, real* smaller) {
  real p_1, p_2;
  const real* arg[trum_friction_n_arg];
  real* res[trum_friction_n_res];
  arg[trum_friction_in_R_v] = &at->R_v, arg[trum_friction_in_phi] = &at->phi;
  arg[trum_friction_in_cos_phi] = &at->cos_phi, arg[trum_friction_in_sin_phi] = &at->sin_phi;
  arg[trum_friction_in_engagement] = &at->engagement, arg[trum_friction_in_share] = &at->share;
  arg[trum_friction_in_theta] = &at->theta, arg[trum_friction_in_sin_theta] = &at->sin_theta;
  arg[trum_friction_in_v] = &v;
  res[trum_friction_out_f] = f, res[trum_friction_out_f_v] = f_v;
  res[trum_friction_out_p_1] = &p_1, res[trum_friction_out_p_2] = &p_2;
  TRUM_KERNEL(trum_friction)(arg, res, 0, 0, 0);
  *larger = most(p_1, p_2), *smaller = least(p_1, p_2);
}

/* Solves y_i = right_i + sum_j A_ij K_j y_j for the nodes after the first. */
static void trum_solve(const real* K, const real* right, real* y) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  real M[3][3], b[3], first, second;
  int i, j;
  for (i = 0; i < 3; ++i) {
    for (j = 0; j < 3; ++j) M[i][j] = N_(i == j ? 1.0 : 0.0) - N_(A[i + 1][j + 1]) * K[j + 1];
    b[i] = right[i + 1];
  }
  first = inverse_of(M[0][0]);
  for (i = 1; i < 3; ++i) {
    const real t = M[i][0] * first;
    M[i][1] = M[i][1] - t * M[0][1], M[i][2] = M[i][2] - t * M[0][2], b[i] = b[i] - t * b[0];
  }
  second = inverse_of(M[1][1]);
  {
    const real t = M[2][1] * second;
    y[3] = (b[2] - t * b[1]) * inverse_of(M[2][2] - t * M[1][2]);
  }
  y[2] = (b[1] - M[1][2] * y[3]) * second;
  y[1] = (b[0] - M[0][1] * y[2] - M[0][2] * y[3]) * first;
}

/* The cubic through (0, e0), (z1, e1), (z2, e2), (1, e3). */
typedef struct {
  real e0, d1, d2, d3, z1, z2;
} trum_cubic;

/* Reciprocals of the distances of the nodes, which all cubics of a step share. */
typedef struct {
  real z1, z2, of_01, of_12, of_23, of_02, of_13;
} trum_places;

static trum_places trum_space(const real* z) {
  trum_places s;
  s.z1 = z[1], s.z2 = z[2];
  s.of_01 = inverse_of(z[1]), s.of_12 = inverse_of(z[2] - z[1]), s.of_23 = inverse_of(N_(1) - z[2]);
  s.of_02 = inverse_of(z[2]), s.of_13 = inverse_of(N_(1) - z[1]);
  return s;
}

static trum_cubic trum_through(const trum_places* s, real e0, real e1, real e2, real e3) {
  trum_cubic c;
  const real d01 = (e1 - e0) * s->of_01, d12 = (e2 - e1) * s->of_12, d23 = (e3 - e2) * s->of_23;
  const real d012 = (d12 - d01) * s->of_02, d123 = (d23 - d12) * s->of_13;
  c.e0 = e0, c.d1 = d01, c.d2 = d012, c.d3 = d123 - d012, c.z1 = s->z1, c.z2 = s->z2;
  return c;
}

static real trum_cubic_at(const trum_cubic* c, real z) {
  return c->e0 + z * (c->d1 + (z - c->z1) * (c->d2 + (z - c->z2) * c->d3));
}

static real trum_cubic_slope(const trum_cubic* c, real z) {
  const real inner = c->d2 + (z - c->z2) * c->d3;
  return c->d1 + (z - c->z1) * inner + z * (inner + (z - c->z1) * c->d3);
}

/* Where the step first meets an event: its place, 2 if none, and which.  Saturated friction has no edges to cross. */
static void trum_first_event(const trum_lanes* l, const real* z, real (*e)[EVENTS], trum_cubic* cubic, real* place,
                             real* which) {
  const trum_places spaces = trum_space(z);
  const mask saturated = at_most(sel(l->fresh[SPEED], e[1][SPEED], e[0][SPEED]), N_(0));
  int k, j;
  *place = N_(2), *which = N_(-1);
  for (k = 0; k < EVENTS; ++k) {
    const mask fresh = l->fresh[k], positive = less_than(N_(0), sel(fresh, e[1][k], e[0][k]));
    const trum_cubic c = cubic[k] = trum_through(&spaces, e[0][k], e[1][k], e[2][k], e[EDGE][k]);
    mask found = is(0);
    real from = N_(0), to = N_(0), root;
    for (j = 1; j < NODES; ++j) {
      const mask crossed = no(found) & (less_than(N_(0), e[j][k]) ^ positive);
      from = sel(crossed, z[j - 1], from), to = sel(crossed, z[j], to), found = found | crossed;
    }
    { /* it may cross and turn back between two nodes, where the cubic is lowest (highest, if it begins negative) */
      const real side = sel(positive, N_(1), N_(-1));
      const real c3 = side * c.d3, c2 = side * (c.d2 - (c.z1 + c.z2) * c.d3);
      const real c1 = side * (c.d1 - c.z1 * (c.d2 - c.z2 * c.d3)), square = c2 * c2 - N_(3) * c1 * c3;
      const real below = c2 + root_of(most(square, N_(0)));
      const mask bowl = less_than(N_(0), square) & less_than(N_(1e-300), size_of(below));
      const real lowest = sel(bowl, -c1 * inverse_of(sel(bowl, below, N_(1))), N_(-1));
      const real begin = sel(fresh, z[1], N_(0));
      const mask inside = bowl & less_than(begin, lowest) & less_than(lowest, sel(found, to, N_(1)));
      const mask crossed = inside & at_most(side * trum_cubic_at(&c, lowest), N_(0));
      from = sel(crossed, begin, from), to = sel(crossed, lowest, to), found = found | crossed;
    }
    if (k == LARGER || k == SMALLER) found = found & no(saturated);
    if (!any(found & l->active)) continue;
    {
      const real at_from = trum_cubic_at(&c, from), at_to = trum_cubic_at(&c, to);
      const mask bracket = less_than(at_from * at_to, N_(0));
      root = from + (to - from) * (at_from * inverse_of(sel(bracket, at_from - at_to, N_(1))));
      root = sel(bracket, root, from);
    }
    for (j = 0; j < 3; ++j) {
      const real slope = trum_cubic_slope(&c, root);
      const mask steep = less_than(N_(1e-200), size_of(slope));
      root = sel(steep, root - trum_cubic_at(&c, root) * inverse_of(sel(steep, slope, N_(1))), root);
      root = most(from, least(to, root));
    }
    {
      const mask earlier = found & less_than(root, *place);
      *place = sel(earlier, root, *place), *which = sel(earlier, N_(k), *which);
    }
  }
}

/* Lowest and highest x in a step: at its end, or where its rate, a cubic in the step's parameter, is zero. */
static void trum_extremes(const real* G, const real* x, real S0, real S1, mask accepted, trum_lap* lap) {
  static const double P[NODES][NODES] = TRUM_COLLOCATION_POWERS;
  real p[NODES], top = most(x[0], x[1]), bottom = least(x[0], x[1]), steepest = size_of(G[0]);
  mask turns = is(0), needed;
  int k, j;
  for (j = 1; j < NODES; ++j) {
    top = most(top, x[j]), bottom = least(bottom, x[j]), steepest = most(steepest, size_of(G[j]));
    turns = turns | (at_most(G[j] * G[j - 1], N_(0)));
  }
  /* no interior value is further than this from a node's */
  needed = accepted & turns;
  needed = needed & (less_than(lap->high, top + N_(0.5) * steepest) | less_than(bottom - N_(0.5) * steepest, lap->low));
  if (any(needed)) {
    for (k = 0; k < NODES; ++k) {
      p[k] = N_(P[k][0]) * G[0];
      for (j = 1; j < NODES; ++j) p[k] = p[k] + N_(P[k][j]) * G[j];
    }
    for (k = 0; k < 3; ++k) { /* the rate's zeros by Newton from the middles of the thirds */
      real at = N_((2.0 * k + 1.0) / 6.0), value, S;
      mask lower, higher;
      for (j = 0; j < 4; ++j) {
        const real slope = p[1] + at * (N_(2) * p[2] + at * N_(3) * p[3]);
        const real rate = p[0] + at * (p[1] + at * (p[2] + at * p[3]));
        const mask steep = less_than(N_(1e-200), size_of(slope));
        at = most(N_(0), least(N_(1), sel(steep, at - rate * inverse_of(sel(steep, slope, N_(1))), at)));
      }
      value = x[0] + at * (p[0] + at * (N_(1.0 / 2) * p[1] + at * (N_(1.0 / 3) * p[2] + at * N_(1.0 / 4) * p[3])));
      S = S0 + at * (S1 - S0);
      lower = needed & less_than(value, lap->low), higher = needed & less_than(lap->high, value);
      lap->low = sel(lower, value, lap->low), lap->S_low = sel(lower, S, lap->S_low);
      lap->high = sel(higher, value, lap->high), lap->S_high = sel(higher, S, lap->S_high);
    }
  }
  {
    const mask lower = accepted & less_than(x[EDGE], lap->low), higher = accepted & less_than(lap->high, x[EDGE]);
    lap->low = sel(lower, x[EDGE], lap->low), lap->S_low = sel(lower, S1, lap->S_low);
    lap->high = sel(higher, x[EDGE], lap->high), lap->S_high = sel(higher, S1, lap->S_high);
  }
}

/* What the first step of a lap needs to know of its start. */
static void trum_begin(trum_lanes* l) {
  trum_surface at;
  real f, f_v, e[EVENTS];
  int k;
  trum_look(l, l->tau, &at);
  trum_rub(&at, l->v0 + l->x, &f, &f_v, &e[LARGER], &e[SMALLER]);
  e[SPEED] = at.R_v * at.R_v - (l->v0 + l->x) * (l->v0 + l->x);
  e[FULL] = at.W_c * at.W_c - l->W_full * l->W_full;
  l->f = sel(l->cold, f, l->f), l->f_v = sel(l->cold, f_v, l->f_v);
  l->angle0 = sel(l->cold, at.theta, l->angle0);
  l->cos_phi = sel(l->cold, at.cos_phi, l->cos_phi), l->sin_phi = sel(l->cold, at.sin_phi, l->sin_phi);
  for (k = 0; k < EVENTS; ++k) {
    l->event[k] = sel(l->cold, e[k], l->event[k]);
    l->fresh[k] = l->fresh[k] & no(l->cold);
  }
  l->cold = is(0);
}

/* Writes what falls into lane 0's step: speed and distance are polynomials of the step's parameter. */
static void trum_write(trum_record* r, const trum_lanes* l, const real* rate) {
  static const double P[NODES][NODES] = TRUM_COLLOCATION_POWERS;
  const double h = get(&l->h, 0), bend = get(&l->bend, 0), v0 = get(&l->v0, 0);
  double q[NODES + 1], travelled = 0.0;
  int k, j;
  q[0] = v0 + get(&l->x, 0);
  for (k = 0; k < NODES; ++k) {
    q[k + 1] = 0.0;
    for (j = 0; j < NODES; ++j) q[k + 1] += P[k][j] * get(&rate[j], 0) / (k + 1);
  }
  for (;;) {
    const double time = r->spacing * (double)(r->written + 1);
    const int last = r->written + 1 == r->count;
    double z = (time - r->since) / h, at = 1.0, power = 1.0, speed = 0.0, distance = 0.0;
    const int beyond = r->written == r->count || (z > 1.0 && !(last && time <= (r->since + h) * (1.0 + 1e-12)));
    if (!beyond) {
      z = z < 0.0 ? 0.0 : z > 1.0 ? 1.0 : z;
      at = bend > 0.0 ? 1.0 - sqrt(1.0 - z) : bend < 0.0 ? sqrt(z) : z;
    }
    for (k = 0; k <= NODES; ++k) {
      speed += q[k] * power;
      distance += h * q[k] * power * at * ((1.0 + bend) / (k + 1) - 2.0 * bend * at / (k + 2));
      power *= at;
    }
    if (beyond) {
      travelled = distance;
      break;
    }
    r->speed[r->written] = speed, r->distance[r->written] = r->travelled + distance;
    ++r->written;
  }
  r->travelled += travelled, r->since += h;
}

/* The error of a step's integral, from how fast its integrand's Legendre coefficients fall. */
static real trum_quadrature_error(const real* G) {
  static const double L[NODES][NODES] = TRUM_COLLOCATION_LEGENDRE;
  real l[NODES], whole, second, third;
  int k, j;
  for (k = 0; k < NODES; ++k) {
    l[k] = N_(L[k][0]) * G[0];
    for (j = 1; j < NODES; ++j) l[k] = l[k] + N_(L[k][j]) * G[j];
    l[k] = size_of(l[k]);
  }
  whole = l[0] + l[1] + N_(1e-300);
  second = l[2] / whole, third = cube_root_of(l[3] / whole + N_(1e-300));
  return N_(trum_estimate) * most(l[2] * second * root_of(second), l[3] * third * third);
}

/* Tries a step on all lanes; returns those which took it. */
static mask trum_step(trum_lanes* l) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  static const double c[NODES] = TRUM_COLLOCATION_POINTS, outward[NODES] = TRUM_COLLOCATION_OUTWARD;
  trum_surface at[NODES];
  real z[NODES], T[NODES], x[NODES], f[NODES], f_v[NODES], G[NODES], e[NODES][EVENTS], right[NODES], y[NODES];
  const mask held = at_most(l->push, N_(0));
  mask open = l->active, wrong, accepted;
  int i, j, k, tries;
  for (j = 0; j < NODES; ++j) {
    const real sigma = N_(c[j]);
    z[j] = sigma * (N_(1) + l->bend * (N_(1) - sigma));
    T[j] = l->h * (N_(1) + l->bend * (N_(1) - N_(2) * sigma));
  }
  x[0] = l->x, f[0] = l->f, f_v[0] = l->f_v;
  for (k = 0; k < EVENTS; ++k) e[0][k] = l->event[k];
  G[0] = T[0] * (l->push * f[0] - l->drag);
  for (j = 1; j < NODES; ++j) {
    trum_look(l, l->tau + l->h * z[j], &at[j]);
    x[j] = l->x + l->h * z[j] * (l->push * l->f - l->drag);
    f[j] = l->f, f_v[j] = N_(0), e[j][LARGER] = N_(0), e[j][SMALLER] = N_(0);
  }
  for (tries = 0; tries < 12 && any(open); ++tries) {
    real change = N_(0), slope[NODES];
    slope[0] = N_(0);
    for (j = 1; j < NODES; ++j) {
      real f_now, f_v_now, larger, smaller;
      trum_rub(&at[j], l->v0 + x[j], &f_now, &f_v_now, &larger, &smaller);
      f[j] = sel(open, f_now, f[j]), f_v[j] = sel(open, f_v_now, f_v[j]);
      e[j][LARGER] = sel(open, larger, e[j][LARGER]), e[j][SMALLER] = sel(open, smaller, e[j][SMALLER]);
      G[j] = T[j] * (l->push * f[j] - l->drag);
      slope[j] = T[j] * (l->push * f_v[j]);
    }
    for (i = 1; i < NODES; ++i) {
      right[i] = l->x - x[i];
      for (j = 0; j < NODES; ++j) right[i] = right[i] + N_(A[i][j]) * G[j];
    }
    trum_solve(slope, right, y);
    for (j = 1; j < NODES; ++j) { /* friction bounds how far the speed can get */
      const real drift = l->x - l->h * z[j] * l->drag, reach = l->h * z[j] * l->push;
      const real next = most(drift - reach, least(drift + reach, x[j] + y[j]));
      change = most(change, size_of(next - x[j]));
      f[j] = sel(open, f[j] + f_v[j] * (next - x[j]), f[j]);
      x[j] = sel(open, next, x[j]);
    }
    open = open & no(at_most(change, l->newton_error));
  }
  for (j = 0; j < NODES; ++j) G[j] = T[j] * f[j];
  for (j = 1; j < NODES; ++j) {
    e[j][SPEED] = at[j].R_v * at[j].R_v - (l->v0 + x[j]) * (l->v0 + x[j]);
    e[j][FULL] = at[j].W_c * at[j].W_c - l->W_full * l->W_full;
  }

  { /* what is wrong with the step: an event inside, or an error too large */
    trum_cubic cubic[EVENTS];
    real place, which, ratio, error, factor, h = l->h, bend = l->bend, target = l->target;
    const mask aimed = at_most(N_(0), target);
    const mask startled = less_than(bend, N_(0));
    mask tiny = at_most(l->h, N_(trum_shortest) * l->period);
    mask meets, singular, distant, late, redo, off_target, hit;
    const mask patient = less_than(l->tries, N_(10)); /* no step is tried for ever */
    real tolerance_here;
    trum_first_event(l, z, e, cubic, &place, &which);
    /* a step that was aimed at an event: is it there? */
    {
      real root = N_(1), missed = N_(0);
      if (any(aimed)) {
        trum_cubic q = cubic[0];
        for (k = 0; k < EVENTS; ++k) {
          const trum_cubic own = cubic[k];
          const mask mine = at_most(size_of(target - N_(k)), N_(0.25));
          q.e0 = sel(mine, own.e0, q.e0), q.d1 = sel(mine, own.d1, q.d1), q.d2 = sel(mine, own.d2, q.d2);
          q.d3 = sel(mine, own.d3, q.d3);
          missed = sel(mine, size_of(e[EDGE][k]), missed);
        }
        for (j = 0; j < 3; ++j) {
          const real slope = trum_cubic_slope(&q, root);
          const mask steep = less_than(N_(1e-200), size_of(slope));
          root = sel(steep, root - trum_cubic_at(&q, root) * inverse_of(sel(steep, slope, N_(1))), root);
          root = most(N_(1), least(N_(1.25), root));
        }
        root = sel(at_most(size_of(which - target), N_(0.25)), place, root);
      }
      singular = at_most(size_of(target), N_(0.25)) | at_most(size_of(target - N_(FULL)), N_(0.25));
      missed = size_of(root - N_(1)) * l->h * sel(singular, N_(1), missed);
      tolerance_here = sel(singular, l->event_error, l->kink_error);
      off_target = aimed & less_than(tolerance_here, missed) & patient & no(tiny);
      {
        const mask there = less_than(root, N_(1.24)); /* else it turned out to be none */
        off_target = off_target & there;
        hit = aimed & there & no(off_target);
      }
      /* another event on the way comes first */
      meets = patient & less_than(place, N_(1.5)) & no(hit & at_most(size_of(which - target), N_(0.25)));
      meets = meets & no(off_target & at_most(size_of(which - target), N_(0.25)));
      h = sel(off_target, l->h * root, h);
    }
    singular = at_most(size_of(which), N_(0.25)) | at_most(size_of(which - N_(FULL)), N_(0.25));
    tolerance_here = sel(singular, l->event_error, l->kink_error);
    {
      const real weight = sel(at_most(size_of(which - N_(LARGER)), N_(0.25)), size_of(e[0][LARGER]), size_of(e[0][SMALLER]));
      distant = meets & less_than(tolerance_here, place * l->h * sel(singular, N_(1), weight)) & no(tiny);
    }
    late = meets & no(distant) & no(tiny);
    /* towards the event; a step cannot bend at both ends, so one that begins at a square root goes half the way */
    {
      const mask half = distant & startled & singular;
      h = sel(distant, l->h * place * sel(half, N_(0.5), N_(1)), h);
      target = sel(distant, sel(half, N_(-1), which), target);
      bend = sel(distant & singular & no(startled), N_(1), sel(distant & no(startled), N_(0), bend));
    }
    /* an event right at the start was passed unseen: begin at it */
    for (k = 0; k < EVENTS; ++k) {
      const mask mine = late & at_most(size_of(which - N_(k)), N_(0.25)) & no(l->fresh[k]);
      l->fresh[k] = l->fresh[k] | mine;
      redo = (k == 0) ? mine : redo | mine;
      if (k == SPEED || k == FULL) bend = sel(mine, N_(-1), bend);
      target = sel(mine, N_(-1), target);
    }
    redo = redo | distant | off_target;

    error = trum_quadrature_error(G);
    if (any(held & l->active)) { /* a held lap also measures the contact */
      real angle[NODES];
      angle[0] = T[0] * l->angle0;
      for (j = 1; j < NODES; ++j) angle[j] = T[j] * at[j].theta;
      error = sel(held, most(error, N_(0.31830988618379067154) * trum_quadrature_error(angle)), error);
    }
    ratio = error * l->per_allowed;
    {
      const mask number = less_than(ratio, N_(1e30));
      ratio = sel(number & no(open), least(ratio, N_(1e6)), N_(1e6));
      l->lost = l->lost | (l->active & no(number) & tiny);
    }
    tiny = tiny | at_most(l->h, N_(trum_shortest) * l->period);
    { /* near a standing wave the surface's speed turns fast; the steps must see it turn, unless all of it touches */
      mask blind = is(0);
      real cosine = l->cos_phi, sine = l->sin_phi;
      for (j = 1; j < NODES; ++j) {
        const mask jumps = less_than(cosine * at[j].cos_phi + sine * at[j].sin_phi, N_(trum_cosine));
        blind = blind | (jumps & less_than(N_(0), most(e[j][FULL], e[j - 1][FULL])));
        cosine = at[j].cos_phi, sine = at[j].sin_phi;
      }
      blind = blind & less_than(N_(trum_sees) * l->period, l->h);
      ratio = sel(blind, most(ratio, N_(40)), ratio);
    }
    wrong = no(at_most(ratio, N_(1))) & no(tiny);
    factor = least(N_(trum_grows), most(N_(0.15), N_(trum_margin) * inverse_of(root_of(root_of(most(ratio, N_(1e-5)))))));
    accepted = l->active & no(redo) & no(wrong);
    {
      const mask shrink = wrong & no(redo);
      h = sel(shrink, l->h * factor, h);
      target = sel(shrink, N_(-1), target);
      bend = sel(shrink & no(startled), N_(0), bend);
      l->natural = sel(shrink, h, l->natural);
    }
    l->tries = sel(redo, l->tries + N_(1), sel(accepted, N_(0), l->tries));

    if (any(accepted)) {
      real S[NODES], K[NODES], rate[NODES], sum_f = N_(0), sum_angle = N_(0), sum_x = N_(0), sum_xx = N_(0);
      real sum_S = N_(0), sum_xS = N_(0), angle[NODES];
      const mask end_bent = less_than(N_(0), bend) & accepted, start_bent = startled;
      trum_lap* r = &l->lap;
      for (j = 0; j < NODES; ++j) {
        K[j] = T[j] * (l->push * f_v[j]);
        rate[j] = T[j] * (l->push * f[j] - l->drag);
      }
      /* at the square root itself T f_v is 0 times infinity: its limit, from the other nodes */
      {
        const real first = N_(outward[1]) * K[1] + N_(outward[2]) * K[2] + N_(outward[3]) * K[3];
        const real last = N_(outward[1]) * K[2] + N_(outward[2]) * K[1] + N_(outward[3]) * K[0];
        K[0] = sel(start_bent, least(first, N_(0)), K[0]), K[EDGE] = sel(end_bent, least(last, N_(0)), K[EDGE]);
      }
      S[0] = l->S;
      for (i = 1; i < NODES; ++i) right[i] = l->S * (N_(1) + N_(A[i][0]) * K[0]);
      trum_solve(K, right, S);
      for (j = 1; j < NODES; ++j) S[j] = most(N_(0), least(l->S, S[j])); /* friction never drives speeds apart */
      angle[0] = l->angle0;
      for (j = 1; j < NODES; ++j) angle[j] = at[j].theta;
      for (j = 0; j < NODES; ++j) {
        const real b = N_(A[EDGE][j]) * T[j];
        sum_f = sum_f + b * f[j], sum_angle = sum_angle + b * angle[j];
        sum_x = sum_x + b * x[j], sum_xx = sum_xx + b * (x[j] * x[j]);
        sum_S = sum_S + b * S[j], sum_xS = sum_xS + b * (x[j] * S[j]);
      }
      trum_extremes(rate, x, S[0], S[EDGE], accepted & no(held), r);
      for (j = 1; j < NODES; ++j) {
        r->fastest = sel(accepted, most(r->fastest, at[j].R_v), r->fastest);
        r->full = sel(accepted & at_most(at[j].W_c, l->W_full), N_(1), r->full);
      }
      r->friction = sel(accepted, r->friction + sum_f, r->friction);
      r->angle = sel(accepted, r->angle + sum_angle, r->angle);
      r->x = sel(accepted, r->x + sum_x, r->x), r->xx = sel(accepted, r->xx + sum_xx, r->xx);
      r->S = sel(accepted, r->S + sum_S, r->S), r->xS = sel(accepted, r->xS + sum_xS, r->xS);
      r->error = sel(accepted, r->error + error, r->error);
      if (l->record && in_lane(accepted, 0)) trum_write(l->record, l, rate);
      l->x = sel(accepted, x[EDGE], l->x), l->S = sel(accepted, S[EDGE], l->S);
      l->f = sel(accepted, f[EDGE], l->f), l->f_v = sel(accepted, f_v[EDGE], l->f_v);
      l->angle0 = sel(accepted, angle[EDGE], l->angle0);
      l->cos_phi = sel(accepted, at[EDGE].cos_phi, l->cos_phi);
      l->sin_phi = sel(accepted, at[EDGE].sin_phi, l->sin_phi);
      for (k = 0; k < EVENTS; ++k) {
        const mask mine = hit & at_most(size_of(l->target - N_(k)), N_(0.25));
        l->event[k] = sel(accepted, e[EDGE][k], l->event[k]);
        l->fresh[k] = sel_mask(accepted, mine, l->fresh[k]);
      }
      {
        const mask finished = accepted & at_most(l->left, l->h * N_(1.0000001));
        const real grown = least(N_(trum_longest) * l->period, l->h * factor);
        l->natural = sel(accepted, sel(aimed | finished, most(l->natural, grown), grown), l->natural);
        l->natural = sel(accepted, least(l->natural, N_(trum_longest) * l->period), l->natural);
        l->tau = sel(accepted, l->tau + l->h, l->tau);
        l->left = sel(accepted, sel(finished, N_(0), l->left - l->h), l->left);
        h = sel(accepted, l->natural, h);
      }
      singular = hit & (l->fresh[SPEED] | l->fresh[FULL]);
      bend = sel(accepted, sel(singular, N_(-1), N_(0)), bend);
      target = sel(accepted, N_(-1), target);
    }
    l->h = least(h, l->left), l->bend = bend;
    l->target = target;
  }
  l->patience = l->patience - N_(1);
  return accepted;
}

/* A point's search for its orbit. */
typedef struct {
  const trum_orbit_in* in;
  trum_orbit_out* out;
  double start[TRUM_REGIONS][4], pulses[TRUM_REGIONS]; /* phasors at the start of the regions; their drive periods */
  double low, high, v0, scale, level;                  /* bracket of the start speed, guess, speed that errors are measured by, error of a step */
  int stage, region, laps, finer;
} trum_job;

enum { HELD, ROUGH, FINE };
static const int trum_most_laps = 60;
static const double trum_most_tries = 3000.0; /* steps in a drive period, accepted or not */

/* Puts the next region of the lap that has any length into the lane; 0 if the lap is over. */
static int trum_next_region(trum_lanes* l, int i, trum_job* job) {
  static const double gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
  int k;
  do {
    if (++job->region == TRUM_REGIONS) return 0;
  } while (job->pulses[job->region] < 0.5);
  for (k = 0; k < 4; ++k) put(&l->free_[k], i, job->start[job->region][k]);
  put(&l->g_A, i, gates_A[job->region]), put(&l->g_B, i, gates_B[job->region]);
  put(&l->tau, i, 0.0), put(&l->left, i, job->pulses[job->region] * get(&l->period, i));
  put(&l->h, i, get(&l->natural, i));
  put(&l->bend, i, 0.0), put(&l->target, i, -1.0), put(&l->tries, i, 0.0);
  return 1;
}

static void trum_start_lap(trum_lanes* l, int i, trum_job* job) {
  const double period = get(&l->period, i), whole = get(&l->whole, i), push = job->in->push;
  const int held = job->stage == HELD;
  double reach = held ? whole : job->scale / push, allowed;
  if (reach > whole) reach = whole;
  allowed = job->level * reach / job->in->m;
  put(&l->push, i, held ? 0.0 : push), put(&l->drag, i, held ? 0.0 : job->in->drag);
  put(&l->v0, i, job->v0), put(&l->per_allowed, i, 1.0 / allowed);
  put(&l->event_error, i, trum_event * cbrt(allowed * allowed * period));
  put(&l->kink_error, i, trum_kink * allowed);
  put(&l->newton_error, i, held ? 0.0 : allowed * push * sqrt(trum_newton * job->in->m / job->level));
  put(&l->patience, i, trum_most_tries * job->in->m);
  put(&l->natural, i, trum_first * period);
  put(&l->x, i, 0.0), put(&l->S, i, 1.0), put(&l->f, i, 0.0), put(&l->f_v, i, 0.0), put(&l->angle0, i, 0.0);
  put(&l->lap.gain, i, 0.0), put(&l->lap.growth, i, 1.0);
  put(&l->lap.x, i, 0.0), put(&l->lap.xx, i, 0.0), put(&l->lap.S, i, 0.0), put(&l->lap.xS, i, 0.0);
  put(&l->lap.low, i, 0.0), put(&l->lap.high, i, 0.0), put(&l->lap.S_low, i, 1.0), put(&l->lap.S_high, i, 1.0);
  put(&l->lap.friction, i, 0.0), put(&l->lap.angle, i, 0.0);
  put(&l->lap.full, i, 0.0), put(&l->lap.fastest, i, 0.0), put(&l->lap.error, i, 0.0);
  put_mask(&l->cold, i, 1), put_mask(&l->lost, i, 0), put_mask(&l->active, i, 1);
  job->region = -1;
  trum_next_region(l, i, job);
}

static void trum_load(trum_lanes* l, int i, trum_job* job, const trum_orbit_in* in, trum_orbit_out* out) {
  const double period = 6.283185307179586477 / (in->omega_n + in->Delta_omega);
  double arg_[trum_regions_n_arg], res_[trum_regions_n_res];
  const double* arg[trum_regions_n_arg];
  double* res[trum_regions_n_res];
  int k, r, phase;
  put(&l->omega_n, i, in->omega_n), put(&l->Delta_omega, i, in->Delta_omega), put(&l->xi, i, in->xi);
  put(&l->s, i, in->s), put(&l->W, i, in->W), put(&l->D, i, in->D), put(&l->k_c, i, in->k_c);
  put(&l->engagement_per_height, i, in->engagement_per_height), put(&l->W_full, i, in->W_full);
  put(&l->drive_re, i, cos(in->psi)), put(&l->drive_im, i, sin(in->psi));
  put(&l->period, i, period), put(&l->whole, i, period * in->m);
  arg_[trum_regions_in_Delta_omega] = in->Delta_omega, arg_[trum_regions_in_W] = in->W;
  arg_[trum_regions_in_a_A] = in->a_A, arg_[trum_regions_in_b_A] = in->b_A;
  arg_[trum_regions_in_a_B] = in->a_B, arg_[trum_regions_in_b_B] = in->b_B;
  arg_[trum_regions_in_m] = in->m, arg_[trum_regions_in_n] = in->n, arg_[trum_regions_in_omega_n] = in->omega_n;
  arg_[trum_regions_in_psi] = in->psi, arg_[trum_regions_in_s] = in->s, arg_[trum_regions_in_xi] = in->xi;
  for (k = 0; k < trum_regions_n_arg; ++k) arg[k] = &arg_[k];
  for (k = 0; k < trum_regions_n_res; ++k) res[k] = &res_[k];
  trum_regions(arg, res, 0, 0, 0);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    job->pulses[r] = floor(res_[trum_regions_out_time_redu + r] / period + 0.5);
    for (phase = 0; phase < 2; ++phase) {
      double to_[trum_phasor_n_arg];
      const double* to[trum_phasor_n_arg];
      double* z[trum_phasor_n_res];
      to_[trum_phasor_in_a] = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase];
      to_[trum_phasor_in_b] = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase + 1];
      to_[trum_phasor_in_omega_n] = in->omega_n, to_[trum_phasor_in_xi] = in->xi;
      for (k = 0; k < trum_phasor_n_arg; ++k) to[k] = &to_[k];
      z[trum_phasor_out_re] = &job->start[r][2 * phase], z[trum_phasor_out_im] = &job->start[r][2 * phase + 1];
      trum_phasor(to, z, 0, 0, 0);
    }
  }
  job->in = in, job->out = out;
  job->stage = HELD, job->laps = job->finer = 0, job->v0 = 0.0, job->low = -HUGE_VAL, job->high = HUGE_VAL;
  job->scale = 0.0, job->level = trum_level * in->tolerance;
  out->mean = out->low = out->high = out->variance = out->start = out->level = out->error = NAN;
  out->contact = out->held = NAN, out->flags = 0;
  trum_start_lap(l, i, job);
}

/* The rough level that makes one fine lap enough. */
static double trum_rough(double tolerance) {
  const double rough = 0.03 * sqrt(tolerance);
  return trum_level * (rough > tolerance ? rough : tolerance);
}

/* A lap is over: the next one, or 0 when the point is done.  Gain falls as the start rises: Newton in a bracket. */
static int trum_judge(trum_lanes* l, int i, trum_job* job) {
  const trum_orbit_in* in = job->in;
  trum_orbit_out* out = job->out;
  const trum_lap* r = &l->lap;
  const double whole = get(&l->whole, i);
  const int lost = in_lane(l->lost, i);
  if (job->stage == HELD) {
    out->contact = lost ? NAN : get(&r->angle, i) / whole / 3.14159265358979323846;
    out->held = lost ? NAN : get(&r->friction, i) / whole;
    if (get(&r->full, i) > 0.0) out->flags = trum_full_contact;
    if (!(in->push > fabs(in->drag))) {
      out->flags += trum_runaway;
      return 0;
    }
    job->stage = ROUGH, job->level = trum_rough(in->tolerance);
    job->scale = 0.1 * in->D * in->k_c * in->W * (in->omega_n + in->Delta_omega);
    trum_start_lap(l, i, job);
    return 1;
  }
  if (lost) return 0;
  {
    const double gain = get(&l->x, i), growth = get(&l->S, i), pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
    const double low = get(&r->low, i), high = get(&r->high, i), bound = 1.5 * get(&r->fastest, i);
    const double top = fabs(job->v0 + low) > fabs(job->v0 + high) ? fabs(job->v0 + low) : fabs(job->v0 + high);
    const double fine = trum_level * in->tolerance;
    const int accurate = job->level <= fine * 1.0001, last = ++job->laps >= trum_most_laps;
    double next = job->v0 + gain / pull, away, noise;
    int close;
    if (gain > 0.0) job->low = job->v0;
    else job->high = job->v0;
    next = next > bound ? bound : next < -bound ? -bound : next;
    if (!(next > job->low && next < job->high) && job->low > -HUGE_VAL && job->high < HUGE_VAL)
      next = 0.5 * (job->low + job->high);
    away = next - job->v0;
    noise = get(&r->error, i) * in->push / pull;
    /* a Newton step this small leaves an error of its square, which the figures' derivatives take along */
    close = away * away <= 0.1 * in->tolerance * top * top || fabs(away) <= noise || job->high - job->low <= 1e-15 * bound;
    /* the less a lap pulls speeds together, the more an error of a step weighs */
    job->scale = top * (pull > 1e-3 ? pull : 1e-3 * (in->push * whole < top ? pull + in->push * whole / top : 1.0));
    if (close && accurate && noise > in->tolerance * top && !last && ++job->finer <= 3) {
      const double excess = in->tolerance * top / noise;
      job->level *= 0.3 * (excess > 0.01 ? excess : 0.01);
    } else if (close && (accurate || last)) {
      const double mean = get(&r->x, i) / whole, mean_S = get(&r->S, i) / whole;
      const double square = get(&r->xx, i) / whole, mean_xS = get(&r->xS, i) / whole;
      const double variance = square - mean * mean + 2.0 * away * (mean_xS - mean * mean_S);
      out->mean = job->v0 + mean + away * mean_S;
      out->low = job->v0 + low + away * get(&r->S_low, i), out->high = job->v0 + high + away * get(&r->S_high, i);
      /* Newton's last change leaves the order of nearly equal speeds open */
      out->low = out->low < out->mean ? out->low : out->mean, out->high = out->high > out->mean ? out->high : out->mean;
      out->variance = variance > 0.0 ? variance : 0.0;
      out->start = next, out->level = job->level, out->error = noise / top;
      if (noise <= in->tolerance * top && !isnan(out->held)) out->flags += trum_converged;
      return 0;
    }
    if (last) { /* the best there is, and not flagged as converged */
      out->mean = job->v0 + get(&r->x, i) / whole, out->low = job->v0 + low, out->high = job->v0 + high;
      out->variance = get(&r->xx, i) / whole - (get(&r->x, i) / whole) * (get(&r->x, i) / whole);
      out->start = job->v0, out->level = job->level, out->error = fabs(away) / top;
      return 0;
    }
    if (close && !accurate) job->level = fine;
    if (close) job->stage = FINE, job->low = -HUGE_VAL, job->high = HUGE_VAL;
    job->v0 = next;
  }
  trum_start_lap(l, i, job);
  return 1;
}

static void trum_clear(trum_lanes* l, int hertz) {
  int k;
  l->active = l->cold = l->lost = is(0), l->hertz = hertz, l->record = 0;
  for (k = 0; k < EVENTS; ++k) l->fresh[k] = is(0), l->event[k] = TRUM_NUMBER(0);
  l->tau = l->left = l->h = l->natural = l->bend = l->target = l->tries = l->patience = TRUM_NUMBER(0);
}

/* One step of all lanes, and what follows for those whose lap is over; 0 in done[i] when lane i has no more work. */
static void trum_advance(trum_lanes* l, trum_job* jobs, int* busy) {
  mask ended;
  int i;
  if (any(l->cold)) trum_begin(l);
  l->lost = l->lost | (l->active & less_than(l->patience, TRUM_NUMBER(0)));
  ended = l->active & ((trum_step(l) & at_most(l->left, TRUM_NUMBER(0))) | l->lost);
  if (!any(ended)) return;
  for (i = 0; i < TRUM_LANES; ++i) {
    if (!in_lane(ended, i)) continue;
    if (!in_lane(l->lost, i) && trum_next_region(l, i, &jobs[i])) continue;
    busy[i] = trum_judge(l, i, &jobs[i]);
    if (!busy[i]) put_mask(&l->active, i, 0);
  }
}

/* Orbits of count points of one contact law; lanes take the next point when they are done with one. */
static void trum_orbits(const trum_orbit_in* in, trum_orbit_out* out, long count) {
  trum_lanes l;
  trum_job jobs[TRUM_LANES];
  int busy[TRUM_LANES], i, left;
  long next = 0;
  if (count <= 0) return;
  trum_clear(&l, in[0].hertz > 0.5);
  for (i = 0; i < TRUM_LANES; ++i) { /* lanes without a point carry the last one's numbers, and rest */
    const long point = i < count ? i : count - 1;
    trum_orbit_out unused;
    trum_load(&l, i, &jobs[i], &in[point], i < count ? &out[i] : &unused);
    busy[i] = i < count;
    if (!busy[i]) put_mask(&l.active, i, 0);
  }
  next = TRUM_LANES < count ? TRUM_LANES : count;
  do {
    trum_advance(&l, jobs, busy);
    for (i = left = 0; i < TRUM_LANES; ++i) {
      if (!busy[i] && next < count) {
        trum_load(&l, i, &jobs[i], &in[next], &out[next]);
        busy[i] = 1, ++next;
      }
      left += busy[i];
    }
  } while (left);
}

/* One cycle of a point's orbit: rim speed, and distance since t1, at count equal times after t1. */
static void trum_history(const trum_orbit_in* in, const trum_orbit_out* orbit, double* speed, double* distance,
                         long count) {
  trum_lanes l;
  trum_job jobs[TRUM_LANES];
  trum_orbit_out unused;
  trum_record record;
  int i;
  trum_clear(&l, in->hertz > 0.5);
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_load(&l, i, &jobs[i], in, &unused);
    if (i > 0) put_mask(&l.active, i, 0);
  }
  jobs[0].stage = FINE, jobs[0].level = orbit->level, jobs[0].v0 = orbit->start;
  jobs[0].scale = fabs(orbit->low) > fabs(orbit->high) ? fabs(orbit->low) : fabs(orbit->high);
  trum_start_lap(&l, 0, &jobs[0]);
  record.speed = speed, record.distance = distance, record.count = count, record.written = 0;
  record.spacing = get(&l.whole, 0) / (double)count, record.since = record.travelled = 0.0;
  l.record = &record;
  for (;;) {
    mask accepted;
    if (any(l.cold)) trum_begin(&l);
    accepted = trum_step(&l);
    if (in_lane(l.lost, 0) || get(&l.patience, 0) < 0.0) break;
    if (in_lane(accepted, 0) && get(&l.left, 0) <= 0.0 && !trum_next_region(&l, 0, &jobs[0])) break;
  }
  for (; record.written < count; ++record.written) speed[record.written] = distance[record.written] = NAN;
}

#undef N_
#endif
