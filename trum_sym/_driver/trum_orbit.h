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
  double held;      /* whether (1 or 0) a held rotor's figures are wanted */
} trum_orbit_in;

/* Speeds of the rim, m/s; means of theta/pi and of the friction fraction on a held rotor, NAN unless wanted: it also
 * tells of full contact. */
typedef struct {
  double mean, low, high, variance, contact, held, start, level, error, flags;
} trum_orbit_out;

/* What the figures' slopes are by: logarithm of the prepressure, frequency difference, drag, logarithms of the friction
 * coefficient and of the amplitude, resonance; each with the others held. */
enum { BY_PREPRESSURE, BY_DIFFERENCE, BY_DRAG, BY_FRICTION, BY_AMPLITUDE, BY_RESONANCE, WAYS };

/* Slopes of the free motion before t1 by resonance and frequency difference, in the order of a_A, b_A, a_B, b_B. */
typedef struct {
  double by_resonance[4], by_difference[4];
} trum_slopes_in;

/* Slopes of the figures in this order. */
enum { OF_MEAN, OF_LOW, OF_HIGH, OF_VARIANCE, OF_CONTACT, OF_HELD, FIGURES };
typedef struct {
  double of[FIGURES][WAYS];
} trum_slopes_out;

/* One lap's figures: sums are over time from its start, x is the rim's speed over that at the start. */
typedef struct {
  real x, xx, S, xS;              /* integrals of x, x^2, S = dv/dv0 and x S */
  real low, high, S_low, S_high;  /* extremes of x, and S there */
  real friction, angle;           /* integrals of f and theta/pi */
  real full, fastest, error;      /* any full contact; largest surface speed; sum of the steps' errors of integral f */
  real size_f[WAYS], size_angle[WAYS]; /* sums of the sizes of the steps' shares of d_friction and d_angle */
  real d_x[WAYS], d_xx[WAYS], d_low[WAYS], d_high[WAYS], d_friction[WAYS], d_angle[WAYS]; /* the same, as slopes */
} trum_lap;

/* Events, in the order of the functions that change sign there. */
enum { SPEED, LARGER, SMALLER, FULL, EVENTS };

/* The surface and the contact at an instant. */
typedef struct {
  real R_v, phi, cos_phi, sin_phi, engagement, theta, sin_theta, share, W_c;
} trum_surface;

/* How an instant's friction fraction and the logarithms of engagement and surface speed change by what the slopes are
 * by.  The surface speed's share in f is left out of f, and theta's change is apart: both are infinite where there are
 * square roots.  Rates are in time. */
typedef struct {
  real f[WAYS], ln_E[WAYS], ln_R_v[WAYS], theta_E, R_v_rate, W_c_rate;
} trum_changes;

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
  real v0, per_allowed, event_error, kink_error; /* of the lap: start speed; 1/error of a step's integral f, 1/s; events */
  real per_growth, per_f[WAYS], per_angle[WAYS]; /* 1/error of what slopes integrate: growth, and what drives them */
  real begins, ends;                             /* how near to events steps with slopes begin and end */
  real newton_error;                           /* last change of a step's speeds, whose square is the error left */
  real tau, left, h, natural, bend;            /* place in the region; the step, its size without events, its map */
  real target, tries, patience;                /* the event that the step is to end at, or -1 */
  real x, S, f, f_v, theta, cos_phi, sin_phi, event[EVENTS];    /* where the step begins */
  real d[WAYS];                                /* slopes there, of x */
  trum_changes changes;                        /* and of what x follows */
  real slopes_[2][4];                          /* of the phasors at the region's start, by resonance and difference */
  mask fresh[EVENTS];                          /* it begins at this event */
  mask active, cold, lost;
  mask contact; /* the lap measures the contact and no friction, whose kinks it passes over */
  int hertz, slopes; /* contact law; whether slopes are wanted */
  trum_lap lap;
  trum_record* record;
} trum_lanes;

/* Steps, in drive periods: the longest, a lap's first, the shortest that is ever rejected, and the shortest that has to
 * see the wave turn by less than this cosine from node to node. */
static const double trum_longest = 1.0 / 24.0, trum_first = 1.0 / 24.0, trum_shortest = 1e-9;
static const double trum_sees = 2e-4, trum_cosine = 0.4;
/* Where slopes are wanted, which have no bounds at a square root: the shortest step, in drive periods, whose slopes'
 * error counts (below, rounding is most of it), how near to an event a step may begin and end, and how much closer
 * Newton comes. */
static const double trum_feels = 1e-6, trum_begins = 1e-10, trum_ends = 1e-15, trum_closes = 1e-5;
/* A step's length follows the fourth root of its error, with a margin, and grows by no more than this. */
static const double trum_margin = 0.8, trum_grows = 1.5;
/* Shares that make the figures meet the tolerance: error of a step per drive period, of the quadrature's estimate, of
 * an event's place beside a square root and at a kink, of Newton's last change squared.  Measured over the domain. */
static const double trum_level = 0.05, trum_estimate = 0.2, trum_event = 4.0, trum_kink = 100.0, trum_newton = 0.05;
/* The tolerance of the first lap: far off the orbit, errors weigh little. */
static const double trum_coarse = 1e-2;

static void trum_turn(const trum_lanes* l, real tau, real* turn) {
  const real* arg[trum_rotation_n_arg];
  real* res[trum_rotation_n_res];
  int k;
  arg[trum_rotation_in_Delta_omega] = &l->Delta_omega, arg[trum_rotation_in_omega_n] = &l->omega_n;
  arg[trum_rotation_in_tau] = &tau, arg[trum_rotation_in_xi] = &l->xi;
  for (k = 0; k < 4; ++k) res[k] = &turn[k];
  TRUM_KERNEL(trum_rotation)(arg, res, 0, 0, 0);
}

