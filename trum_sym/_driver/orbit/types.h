/* What the orbit's functions pass to each other: a point's input and output, a lap's sums, the lanes' state. */
#ifndef TRUM_ORBIT_TYPES_H
#define TRUM_ORBIT_TYPES_H

enum { FIGURES = TRUM_SLOPE_FIGURES_COUNT, PARAMETERS = TRUM_SLOPE_PARAMETERS_COUNT };
enum { LAST_NODE = TRUM_COLLOCATION_NODES - 1, NODES = TRUM_COLLOCATION_NODES };

/* One lap's figures: sums are over time from its start, x is the rim's speed over that at the start. */
typedef struct {
  real x, xx, S, xS;             /* integrals of x, x^2, S = dv/dv0 and x S */
  real low, high, S_low, S_high; /* extremes of x, and S there */
  real friction, angle;          /* integrals of f and theta/pi */
  real full_contact, fastest,
      error; /* any full contact; largest surface speed; sum of the steps' errors of integral f */
  real sum_abs_friction[PARAMETERS],
      sum_abs_angle[PARAMETERS]; /* sums of the sizes of the steps' shares of d_friction and d_angle */
  real d_x[PARAMETERS], d_xx[PARAMETERS], d_low[PARAMETERS], d_high[PARAMETERS], d_friction[PARAMETERS],
      d_angle[PARAMETERS]; /* the same, as slopes */
} trum_lap;

/* Events, in the order of their functions. */
enum { EVENT_SATURATION, EVENT_LARGER_PRESSURE, EVENT_SMALLER_PRESSURE, EVENT_FULL_CONTACT, EVENT_COUNT };

/* Derivatives, at an instant, of the friction fraction and of the logarithms of engagement and surface speed by each
 * parameter.  f leaves out what follows from the surface speed, and theta's derivative by the engagement is apart: both
 * are infinite at square roots.  Rates are in time. */
typedef struct {
  real f[PARAMETERS], ln_E[PARAMETERS], ln_R_v[PARAMETERS], theta_E, R_v_rate, W_c_rate;
} trum_derivatives;

/* Speed and distance of lane 0 at equal times of a lap. */
typedef struct {
  double *speed, *distance;
  double spacing, since, travelled;
  long count, written;
} trum_record;

/* The state of the lanes. */
typedef struct {
  trum_constants constants;
  real push, drag, period, cycle_time;
  trum_region region;
  real v0, inverse_step_tolerance, root_tolerance,
      kink_tolerance; /* of the lap: start speed; 1/error of a step's integral f, 1/s; events */
  real inverse_growth_tolerance, inverse_friction_tolerance[PARAMETERS],
      inverse_angle_tolerance[PARAMETERS];         /* 1/error of what slopes integrate: growth, and what drives them */
  real slope_start_tolerance, slope_end_tolerance; /* how near to events steps with slopes begin and end */
  real newton_tolerance;                           /* last change of a step's speeds, whose square is the error left */
  real tau, time_left, h, step_size, curvature;    /* place in the region; the step, its size without events, its map */
  real target_event, retries, steps_left;          /* the event that the step is to end at, or -1 */
  real x, S, f, f_v, theta, cos_phi, sin_phi, events[EVENT_COUNT]; /* where the step begins */
  real slopes_x[PARAMETERS];                                       /* slopes there, of x */
  trum_derivatives derivatives;                                    /* and of what x follows */
  trum_region_slopes region_slopes;
  mask at_event[EVENT_COUNT]; /* it begins at this event */
  mask active, at_lap_start, failed;
  mask contact_only; /* the lap measures the contact and no friction, whose kinks it passes over */
  int hertz, slopes; /* contact law; whether slopes are wanted */
  trum_lap lap;
  trum_record* record;
} trum_lanes;

#endif
