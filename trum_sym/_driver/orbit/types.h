/* What the orbit's functions pass to each other: a point's input and output, a lap's sums, the lanes' state. */
#ifndef TRUM_ORBIT_TYPES_H
#define TRUM_ORBIT_TYPES_H

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

#endif