/* The surface once the phasors have turned. */
static void trum_see(const trum_lanes* l, const real* turn, trum_surface* at) {
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

static void trum_look(const trum_lanes* l, real tau, trum_surface* at) {
  real turn[4];
  trum_turn(l, tau, turn);
  trum_see(l, turn, at);
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

/* At a standstill of the surface nothing is defined, nor does it weigh. */
static real trum_defined(real a) { return sel(less_than(size_of(a), N_(1e100)), a, N_(0)); }

/* How friction, contact and surface change at a speed of the rim. */
static void trum_change(const trum_lanes* l, real tau, const trum_surface* at, real v, trum_changes* by) {
  real f_phi, f_E, theta_E, of_height, wave[trum_wave_slopes_n_res];
  int k, way;
  {
    const real* arg[trum_friction_slopes_n_arg];
    real* res[trum_friction_slopes_n_res];
    arg[trum_friction_slopes_in_R_v] = &at->R_v, arg[trum_friction_slopes_in_phi] = &at->phi;
    arg[trum_friction_slopes_in_cos_phi] = &at->cos_phi, arg[trum_friction_slopes_in_sin_phi] = &at->sin_phi;
    arg[trum_friction_slopes_in_engagement] = &at->engagement, arg[trum_friction_slopes_in_share] = &at->share;
    arg[trum_friction_slopes_in_theta] = &at->theta, arg[trum_friction_slopes_in_sin_theta] = &at->sin_theta;
    arg[trum_friction_slopes_in_v] = &v;
    res[trum_friction_slopes_out_f_phi] = &f_phi, res[trum_friction_slopes_out_f_E] = &f_E;
    res[trum_friction_slopes_out_theta_E] = &theta_E, res[trum_friction_slopes_out_E_height] = &of_height;
    TRUM_KERNEL(trum_friction_slopes)(arg, res, 0, 0, 0);
  }
  {
    const real* arg[trum_wave_slopes_n_arg];
    real* res[trum_wave_slopes_n_res];
    arg[trum_wave_slopes_in_omega_n] = &l->omega_n, arg[trum_wave_slopes_in_Delta_omega] = &l->Delta_omega;
    arg[trum_wave_slopes_in_xi] = &l->xi, arg[trum_wave_slopes_in_s] = &l->s, arg[trum_wave_slopes_in_W] = &l->W;
    arg[trum_wave_slopes_in_D] = &l->D, arg[trum_wave_slopes_in_k_c] = &l->k_c, arg[trum_wave_slopes_in_tau] = &tau;
    arg[trum_wave_slopes_in_f_A_re] = &l->free_[0], arg[trum_wave_slopes_in_f_A_im] = &l->free_[1];
    arg[trum_wave_slopes_in_f_B_re] = &l->free_[2], arg[trum_wave_slopes_in_f_B_im] = &l->free_[3];
    arg[trum_wave_slopes_in_f_A_re_omega_n] = &l->slopes_[0][0];
    arg[trum_wave_slopes_in_f_A_im_omega_n] = &l->slopes_[0][1];
    arg[trum_wave_slopes_in_f_B_re_omega_n] = &l->slopes_[0][2];
    arg[trum_wave_slopes_in_f_B_im_omega_n] = &l->slopes_[0][3];
    arg[trum_wave_slopes_in_f_A_re_Delta_omega] = &l->slopes_[1][0];
    arg[trum_wave_slopes_in_f_A_im_Delta_omega] = &l->slopes_[1][1];
    arg[trum_wave_slopes_in_f_B_re_Delta_omega] = &l->slopes_[1][2];
    arg[trum_wave_slopes_in_f_B_im_Delta_omega] = &l->slopes_[1][3];
    arg[trum_wave_slopes_in_p_re] = &l->drive_re, arg[trum_wave_slopes_in_p_im] = &l->drive_im;
    arg[trum_wave_slopes_in_g_A] = &l->g_A, arg[trum_wave_slopes_in_g_B] = &l->g_B;
    for (k = 0; k < trum_wave_slopes_n_res; ++k) res[k] = &wave[k];
    TRUM_KERNEL(trum_wave_slopes)(arg, res, 0, 0, 0);
  }
  if (!l->hertz) of_height = N_(1); /* the Winkler layer's engagement is in proportion to the height */
  for (way = 0; way < WAYS; ++way) {
    real height = N_(0), speed = N_(0), phase = N_(0); /* slopes of ln (W_c / W_full), ln R_v and phi */
    if (way == BY_PREPRESSURE) height = N_(-1);
    if (way == BY_AMPLITUDE) height = speed = N_(1);
    if (way == BY_RESONANCE || way == BY_DIFFERENCE) {
      const int first = way == BY_RESONANCE ? trum_wave_slopes_out_W_c_omega_n : trum_wave_slopes_out_W_c_Delta_omega;
      height = wave[first] / at->W_c, speed = wave[first + 1] / at->R_v, phase = wave[first + 2];
    }
    height = height * of_height;
    by->f[way] = trum_defined(f_E * height + f_phi * phase);
    by->ln_E[way] = trum_defined(height);
    by->ln_R_v[way] = trum_defined(speed);
  }
  by->theta_E = trum_defined(theta_E);
  by->R_v_rate = wave[trum_wave_slopes_out_R_v_tau], by->W_c_rate = wave[trum_wave_slopes_out_W_c_tau];
}

/* The equations y_i = right_i + sum_j A_ij K_j y_j of the nodes after the first, eliminated. */
typedef struct {
  real first, second, third, t_1, t_2, t_21, M_01, M_02, M_12;
} trum_eliminated;

static trum_eliminated trum_eliminate(const real* K) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  trum_eliminated e;
  real M[3][3];
  int i, j;
  for (i = 0; i < 3; ++i)
    for (j = 0; j < 3; ++j) M[i][j] = N_(i == j ? 1.0 : 0.0) - N_(A[i + 1][j + 1]) * K[j + 1];
  e.first = inverse_of(M[0][0]);
  e.t_1 = M[1][0] * e.first, e.t_2 = M[2][0] * e.first;
  M[1][1] = M[1][1] - e.t_1 * M[0][1], M[1][2] = M[1][2] - e.t_1 * M[0][2];
  M[2][1] = M[2][1] - e.t_2 * M[0][1], M[2][2] = M[2][2] - e.t_2 * M[0][2];
  e.second = inverse_of(M[1][1]);
  e.t_21 = M[2][1] * e.second;
  e.third = inverse_of(M[2][2] - e.t_21 * M[1][2]);
  e.M_01 = M[0][1], e.M_02 = M[0][2], e.M_12 = M[1][2];
  return e;
}

static void trum_solve(const trum_eliminated* e, const real* right, real* y) {
  const real b_1 = right[2] - e->t_1 * right[1], b_2 = right[3] - e->t_2 * right[1];
  y[3] = (b_2 - e->t_21 * b_1) * e->third;
  y[2] = (b_1 - e->M_12 * y[3]) * e->second;
  y[1] = (right[1] - e->M_01 * y[2] - e->M_02 * y[3]) * e->first;
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
    if (k != FULL) found = found & no(l->contact);
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
static void trum_extremes(const real* G, const real* x, const real* S, real (*d)[NODES], int slopes, mask accepted,
                          trum_lap* lap) {
  static const double P[NODES][NODES] = TRUM_COLLOCATION_POWERS;
  real p[NODES], top = most(x[0], x[1]), bottom = least(x[0], x[1]), steepest = size_of(G[0]);
  mask turns = is(0), needed;
  int k, j, way;
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
      real at = N_((2.0 * k + 1.0) / 6.0), value, S_there, weight[NODES];
      mask lower, higher;
      for (j = 0; j < 4; ++j) {
        const real slope = p[1] + at * (N_(2) * p[2] + at * N_(3) * p[3]);
        const real rate = p[0] + at * (p[1] + at * (p[2] + at * p[3]));
        const mask steep = less_than(N_(1e-200), size_of(slope));
        at = most(N_(0), least(N_(1), sel(steep, at - rate * inverse_of(sel(steep, slope, N_(1))), at)));
      }
      value = x[0] + at * (p[0] + at * (N_(1.0 / 2) * p[1] + at * (N_(1.0 / 3) * p[2] + at * N_(1.0 / 4) * p[3])));
      for (j = 0; j < NODES; ++j) weight[j] = N_(P[0][j]) + at * (N_(P[1][j]) + at * (N_(P[2][j]) + at * N_(P[3][j])));
      for (S_there = weight[0] * S[0], j = 1; j < NODES; ++j) S_there = S_there + weight[j] * S[j];
      lower = needed & less_than(value, lap->low), higher = needed & less_than(lap->high, value);
      lap->low = sel(lower, value, lap->low), lap->S_low = sel(lower, S_there, lap->S_low);
      lap->high = sel(higher, value, lap->high), lap->S_high = sel(higher, S_there, lap->S_high);
      for (way = 0; slopes && way < WAYS; ++way) {
        real there = weight[0] * d[way][0];
        for (j = 1; j < NODES; ++j) there = there + weight[j] * d[way][j];
        lap->d_low[way] = sel(lower, there, lap->d_low[way]);
        lap->d_high[way] = sel(higher, there, lap->d_high[way]);
      }
    }
  }
  {
    const mask lower = accepted & less_than(x[EDGE], lap->low), higher = accepted & less_than(lap->high, x[EDGE]);
    lap->low = sel(lower, x[EDGE], lap->low), lap->S_low = sel(lower, S[EDGE], lap->S_low);
    lap->high = sel(higher, x[EDGE], lap->high), lap->S_high = sel(higher, S[EDGE], lap->S_high);
    for (k = 0; slopes && k < WAYS; ++k) {
      lap->d_low[k] = sel(lower, d[k][EDGE], lap->d_low[k]), lap->d_high[k] = sel(higher, d[k][EDGE], lap->d_high[k]);
    }
  }
}

