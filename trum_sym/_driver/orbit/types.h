/* What the orbit's functions pass to each other: a point's input and output, a lap's sums, the lanes' state. */
#ifndef TRUM_ORBIT_TYPES_H
#define TRUM_ORBIT_TYPES_H

enum { EDGE = TRUM_COLLOCATION_NODES - 1, NODES = TRUM_COLLOCATION_NODES };

/* One lap's figures: sums are over time from its start, x is the rim's speed over that at the start. */
typedef struct {
  real x, xx, S, xS;              /* integrals of x, x^2, S = dv/dv0 and x S */
  real low, high, S_low, S_high;  /* extremes of x, and S there */
  real friction, angle;           /* integrals of f and theta/pi */
  real full, fastest, error;      /* any full contact; largest surface speed; sum of the steps' errors of integral f */
  real size_f[TRUM_SLOPE_PARAMETERS_COUNT], size_angle[TRUM_SLOPE_PARAMETERS_COUNT]; /* sums of the sizes of the steps' shares of d_friction and d_angle */
  real d_x[TRUM_SLOPE_PARAMETERS_COUNT], d_xx[TRUM_SLOPE_PARAMETERS_COUNT], d_low[TRUM_SLOPE_PARAMETERS_COUNT], d_high[TRUM_SLOPE_PARAMETERS_COUNT], d_friction[TRUM_SLOPE_PARAMETERS_COUNT], d_angle[TRUM_SLOPE_PARAMETERS_COUNT]; /* the same, as slopes */
} trum_lap;

/* Events, in the order of the functions that change sign there. */
enum { SPEED, LARGER, SMALLER, FULL, EVENTS };

/* How an instant's friction fraction and the logarithms of engagement and surface speed change by what the slopes are
 * by.  The surface speed's share in f is left out of f, and theta's change is apart: both are infinite where there are
 * square roots.  Rates are in time. */
typedef struct {
  real f[TRUM_SLOPE_PARAMETERS_COUNT], ln_E[TRUM_SLOPE_PARAMETERS_COUNT], ln_R_v[TRUM_SLOPE_PARAMETERS_COUNT], theta_E, R_v_rate, W_c_rate;
} trum_changes;

/* Speed and distance of lane 0 at equal times of a lap. */
typedef struct {
  double *speed, *distance;
  double spacing, since, travelled;
  long count, written;
} trum_record;

/* Lanes of points under way. */
typedef struct {
  trum_constants constants;
  real push, drag, period, whole;
  trum_region region;
  real v0, per_allowed, event_error, kink_error; /* of the lap: start speed; 1/error of a step's integral f, 1/s; events */
  real per_growth, per_f[TRUM_SLOPE_PARAMETERS_COUNT], per_angle[TRUM_SLOPE_PARAMETERS_COUNT]; /* 1/error of what slopes integrate: growth, and what drives them */
  real begins, ends;                             /* how near to events steps with slopes begin and end */
  real newton_error;                           /* last change of a step's speeds, whose square is the error left */
  real tau, left, h, natural, bend;            /* place in the region; the step, its size without events, its map */
  real target, tries, patience;                /* the event that the step is to end at, or -1 */
  real x, S, f, f_v, theta, cos_phi, sin_phi, event[EVENTS];    /* where the step begins */
  real d[TRUM_SLOPE_PARAMETERS_COUNT];                                /* slopes there, of x */
  trum_changes changes;                        /* and of what x follows */
  trum_region_slopes region_slopes;
  mask fresh[EVENTS];                          /* it begins at this event */
  mask active, cold, lost;
  mask contact; /* the lap measures the contact and no friction, whose kinks it passes over */
  int hertz, slopes; /* contact law; whether slopes are wanted */
  trum_lap lap;
  trum_record* record;
} trum_lanes;

#endif
