/* What the orbit's functions pass to each other: a point's input and output, a lap's sums, the lanes' state. */
#ifndef TRUM_ORBIT_TYPES_H
#define TRUM_ORBIT_TYPES_H

enum { FIGURES = TRUM_SLOPE_FIGURES_COUNT, PARAMETERS = TRUM_SLOPES ? TRUM_SLOPE_PARAMETERS_COUNT : 1 };
enum { LAST_NODE = TRUM_COLLOCATION_NODES - 1, NODES = TRUM_COLLOCATION_NODES, CHECKS = 3 };

/* Glossary.
 *
 *   region       one of the three parts of a drive cycle, between switchings of the phases' gates (Sect. 3)
 *   lap          the rotor's motion over one drive cycle from a start speed
 *   orbit        the lap that ends at the speed at which it started
 *   x            the rim's speed over that at the lap's start, m/s
 *   f            net friction fraction, -1 to 1 (eqs. 33 to 37); the friction torque is mu F_c r_c f
 *   theta        half-angle of the contact (eqs. 25, 31), pi where the whole wave touches
 *   engagement   E, how far the wave's crest is pressed into the layer over the layer's depth under full contact
 *   S            derivative of v by the start speed v0; it falls from 1, as friction draws speeds together
 *   growth       S at the lap's end; 1 - growth is the decay of a difference of speed over a lap
 *   event        an instant at which f or theta is not smooth: saturation, edge of the contact, full contact
 *   held rotor   a rotor kept at rest, whose laps give contact and stall torque
 *   parameter    what a sensitivity is by; sensitivities are also called slopes */

/* Events, in the order of their functions. */
enum { EVENT_SATURATION, EVENT_LARGER_PRESSURE, EVENT_SMALLER_PRESSURE, EVENT_FULL_CONTACT, EVENT_COUNT };

/* Sums of a lap so far; integrals are over time from its start. */
typedef struct {
  real x, xx, S, xS;                                /* integrals of x, x^2, S and x S */
  real low, high, S_low, S_high;                    /* lowest and highest x, and S there */
  real friction, angle;                             /* integrals of f and theta */
  real full_contact, fastest;                       /* 1 if ever in full contact; largest surface speed */
  /* First-order errors of the lap by the steps' defects, and bounds of what these leave out (defect.h): of x at its end
   * so far; integrals over time of those, of the error's square and of its product with S; at the extremes; of the
   * integrals of f and theta.  Integrals of S^2 and of the interpolants' error inside the steps. */
  real kept; /* share of an error, since a watched period began (repeat.h) */
  real error, remainder, error_sum, remainder_sum, error_square, error_S, remainder_square, SS, inside;
  real low_error, low_remainder, high_error, high_remainder;
  real lowest, highest; /* bounds of x at all extremes, those that are not the lap's by a hair too */
  real friction_error, friction_remainder, angle_error, angle_remainder;
  real d_x[PARAMETERS], d_xx[PARAMETERS];           /* sensitivities of all of these: integrals of dx and x dx, */
  real d_low[PARAMETERS], d_high[PARAMETERS];       /* of the extremes, */
  real d_friction[PARAMETERS], d_angle[PARAMETERS]; /* and of the integrals of f and theta at fixed speed; */
  real sum_abs_friction[PARAMETERS], sum_abs_angle[PARAMETERS]; /* sums of the latter two's magnitudes, step by step */
} trum_lap;

/* Derivatives, at an instant, of the friction fraction and of the logarithms of engagement and surface speed by each
 * parameter.  f leaves out what follows from the surface speed, and theta's derivative by the engagement is apart: both
 * are infinite at square roots.  Rates are in time. */
typedef struct {
  real f[PARAMETERS], ln_E[PARAMETERS], ln_R_v[PARAMETERS], theta_E, R_v_rate, W_c_rate;
} trum_derivatives;

/* The lap's equation of motion for the speed v0 + x: x' = push f(v0 + x, t) - drag, over cycle_time, which is a number of drive periods. */
typedef struct {
  real push, drag, v0, period, cycle_time;
} trum_equation;

/* What a step may leave in error; `inverse` ones are 1 over the allowed error of an integral over the step. */
typedef struct {
  real inverse_step;   /* of f, and of theta / pi of a held rotor */
  real root, kink;     /* distance from an event, s; times pressure at a kink */
  real newton;         /* Newton's last change, m/s; its square is left over */
  real inverse_growth; /* of the sensitivities' Jacobian, */
  real inverse_friction[PARAMETERS], inverse_angle[PARAMETERS]; /* of their sources */
  real slope_start, slope_end; /* distance from an event at which steps with slopes begin and end, s */
} trum_tolerances;

/* Where a lane is in its region, and the next step. */
typedef struct {
  real tau, time_left; /* since the region's start, until its end, s */
  real h, curvature;   /* length of the step, s, and the curvature of its time (event_steps.h) */
  real free_h;         /* the length that its error alone would give */
  real target_event;   /* the event that the step is to end at, or -1 */
  real retries;        /* attempts at this step so far that were given up for an event */
  real steps_left;     /* attempts until the lap is given up */
  real growth;         /* the most by which free_h may grow: none after a rejection */
  real stiffness;      /* rate at which the steps before drew speeds together, 1/s */
} trum_step_control;

/* What a step takes over from the last node of the one before. */
typedef struct {
  real x, S, f, f_v, theta, cos_phi, sin_phi, events[EVENT_COUNT];
  mask at_event[EVENT_COUNT]; /* the step begins at this event */
} trum_step_start;

/* Sensitivities of x where a step begins, and the derivatives there. */
typedef struct {
  real x[PARAMETERS];
  trum_derivatives derivatives;
} trum_sensitivity;

/* What a lane is doing. */
typedef struct {
  mask active;       /* it has a lap to do */
  mask at_lap_start; /* the right-hand side at the lap's start is not evaluated yet */
  mask failed;       /* the lap cannot be followed */
  mask rough;        /* the lap only looks for where the orbit is */
  mask contact_only; /* the lap measures theta and not f, so that f's kinks do not matter */
} trum_status_masks;

/* Speed and distance of lane 0 at equal times of a lap. */
typedef struct {
  trum_real *speed, *distance;
  trum_real spacing, since, travelled; /* between the times; time and distance at the step's start */
  long count, written;
} trum_record;

#if TRUM_LANES > 1
/* How lanes without a task serve those that have one (sharing.h): which ones have (a bit each), and how many places each has;
 * for each place its owner and its number, and for each owner the first of its places. */
typedef struct {
  int at_work, places;
  lane_index owner, home;
  mask of_place[TRUM_LANES];
} trum_sharing;
#endif

/* The state of the lanes. */
typedef struct {
  trum_constants constants;
  trum_equation equation;
  trum_region region;
  trum_region_slopes region_slopes;
  trum_tolerances tolerances;
  trum_step_control step;
  trum_step_start start;
  trum_sensitivity sensitivity;
  trum_status_masks status;
  trum_lap lap;
#if TRUM_LANES > 1
  trum_sharing sharing;
#endif
  int hertz;           /* the contact law, of all lanes */
  int slopes;          /* whether sensitivities are wanted */
  trum_record* record; /* of a history, or none */
} trum_lanes;

/* What a build leaves out is a constant 0, so that the compiler leaves out what it would need. */
#define with_slopes(lanes) (TRUM_SLOPES && (lanes)->slopes)
#ifdef TRUM_FIXED_CONTACT
#define with_hertz(lanes) (TRUM_FIXED_CONTACT == TRUM_CONTACT_HERTZ)
#else
#define with_hertz(lanes) ((lanes)->hertz)
#endif

#endif