static void trum_keep(trum_changes* kept, const trum_changes* by, mask here) {
  int way;
  for (way = 0; way < WAYS; ++way) {
    kept->f[way] = sel(here, by->f[way], kept->f[way]);
    kept->ln_E[way] = sel(here, by->ln_E[way], kept->ln_E[way]);
    kept->ln_R_v[way] = sel(here, by->ln_R_v[way], kept->ln_R_v[way]);
  }
  kept->theta_E = sel(here, by->theta_E, kept->theta_E);
  kept->R_v_rate = sel(here, by->R_v_rate, kept->R_v_rate), kept->W_c_rate = sel(here, by->W_c_rate, kept->W_c_rate);
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
  l->theta = sel(l->cold, at.theta, l->theta);
  l->cos_phi = sel(l->cold, at.cos_phi, l->cos_phi), l->sin_phi = sel(l->cold, at.sin_phi, l->sin_phi);
  if (l->slopes) {
    trum_changes by;
    trum_change(l, l->tau, &at, l->v0 + l->x, &by);
    trum_keep(&l->changes, &by, l->cold);
  }
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
  whole = l[0] + l[1] + N_(1e-37);
  second = l[2] / whole, third = cube_root_of(l[3] / whole + N_(1e-37));
  return N_(trum_estimate) * most(l[2] * second * root_of(second), l[3] * third * third);
}

/* A step that is tried: the nodes' places and rates of time, and what is there. */
typedef struct {
  trum_surface at[NODES]; /* not at the first node */
  real z[NODES], T[NODES], x[NODES], f[NODES], f_v[NODES], e[NODES][EVENTS];
  trum_changes by[NODES]; /* if slopes are wanted */
  mask open;              /* Newton has not closed */
} trum_attempt;

static mask trum_same(real a, real b) { return at_most(size_of(a - b), N_(0.25)); }

/* Collocation: x_i = x_0 + sum_j A_ij T_j (push f(x_j) - drag), by Newton on the three nodes after the first. */
static void trum_try(const trum_lanes* l, trum_attempt* t) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS, c[NODES] = TRUM_COLLOCATION_POINTS;
  trum_eliminated equations;
  real G[NODES], right[NODES], y[NODES];
  int i, j, k, tries;
  for (j = 0; j < NODES; ++j) {
    const real sigma = N_(c[j]);
    t->z[j] = sigma * (N_(1) + l->bend * (N_(1) - sigma));
    t->T[j] = l->h * (N_(1) + l->bend * (N_(1) - N_(2) * sigma));
  }
  t->open = l->active;
  t->x[0] = l->x, t->f[0] = l->f, t->f_v[0] = l->f_v;
  for (k = 0; k < EVENTS; ++k) t->e[0][k] = l->event[k];
  G[0] = t->T[0] * (l->push * t->f[0] - l->drag);
  for (j = 1; j < NODES; ++j) {
    trum_look(l, l->tau + l->h * t->z[j], &t->at[j]);
    t->x[j] = l->x + l->h * t->z[j] * (l->push * l->f - l->drag);
    t->f[j] = l->f, t->f_v[j] = N_(0), t->e[j][LARGER] = N_(0), t->e[j][SMALLER] = N_(0);
  }
  for (tries = 0; tries < 12 && any(t->open); ++tries) {
    real change = N_(0), slope[NODES];
    slope[0] = N_(0);
    for (j = 1; j < NODES; ++j) {
      real f, f_v, larger, smaller;
      trum_rub(&t->at[j], l->v0 + t->x[j], &f, &f_v, &larger, &smaller);
      t->f[j] = sel(t->open, f, t->f[j]), t->f_v[j] = sel(t->open, f_v, t->f_v[j]);
      t->e[j][LARGER] = sel(t->open, larger, t->e[j][LARGER]);
      t->e[j][SMALLER] = sel(t->open, smaller, t->e[j][SMALLER]);
      G[j] = t->T[j] * (l->push * t->f[j] - l->drag);
      slope[j] = t->T[j] * (l->push * t->f_v[j]);
    }
    for (i = 1; i < NODES; ++i) {
      right[i] = l->x - t->x[i];
      for (j = 0; j < NODES; ++j) right[i] = right[i] + N_(A[i][j]) * G[j];
    }
    equations = trum_eliminate(slope);
    trum_solve(&equations, right, y);
    for (j = 1; j < NODES; ++j) { /* friction bounds how far the speed can get */
      const real drift = l->x - l->h * t->z[j] * l->drag, reach = l->h * t->z[j] * l->push;
      const real next = most(drift - reach, least(drift + reach, t->x[j] + y[j]));
      change = most(change, size_of(next - t->x[j]));
      t->f[j] = sel(t->open, t->f[j] + t->f_v[j] * (next - t->x[j]), t->f[j]);
      t->x[j] = sel(t->open, next, t->x[j]);
    }
    t->open = t->open & no(at_most(change, l->newton_error));
  }
  for (j = 1; j < NODES; ++j) {
    const real v = l->v0 + t->x[j];
    t->e[j][SPEED] = t->at[j].R_v * t->at[j].R_v - v * v;
    t->e[j][FULL] = t->at[j].W_c * t->at[j].W_c - l->W_full * l->W_full;
    if (l->slopes) trum_change(l, l->tau + l->h * t->z[j], &t->at[j], v, &t->by[j]);
  }
  if (l->slopes) t->by[0] = l->changes;
}

/* What comes next for every lane: its step, and how that bends towards an event or away from one. */
typedef struct {
  real h, bend, target;
  mask redo, hit; /* the step is to be tried anew; it ends at the event that it was aimed at */
} trum_plan;

/* How near to an event is at it; nearer where slopes are wanted.  A rotor that is held is as fast as the surface where
 * that stands still, which it touches and does not cross: no step gets as near as slopes want. */
static real trum_nearness(const trum_lanes* l, real which, real of_slopes) {
  const mask speed = trum_same(which, N_(SPEED)), full = trum_same(which, N_(FULL));
  const real nearness = sel(speed | full, l->event_error, l->kink_error);
  return sel(speed & at_most(l->push, N_(0)), nearness, least(nearness, of_slopes));
}

/* Steps end at events.  One that meets an event is aimed at it; one that was aimed there is corrected until it hits. */
static trum_plan trum_aim(trum_lanes* l, trum_attempt* t, mask tiny) {
  const mask aimed = at_most(N_(0), l->target), startled = less_than(l->bend, N_(0));
  const mask patient = less_than(l->tries, N_(10)) & no(tiny); /* no step is tried for ever */
  trum_plan p;
  trum_cubic cubic[EVENTS];
  real place, which, tolerance;
  mask meets, singular, distant, late, off_target = is(0);
  int j, k;
  p.h = l->h, p.bend = l->bend, p.target = l->target, p.hit = is(0);
  trum_first_event(l, t->z, t->e, cubic, &place, &which);
  meets = patient & less_than(place, N_(1.5));
  if (any(aimed)) {
    real root = N_(1), missed = N_(0);
    trum_cubic q = cubic[0];
    for (k = 0; k < EVENTS; ++k) {
      const mask mine = trum_same(l->target, N_(k));
      q.e0 = sel(mine, cubic[k].e0, q.e0), q.d1 = sel(mine, cubic[k].d1, q.d1);
      q.d2 = sel(mine, cubic[k].d2, q.d2), q.d3 = sel(mine, cubic[k].d3, q.d3);
      missed = sel(mine, size_of(t->e[EDGE][k]), missed);
    }
    for (j = 0; j < 3; ++j) { /* it may lie beyond the step's end */
      const real slope = trum_cubic_slope(&q, root);
      const mask steep = less_than(N_(1e-200), size_of(slope));
      root = sel(steep, root - trum_cubic_at(&q, root) * inverse_of(sel(steep, slope, N_(1))), root);
      root = most(N_(1), least(N_(1.25), root));
    }
    root = sel(trum_same(which, l->target), place, root);
    singular = trum_same(l->target, N_(SPEED)) | trum_same(l->target, N_(FULL));
    missed = size_of(root - N_(1)) * l->h * sel(singular, N_(1), missed);
    tolerance = trum_nearness(l, l->target, l->ends);
    p.hit = aimed & less_than(root, N_(1.24)); /* else it turned out to be none */
    off_target = p.hit & patient & less_than(tolerance, missed);
    p.hit = p.hit & no(off_target);
    /* another event on the way comes first */
    meets = meets & no((p.hit | off_target) & trum_same(which, l->target));
    p.h = sel(off_target, l->h * root, p.h);
  }
  singular = trum_same(which, N_(SPEED)) | trum_same(which, N_(FULL));
  tolerance = trum_nearness(l, which, l->begins);
  { /* what a kink weighs is its distance times the pressure there */
    const real weight = sel(trum_same(which, N_(LARGER)), size_of(t->e[0][LARGER]), size_of(t->e[0][SMALLER]));
    distant = meets & less_than(tolerance, place * l->h * sel(singular, N_(1), weight));
  }
  late = meets & no(distant);
  { /* towards it; a step cannot bend at both ends, so one that begins at a square root goes half the way */
    const mask half = distant & startled & singular;
    p.h = sel(distant, l->h * place * sel(half, N_(0.5), N_(1)), p.h);
    p.target = sel(distant, sel(half, N_(-1), which), p.target);
    p.bend = sel(distant & no(startled), sel(singular, N_(1), N_(0)), p.bend);
  }
  p.redo = distant | off_target;
  for (k = 0; k < EVENTS; ++k) { /* an event at the very start was passed unseen: begin at it */
    const mask mine = late & trum_same(which, N_(k)) & no(l->fresh[k]);
    l->fresh[k] = l->fresh[k] | mine;
    p.redo = p.redo | mine;
    if (k == SPEED || k == FULL) p.bend = sel(mine, N_(-1), p.bend);
    /* with slopes a kink at the start leaves the aim where it is: the step may be bent to it */
    if (!l->slopes || k == SPEED || k == FULL) p.target = sel(mine, N_(-1), p.target);
  }
  return p;
}

/* At a square root T f_v and the like are 0 times infinity: their limit, from the other nodes. */
static void trum_limits(real bend, real* K) {
  static const double outward[NODES] = TRUM_COLLOCATION_OUTWARD;
  const real first = N_(outward[1]) * K[1] + N_(outward[2]) * K[2] + N_(outward[3]) * K[3];
  const real last = N_(outward[1]) * K[2] + N_(outward[2]) * K[1] + N_(outward[3]) * K[0];
  K[0] = sel(less_than(bend, N_(0)), first, K[0]), K[EDGE] = sel(less_than(N_(0), bend), last, K[EDGE]);
}

/* The limit of T f_v where the rotor is as fast as all of the surface. */
static real trum_at_root(const trum_lanes* l, const real* e, real R_v_rate, real v, real f) {
  const real R_v = size_of(v), v_rate = l->push * f - l->drag;
  real limit;
  const real* arg[trum_friction_limit_n_arg];
  real* res[trum_friction_limit_n_res];
  arg[trum_friction_limit_in_R_v] = &R_v, arg[trum_friction_limit_in_R_v_rate] = &R_v_rate;
  arg[trum_friction_limit_in_v] = &v, arg[trum_friction_limit_in_v_rate] = &v_rate;
  arg[trum_friction_limit_in_p_larger] = &e[LARGER], arg[trum_friction_limit_in_p_smaller] = &e[SMALLER];
  arg[trum_friction_limit_in_step] = &l->h;
  res[trum_friction_limit_out_T_f_v] = &limit;
  TRUM_KERNEL(trum_friction_limit)(arg, res, 0, 0, 0);
  return limit;
}

/* T f_v at the nodes; the limits where T is 0 are exact if slopes are wanted. */
static void trum_stiffness(const trum_lanes* l, const trum_attempt* t, real* K) {
  const mask from = less_than(l->bend, N_(0)), to = less_than(N_(0), l->bend);
  const real v0 = l->v0 + t->x[0], v1 = l->v0 + t->x[EDGE];
  mask sliding, there;
  real first, last;
  int j;
  for (j = 0; j < NODES; ++j) K[j] = t->T[j] * t->f_v[j];
  trum_limits(l->bend, K);
  K[0] = least(K[0], N_(0)), K[EDGE] = least(K[EDGE], N_(0));
  if (!l->slopes) return;
  first = trum_at_root(l, t->e[0], t->by[0].R_v_rate, v0, t->f[0]);
  last = trum_at_root(l, t->e[EDGE], t->by[EDGE].R_v_rate, v1, t->f[EDGE]);
  sliding = less_than(N_(0), t->e[1][SPEED]); /* some of the surface is faster than the rotor */
  there = less_than(size_of(t->e[EDGE][SPEED]), N_(1e-6) * size_of(t->e[1][SPEED]));
  K[0] = sel(from & l->fresh[SPEED], sel(sliding, first, N_(0)), K[0]);
  K[EDGE] = sel(to & there & trum_same(l->target, N_(SPEED)), sel(sliding, last, N_(0)), K[EDGE]);
}

/* What drives the slopes of f by one thing, times T. */
static void trum_source(const trum_lanes* l, const trum_attempt* t, const real* T_f_v, int way, real* source) {
  int j;
  for (j = 0; j < NODES; ++j)
    source[j] = t->T[j] * t->by[j].f[way] - T_f_v[j] * ((l->v0 + t->x[j]) * t->by[j].ln_R_v[way]);
}

/* T theta_E at the nodes, and its limit where all of the wave begins to touch the layer. */
static void trum_widening(const trum_lanes* l, const trum_attempt* t, real* T_theta_E) {
  const mask from = less_than(l->bend, N_(0)) & l->fresh[FULL];
  const mask to = less_than(N_(0), l->bend) & trum_same(l->target, N_(FULL));
  const mask partly = less_than(N_(0), t->e[1][FULL]) & is(!l->hertz);
  int j;
  for (j = 0; j < NODES; ++j) T_theta_E[j] = t->T[j] * t->by[j].theta_E;
  for (j = 0; j < NODES; j += EDGE) {
    real limit;
    const real* arg[trum_contact_limit_n_arg];
    real* res[trum_contact_limit_n_res];
    arg[trum_contact_limit_in_W_full] = &l->W_full, arg[trum_contact_limit_in_W_c_rate] = &t->by[j].W_c_rate;
    arg[trum_contact_limit_in_step] = &l->h;
    res[trum_contact_limit_out_T_theta_E] = &limit;
    TRUM_KERNEL(trum_contact_limit)(arg, res, 0, 0, 0);
    T_theta_E[j] = sel(j == 0 ? from : to, sel(partly, limit, N_(0)), T_theta_E[j]);
  }
}

/* A step's error over what it may be, and in integral f. */
static real trum_ratio(trum_lanes* l, const trum_attempt* t, mask tiny, real* error) {
  const mask held = at_most(l->push, N_(0));
  real G[NODES], ratio, cosine = l->cos_phi, sine = l->sin_phi;
  mask number, blind = is(0);
  int j;
  for (j = 0; j < NODES; ++j) G[j] = t->T[j] * t->f[j];
  *error = trum_quadrature_error(G);
  if (any(held & l->active)) { /* a held lap also measures the contact */
    G[0] = t->T[0] * l->theta;
    for (j = 1; j < NODES; ++j) G[j] = t->T[j] * t->at[j].theta;
    *error = sel(l->contact, N_(0), *error);
    *error = sel(held, most(*error, N_(0.31830988618379067154) * trum_quadrature_error(G)), *error);
  }
  ratio = *error * l->per_allowed;
  if (l->slopes) {
    const mask felt = less_than(N_(trum_feels) * l->period, l->h);
    const int contact = any(held & l->active); /* a moving lap's is not asked for */
    real T_f_v[NODES], T_theta_E[NODES], of;
    int way;
    trum_stiffness(l, t, T_f_v);
    if (contact) trum_widening(l, t, T_theta_E);
    of = l->push * l->per_growth * trum_quadrature_error(T_f_v);
    for (way = 0; way < WAYS; ++way) {
      if (way == BY_DRAG || way == BY_FRICTION) continue;
      trum_source(l, t, T_f_v, way, G);
      of = most(of, l->per_f[way] * trum_quadrature_error(G));
      if (!contact) continue;
      for (j = 0; j < NODES; ++j) G[j] = T_theta_E[j] * t->by[j].ln_E[way];
      of = sel(held, most(of, l->per_angle[way] * trum_quadrature_error(G)), of);
    }
    ratio = sel(felt & less_than(of, N_(1e30)), most(ratio, of), ratio);
  }
  number = less_than(ratio, N_(1e30));
  ratio = sel(number & no(t->open), least(ratio, N_(1e6)), N_(1e6));
  l->lost = l->lost | (l->active & no(number) & tiny);
  /* near a standing wave the surface's speed turns fast; the steps must see it turn, unless all of it touches */
  for (j = 1; j < NODES; ++j) {
    const real along = cosine * t->at[j].cos_phi + sine * t->at[j].sin_phi;
    blind = blind | (less_than(along, N_(trum_cosine)) & less_than(N_(0), most(t->e[j][FULL], t->e[j - 1][FULL])));
    cosine = t->at[j].cos_phi, sine = t->at[j].sin_phi;
  }
  blind = blind & less_than(N_(trum_sees) * l->period, l->h);
  return sel(blind, most(ratio, N_(40)), ratio);
}

/* The step's slopes: the derivative of the collocation, with its Jacobian K, driven by how friction changes. */
static void trum_take_slopes(trum_lanes* l, const trum_attempt* t, const real* T_f_v, const real* K,
                             const trum_eliminated* equations, mask accepted, real (*d)[NODES]) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  const real per_frequency = N_(-1) / (l->omega_n + l->Delta_omega); /* d ln (drive period) */
  trum_lap* r = &l->lap;
  real source[NODES], T_theta_E[NODES], right[NODES];
  int i, j, way;
  trum_widening(l, t, T_theta_E);
  for (way = 0; way < WAYS; ++way) {
    real sum_x = N_(0), sum_xx = N_(0), sum_f = N_(0), sum_theta = N_(0);
    trum_source(l, t, T_f_v, way, source);
    for (j = 0; j < NODES; ++j) {
      const real b = N_(A[EDGE][j]);
      sum_f = sum_f + b * source[j], sum_theta = sum_theta + b * (T_theta_E[j] * t->by[j].ln_E[way]);
      source[j] = l->push * source[j];
      if (way == BY_PREPRESSURE || way == BY_FRICTION) source[j] = source[j] + t->T[j] * (l->push * t->f[j]);
      if (way == BY_DRAG) source[j] = source[j] - t->T[j];
      if (way == BY_DIFFERENCE || way == BY_RESONANCE)
        source[j] = source[j] + t->T[j] * ((l->push * t->f[j] - l->drag) * per_frequency);
    }
    d[way][0] = l->d[way];
    for (i = 1; i < NODES; ++i) {
      right[i] = l->d[way] * (N_(1) + N_(A[i][0]) * K[0]);
      for (j = 0; j < NODES; ++j) right[i] = right[i] + N_(A[i][j]) * source[j];
    }
    trum_solve(equations, right, d[way]);
    for (j = 0; j < NODES; ++j) {
      const real b = N_(A[EDGE][j]) * t->T[j];
      sum_x = sum_x + b * d[way][j], sum_xx = sum_xx + b * (t->x[j] * d[way][j]);
    }
    r->d_x[way] = sel(accepted, r->d_x[way] + sum_x, r->d_x[way]);
    r->d_xx[way] = sel(accepted, r->d_xx[way] + sum_xx, r->d_xx[way]);
    r->d_friction[way] = sel(accepted, r->d_friction[way] + sum_f, r->d_friction[way]);
    r->size_f[way] = sel(accepted, r->size_f[way] + size_of(sum_f), r->size_f[way]);
    r->size_angle[way] = sel(accepted, r->size_angle[way] + size_of(sum_theta), r->size_angle[way]);
    r->d_angle[way] = sel(accepted, r->d_angle[way] + sum_theta, r->d_angle[way]);
    l->d[way] = sel(accepted, d[way][EDGE], l->d[way]);
  }
  trum_keep(&l->changes, &t->by[EDGE], accepted);
}

/* Accepted lanes take their step. */
static void trum_take(trum_lanes* l, const trum_attempt* t, mask accepted, real error) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  const mask held = at_most(l->push, N_(0));
  trum_lap* r = &l->lap;
  trum_eliminated equations;
  real S[NODES], T_f_v[NODES], K[NODES], rate[NODES], right[NODES], d[WAYS][NODES];
  real sum_f = N_(0), sum_theta = N_(0), sum_x = N_(0), sum_xx = N_(0), sum_S = N_(0), sum_xS = N_(0);
  int i, j, k;
  for (j = 0; j < NODES; ++j) rate[j] = t->T[j] * (l->push * t->f[j] - l->drag);
  trum_stiffness(l, t, T_f_v);
  for (j = 0; j < NODES; ++j) K[j] = l->push * T_f_v[j];
  S[0] = l->S;
  for (i = 1; i < NODES; ++i) right[i] = l->S * (N_(1) + N_(A[i][0]) * K[0]);
  equations = trum_eliminate(K);
  trum_solve(&equations, right, S);
  for (j = 1; j < NODES; ++j) S[j] = most(N_(0), least(l->S, S[j])); /* friction never drives speeds apart */
  for (j = 0; j < NODES; ++j) {
    const real b = N_(A[EDGE][j]) * t->T[j];
    sum_f = sum_f + b * t->f[j], sum_theta = sum_theta + b * (j == 0 ? l->theta : t->at[j].theta);
    sum_x = sum_x + b * t->x[j], sum_xx = sum_xx + b * (t->x[j] * t->x[j]);
    sum_S = sum_S + b * S[j], sum_xS = sum_xS + b * (t->x[j] * S[j]);
  }
  if (l->slopes) trum_take_slopes(l, t, T_f_v, K, &equations, accepted, d);
  trum_extremes(rate, t->x, S, d, l->slopes, accepted & no(held), r);
  for (j = 1; j < NODES; ++j) {
    r->fastest = sel(accepted, most(r->fastest, t->at[j].R_v), r->fastest);
    r->full = sel(accepted & at_most(t->at[j].W_c, l->W_full), N_(1), r->full);
  }
  r->friction = sel(accepted, r->friction + sum_f, r->friction);
  r->angle = sel(accepted, r->angle + sum_theta, r->angle);
  r->x = sel(accepted, r->x + sum_x, r->x), r->xx = sel(accepted, r->xx + sum_xx, r->xx);
  r->S = sel(accepted, r->S + sum_S, r->S), r->xS = sel(accepted, r->xS + sum_xS, r->xS);
  r->error = sel(accepted, r->error + error, r->error);
  if (l->record && in_lane(accepted, 0)) trum_write(l->record, l, rate);
  l->x = sel(accepted, t->x[EDGE], l->x), l->S = sel(accepted, S[EDGE], l->S);
  l->f = sel(accepted, t->f[EDGE], l->f), l->f_v = sel(accepted, t->f_v[EDGE], l->f_v);
  l->theta = sel(accepted, t->at[EDGE].theta, l->theta);
  l->cos_phi = sel(accepted, t->at[EDGE].cos_phi, l->cos_phi);
  l->sin_phi = sel(accepted, t->at[EDGE].sin_phi, l->sin_phi);
  for (k = 0; k < EVENTS; ++k) l->event[k] = sel(accepted, t->e[EDGE][k], l->event[k]);
}

/* Where the square root of an event is that a plain step ends short of, in step lengths, or 2 if far. */
static real trum_near_root(const trum_lanes* l, const trum_attempt* t, int event) {
  const trum_places spaces = trum_space(t->z);
  const trum_cubic c = trum_through(&spaces, t->e[0][event], t->e[1][event], t->e[2][event], t->e[EDGE][event]);
  const mask plain = at_most(size_of(l->bend), N_(0)) & less_than(N_(0), c.e0);
  real root = N_(1);
  int j;
  for (j = 0; j < 3; ++j) {
    const real slope = trum_cubic_slope(&c, root);
    const mask falling = less_than(slope, N_(-1e-200));
    root = sel(falling, root - trum_cubic_at(&c, root) * inverse_of(sel(falling, slope, N_(1))), N_(2));
    root = most(N_(0), least(N_(2), root));
  }
  return sel(plain & less_than(N_(1), root) & less_than(root, N_(1.5)) & less_than(l->h * root, l->left), root, N_(2));
}

/* A step with slopes that ends short of a square root is better aimed at it than made shorter or taken: slopes feel it
 * from afar. */
static mask trum_feel(const trum_lanes* l, const trum_attempt* t, mask accepted, mask shrink, trum_plan* p) {
  const mask unseen = accepted & no(less_than(N_(trum_feels) * l->period, l->h));
  const mask held = at_most(l->push, N_(0)), missed = shrink & less_than(N_(0), l->bend);
  const real speed = sel(held, N_(2), trum_near_root(l, t, SPEED)), full = trum_near_root(l, t, FULL);
  const real root = least(speed, full);
  const mask near_root = (shrink | unseen) & less_than(root, N_(2));
  p->h = sel(near_root, l->h * root, sel(missed, least(p->h, N_(0.5) * l->h), p->h));
  p->target = sel(near_root, sel(less_than(full, speed), N_(FULL), N_(SPEED)), p->target);
  p->bend = sel(near_root, N_(1), p->bend);
  return near_root;
}

/* Tries a step on all lanes; returns those which took it. */
static mask trum_step(trum_lanes* l) {
  const mask tiny = at_most(l->h, N_(trum_shortest) * l->period);
  trum_attempt t;
  trum_plan p;
  real ratio, error, factor;
  mask wrong, accepted, shrink;
  int k;
  trum_try(l, &t);
  p = trum_aim(l, &t, tiny);
  ratio = trum_ratio(l, &t, tiny, &error);
  wrong = no(at_most(ratio, N_(1))) & no(tiny);
  factor = N_(trum_margin) * inverse_of(root_of(root_of(most(ratio, N_(1e-5)))));
  factor = least(N_(trum_grows), most(N_(0.15), factor));
  accepted = l->active & no(p.redo) & no(wrong), shrink = wrong & no(p.redo);
  p.h = sel(shrink, l->h * factor, p.h), l->natural = sel(shrink, p.h, l->natural);
  p.target = sel(shrink, N_(-1), p.target);
  p.bend = sel(shrink & less_than(N_(0), p.bend), N_(0), p.bend);
  if (l->slopes) accepted = accepted & no(trum_feel(l, &t, accepted, shrink, &p));
  l->tries = sel(p.redo, l->tries + N_(1), sel(accepted, N_(0), l->tries));
  if (any(accepted)) {
    const real longest = N_(trum_longest) * l->period, grown = least(longest, l->h * factor);
    const mask finished = accepted & at_most(l->left, l->h * N_(1.0000001)), cut = finished | at_most(N_(0), l->target);
    trum_take(l, &t, accepted, error);
    /* a step that an event or a region's end has cut short says nothing against the length before */
    l->natural = sel(accepted, sel(cut, least(longest, most(l->natural, grown)), grown), l->natural);
    l->tau = sel(accepted, l->tau + l->h, l->tau);
    l->left = sel(accepted, sel(finished, N_(0), l->left - l->h), l->left);
    p.h = sel(accepted, l->natural, p.h);
    p.bend = sel(accepted, N_(0), p.bend);
    for (k = 0; k < EVENTS; ++k) {
      const mask mine = p.hit & trum_same(l->target, N_(k));
      l->fresh[k] = sel_mask(accepted, mine, l->fresh[k]);
      if (k == SPEED || k == FULL) p.bend = sel(accepted & mine, N_(-1), p.bend);
    }
    p.target = sel(accepted, N_(-1), p.target);
  }
  l->h = least(p.h, l->left), l->bend = p.bend, l->target = p.target;
  l->patience = l->patience - N_(1);
  return accepted;
}

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
  double growth, size_f[WAYS], size_angle[WAYS]; /* what a lap with slopes adds up, from the last one */
  int stage, region, laps, finer, halves; /* halves: whether the bracket is to be halved next */
  int sized;                              /* laps with slopes of the held rotor so far */
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
  for (k = 0; l->slopes && k < 8; ++k) put(&l->slopes_[k / 4][k % 4], i, job->slopes[k / 4][job->region][k % 4]);
  put(&l->g_A, i, gates_A[job->region]), put(&l->g_B, i, gates_B[job->region]);
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
  for (k = 0; l->slopes && k < WAYS; ++k) {
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
  for (k = 0; l->slopes && k < WAYS; ++k) {
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

/* Slopes of the phasors at the start of the regions. */
static void trum_load_slopes(trum_job* job) {
  const trum_orbit_in* in = job->in;
  double arg_[trum_regions_slopes_n_arg];
  trum_real own[trum_regions_slopes_n_arg], res_[trum_regions_slopes_n_res];
  const trum_real* arg[trum_regions_slopes_n_arg];
  trum_real* res[trum_regions_slopes_n_res];
  int k, by, phase, r, part;
  arg_[trum_regions_slopes_in_Delta_omega] = in->Delta_omega, arg_[trum_regions_slopes_in_W] = in->W;
  arg_[trum_regions_slopes_in_a_A] = in->a_A, arg_[trum_regions_slopes_in_b_A] = in->b_A;
  arg_[trum_regions_slopes_in_a_B] = in->a_B, arg_[trum_regions_slopes_in_b_B] = in->b_B;
  arg_[trum_regions_slopes_in_m] = in->m, arg_[trum_regions_slopes_in_n] = in->n;
  arg_[trum_regions_slopes_in_omega_n] = in->omega_n, arg_[trum_regions_slopes_in_psi] = in->psi;
  arg_[trum_regions_slopes_in_s] = in->s, arg_[trum_regions_slopes_in_xi] = in->xi;
  arg_[trum_regions_slopes_in_a_A_omega_n] = job->slopes_in->by_resonance[0];
  arg_[trum_regions_slopes_in_b_A_omega_n] = job->slopes_in->by_resonance[1];
  arg_[trum_regions_slopes_in_a_B_omega_n] = job->slopes_in->by_resonance[2];
  arg_[trum_regions_slopes_in_b_B_omega_n] = job->slopes_in->by_resonance[3];
  arg_[trum_regions_slopes_in_a_A_Delta_omega] = job->slopes_in->by_difference[0];
  arg_[trum_regions_slopes_in_b_A_Delta_omega] = job->slopes_in->by_difference[1];
  arg_[trum_regions_slopes_in_a_B_Delta_omega] = job->slopes_in->by_difference[2];
  arg_[trum_regions_slopes_in_b_B_Delta_omega] = job->slopes_in->by_difference[3];
  for (k = 0; k < trum_regions_slopes_n_arg; ++k) own[k] = (trum_real)arg_[k], arg[k] = &own[k];
  for (k = 0; k < trum_regions_slopes_n_res; ++k) res[k] = &res_[k];
  trum_regions_slopes(arg, res, 0, 0, 0);
  for (by = k = 0; by < 2; ++by)
    for (phase = 0; phase < 2; ++phase)
      for (r = 0; r < TRUM_REGIONS; ++r)
        for (part = 0; part < 2; ++part) job->slopes[by][r][2 * phase + part] = res_[k++];
}

/* Slopes of the figures, when the orbit is found: d0 is that of the start speed which the lap reproduces. */
static void trum_figures_slopes(const trum_lanes* l, int i, trum_job* job) {
  const trum_lap* r = &l->lap;
  const double whole = get(&l->whole, i), growth = get(&l->S, i), pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
  const double x = get(&r->x, i) / whole, S = get(&r->S, i) / whole, xS = get(&r->xS, i) / whole;
  int way;
  for (way = 0; way < WAYS; ++way) {
    double(*of)[WAYS] = job->slopes_out->of;
    if (job->stage == HELD) {
      if (job->sized != 1) of[OF_CONTACT][way] = get(&r->d_angle[way], i) / whole / 3.14159265358979323846;
      if (job->sized != 2) of[OF_HELD][way] = get(&r->d_friction[way], i) / whole;
    } else {
      const double d0 = get(&l->d[way], i) / pull, d_x = get(&r->d_x[way], i) / whole;
      of[OF_MEAN][way] = d_x + S * d0;
      of[OF_LOW][way] = get(&r->d_low[way], i) + get(&r->S_low, i) * d0;
      of[OF_HIGH][way] = get(&r->d_high[way], i) + get(&r->S_high, i) * d0;
      of[OF_VARIANCE][way] = 2.0 * (get(&r->d_xx[way], i) / whole - x * d_x + (xS - x * S) * d0);
    }
  }
}

/* The next lap's slopes are not looked after: nothing is known of their size. */
static void trum_unsized(trum_job* job) {
  int k;
  job->growth = 1e300;
  for (k = 0; k < WAYS; ++k) job->size_f[k] = job->size_angle[k] = 1e300;
}

/* The rough level that makes one fine lap enough: Newton's step from there leaves its square. */
static double trum_rough(double tolerance) { return trum_level * 0.1 * sqrt(tolerance); }

/* A point's search for its orbit begins from rest, or from where it is known to begin; 0 if no speed balances the load. */
static int trum_set_off(trum_lanes* l, int i, trum_job* job, double known) {
  const trum_orbit_in* in = job->in;
  if (!(in->push > fabs(in->drag))) {
    job->out->flags += trum_runaway;
    return 0;
  }
  job->stage = ROUGH, job->level = trum_level * trum_coarse;
  job->scale = 0.1 * in->D * in->k_c * in->W * (in->omega_n + in->Delta_omega);
  if (!isnan(known)) job->v0 = known, job->laps = 1;
  trum_start_lap(l, i, job);
  return 1;
}

/* Puts a piece of a point's work into a lane: its rotor held, or the search for its orbit, from where that begins if it
 * is known.  0 if there is nothing to do. */
static int trum_load(trum_lanes* l, int i, trum_job* job, const trum_orbit_in* in, trum_orbit_out* out, int held,
                     double known) {
  const double period = 6.283185307179586477 / (in->omega_n + in->Delta_omega);
  double arg_[trum_regions_n_arg];
  trum_real own[trum_regions_n_arg], res_[trum_regions_n_res];
  const trum_real* arg[trum_regions_n_arg];
  trum_real* res[trum_regions_n_res];
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
  for (k = 0; k < trum_regions_n_arg; ++k) own[k] = (trum_real)arg_[k], arg[k] = &own[k];
  for (k = 0; k < trum_regions_n_res; ++k) res[k] = &res_[k];
  trum_regions(arg, res, 0, 0, 0);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    job->pulses[r] = floor(res_[trum_regions_out_time_redu + r] / period + 0.5);
    for (phase = 0; phase < 2; ++phase) {
      trum_real to_[trum_phasor_n_arg], phasor[trum_phasor_n_res];
      const trum_real* to[trum_phasor_n_arg];
      trum_real* z[trum_phasor_n_res];
      to_[trum_phasor_in_a] = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase];
      to_[trum_phasor_in_b] = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase + 1];
      to_[trum_phasor_in_omega_n] = (trum_real)in->omega_n, to_[trum_phasor_in_xi] = (trum_real)in->xi;
      for (k = 0; k < trum_phasor_n_arg; ++k) to[k] = &to_[k];
      for (k = 0; k < trum_phasor_n_res; ++k) z[k] = &phasor[k];
      trum_phasor(to, z, 0, 0, 0);
      job->start[r][2 * phase] = phasor[trum_phasor_out_re], job->start[r][2 * phase + 1] = phasor[trum_phasor_out_im];
    }
  }
  job->in = in, job->out = out;
  job->laps = job->finer = job->halves = 0, job->last_away = job->last_noise = 0.0, job->keeps = 1.0;
  job->stage = HELD, job->v0 = 0.0, job->low = -HUGE_VAL, job->high = HUGE_VAL;
  job->scale = 0.0, job->level = trum_level * in->tolerance;
  job->sized = 0, trum_unsized(job);
  if (l->slopes) trum_load_slopes(job);
  if (!held) return trum_set_off(l, i, job, known);
  trum_start_lap(l, i, job);
  return 1;
}

/* Errors of the next lap's slopes are measured by what this one has added up. */
static void trum_size(const trum_lanes* l, int i, trum_job* job, double growth) {
  int k;
  job->growth = growth;
  for (k = 0; k < WAYS; ++k) {
    job->size_f[k] = get(&l->lap.size_f[k], i) + 1e-250, job->size_angle[k] = get(&l->lap.size_angle[k], i) + 1e-250;
  }
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
    if (l->slopes && !lost) trum_figures_slopes(l, i, job);
    if (l->slopes && !lost && job->sized < 2) { /* once more for the friction, and for the contact by itself */
      if (!job->sized) trum_size(l, i, job, 1e300);
      ++job->sized;
      trum_start_lap(l, i, job);
      return 1;
    }
    if (get(&r->full, i) > 0.0) out->flags += trum_full_contact;
    return 0;
  }
  if (lost) { /* steps that are too bold chatter where the rotor is as fast as a line of contact */
    const double fine = trum_level * in->tolerance;
    if (++job->finer > 3) return 0;
    job->level = job->level > fine ? fine : 0.1 * job->level, ++job->laps;
    trum_start_lap(l, i, job);
    return 1;
  }
  {
    const double gain = get(&l->x, i), growth = get(&l->S, i), pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
    const double low = get(&r->low, i), high = get(&r->high, i), bound = 1.5 * get(&r->fastest, i);
    const double top = fabs(job->v0 + low) > fabs(job->v0 + high) ? fabs(job->v0 + low) : fabs(job->v0 + high);
    const double fine = trum_level * in->tolerance;
    const int accurate = job->level <= fine * 1.0001, last = ++job->laps >= trum_most_laps;
    /* a Newton step this small leaves an error of its square: the figures' derivatives take it along, slopes do not */
    const double nearly = top * (l->slopes && job->stage == FINE ? in->tolerance : sqrt(0.1 * in->tolerance));
    const int coarse = job->laps == 1 && !accurate;
    const double missed = get(&r->error, i) * in->push, noise = missed / pull, was = job->level * job->scale;
    double next = job->v0 + gain / pull, away, left;
    int inside, pinned, close;
    if (!coarse || fabs(gain) > 10.0 * missed) {
      if (gain > 0.0) job->low = job->v0, job->gain_low = gain;
      else job->high = job->v0, job->gain_high = gain;
    }
    next = next > bound ? bound : next < -bound ? -bound : next;
    /* Newton's step is not taken out of the bracket, nor if it is not getting shorter: it may go round in circles */
    inside = next > job->low && next < job->high && fabs(next - job->v0) <= 0.5 * job->last_away;
    if (!inside && job->low > -HUGE_VAL && job->high < HUGE_VAL) {
      const double share = job->halves ? 0.5 : job->gain_low / (job->gain_low - job->gain_high);
      next = job->low + share * (job->high - job->low), job->halves = !job->halves;
    }
    away = next - job->v0;
    pinned = !coarse && (fabs(away) <= noise || job->high - job->low <= 1e-15 * bound);
    /* what Newton's step leaves is its square, or what a lap keeps of it, and of the steps' errors a part: most cancel */
    left = fabs(away) * (growth < fabs(away) / top ? growth : fabs(away) / top) + 0.3 * noise;
    if (job->last_away > 10.0 * job->last_noise) job->keeps = fabs(away) < job->last_away ? fabs(away) / job->last_away : 1.0;
    job->last_away = fabs(away), job->last_noise = noise;
    close = accurate ? fabs(away) <= nearly && fabs(away) * job->keeps <= in->tolerance * top : left <= nearly;
    close = close || pinned;
    if (l->slopes) trum_size(l, i, job, pull);
    /* the less a lap pulls speeds together, the more an error of a step weighs */
    job->scale = top * (pull > 1e-3 ? pull : 1e-3 * (in->push * whole < top ? pull + in->push * whole / top : 1.0));
    if (l->slopes && job->stage == ROUGH) { /* the orbit is known, and now its slopes' size is */
      job->stage = FINE, job->level = fine, job->low = -HUGE_VAL, job->high = HUGE_VAL;
      trum_start_lap(l, i, job);
      return 1;
    }
    if (close && accurate && noise > in->tolerance * top && !last && ++job->finer <= 3) {
      const double excess = in->tolerance * top / noise;
      job->level *= 0.3 * (excess > 0.01 ? excess : 0.01);
    } else if (close && (accurate || last)) {
      const double mean = get(&r->x, i) / whole, mean_S = get(&r->S, i) / whole;
      const double square = get(&r->xx, i) / whole, mean_xS = get(&r->xS, i) / whole;
      const double variance = square - mean * mean + 2.0 * away * (mean_xS - mean * mean_S);
      if (l->slopes) trum_figures_slopes(l, i, job);
      out->mean = job->v0 + mean + away * mean_S;
      out->low = job->v0 + low + away * get(&r->S_low, i), out->high = job->v0 + high + away * get(&r->S_high, i);
      /* Newton's last change leaves the order of nearly equal speeds open */
      out->low = out->low < out->mean ? out->low : out->mean, out->high = out->high > out->mean ? out->high : out->mean;
      out->variance = variance > 0.0 ? variance : 0.0;
      out->start = next, out->level = job->level, out->error = noise / top;
      if (noise <= in->tolerance * top) out->flags += trum_converged;
      return 0;
    }
    if (last) { /* the best there is, and not flagged as converged */
      out->mean = job->v0 + get(&r->x, i) / whole, out->low = job->v0 + low, out->high = job->v0 + high;
      out->variance = get(&r->xx, i) / whole - (get(&r->x, i) / whole) * (get(&r->x, i) / whole);
      out->start = job->v0, out->level = job->level, out->error = fabs(away) / top;
      return 0;
    }
    if (close) {
      /* the steps' errors add up to what follows the level's power 3/4 */
      const double ratio = fine * job->scale / was, expected = noise * sqrt(ratio) * sqrt(sqrt(ratio));
      const double excess = in->tolerance * top / expected;
      job->level = excess < 1.0 ? fine * 0.5 * (excess > 0.01 ? excess : 0.01) : fine;
      job->stage = FINE, job->low = -HUGE_VAL, job->high = HUGE_VAL;
    } else if (coarse) {
      job->level = trum_rough(in->tolerance);
    }
    job->v0 = next;
  }
  trum_start_lap(l, i, job);
  return 1;
}

static void trum_clear(trum_lanes* l, int hertz, int slopes) {
  int k;
  l->active = l->cold = l->lost = l->contact = is(0), l->hertz = hertz, l->slopes = slopes, l->record = 0;
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

/* Nothing is known yet. */
static void trum_blank(trum_orbit_out* out, trum_slopes_out* slopes) {
  int of, way;
  out->mean = out->low = out->high = out->variance = out->start = out->level = out->error = NAN;
  out->contact = out->held = NAN, out->flags = 0;
  for (of = 0; slopes && of < FIGURES; ++of)
    for (way = 0; way < WAYS; ++way) slopes->of[of][way] = NAN;
}

/* The piece of work from which on there is some: a point's rotor held, if that is wanted, then its orbit. */
static long trum_next_piece(const trum_orbit_in* in, long piece, long count) {
  return piece < 2 * count && piece % 2 == 0 && !(in[piece / 2].held > 0.5) ? piece + 1 : piece;
}

/* Works through count points of one contact law; lanes take the next piece of work when they are done with one.  Slopes
 * are of orbits that are known. */
static void trum_run(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                     trum_slopes_out* slopes_out, long count) {
  trum_lanes l;
  trum_job jobs[TRUM_LANES];
  trum_orbit_out own[TRUM_LANES];
  trum_slopes_out unused;
  int busy[TRUM_LANES], used[TRUM_LANES], i, left;
  long next = 0;
  trum_clear(&l, in[0].hertz > 0.5, slopes_in != 0);
  for (i = 0; i < TRUM_LANES; ++i) busy[i] = used[i] = 0;
  do {
    for (i = left = 0; i < TRUM_LANES; ++i) {
      int taken;
      while (!busy[i] && ((taken = (next = trum_next_piece(in, next, count)) < 2 * count) || !used[i])) {
        /* lanes that never had work carry the last point's numbers, and rest */
        const long point = taken ? next / 2 : count - 1;
        const int scratch = slopes_in || !taken;
        jobs[i].slopes_in = slopes_in ? &slopes_in[point] : 0;
        jobs[i].slopes_out = slopes_out && taken ? &slopes_out[point] : &unused;
        if (scratch) trum_blank(&own[i], 0);
        busy[i] = trum_load(&l, i, &jobs[i], &in[point], scratch ? &own[i] : &out[point], !taken || next % 2 == 0,
                            slopes_in ? out[point].start : NAN);
        busy[i] = busy[i] && taken, used[i] = 1, next += taken;
        if (!busy[i]) put_mask(&l.active, i, 0);
      }
      left += busy[i];
    }
    if (left) trum_advance(&l, jobs, busy);
  } while (left);
}

/* Orbits of count points of one contact law, and their slopes unless these are null. */
static void trum_orbits(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                        trum_slopes_out* slopes_out, long count) {
  long k;
  if (count <= 0) return;
  for (k = 0; k < count; ++k) trum_blank(&out[k], slopes_out ? &slopes_out[k] : 0);
  trum_run(in, out, 0, 0, count);
  for (k = 0; k < count; ++k) {
    const int flags = (int)out[k].flags;
    if (in[k].held > 0.5 && isnan(out[k].held) && flags & trum_converged) out[k].flags = flags - trum_converged;
  }
  if (slopes_in) trum_run(in, out, slopes_in, slopes_out, count);
}

/* One cycle of a point's orbit: rim speed, and distance since t1, at count equal times after t1. */
static void trum_history(const trum_orbit_in* in, const trum_orbit_out* orbit, double* speed, double* distance,
                         long count) {
  trum_lanes l;
  trum_job jobs[TRUM_LANES];
  trum_orbit_out unused;
  trum_record record;
  int i;
  trum_clear(&l, in->hertz > 0.5, 0);
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_load(&l, i, &jobs[i], in, &unused, 1, NAN);
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
