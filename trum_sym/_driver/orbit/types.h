/* What the orbit's functions pass to each other: a point's input and output, a lap's sums, the lanes' state. */
#ifndef TRUM_ORBIT_TYPES_H
#define TRUM_ORBIT_TYPES_H

enum { FIGURES = TRUM_SLOPE_FIGURES_COUNT, PARAMETERS = TRUM_SLOPES ? TRUM_SLOPE_PARAMETERS_COUNT : 1 };
enum { TRUM_MOST_SEGMENTS = TRUM_SEGMENTS > 1 ? TRUM_SEGMENTS + TRUM_REGIONS : TRUM_REGIONS };
enum { LAST_NODE = TRUM_COLLOCATION_NODES - 1, NODES = TRUM_COLLOCATION_NODES, CHECKS = 3 };

/* Glossary.
 *
 *   region       one of the three parts of a drive cycle, between switchings of the phases' gates (Sect. 3)
 *   lap          the rotor's motion over one drive cycle from a start speed
 *   orbit        the lap that ends at the speed at which it started
 *   segment      a part of a lap, between two instants; a lap's segments may be integrated side by side (segments.h)
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

/* Sums of a lap so far: over time from its start, */
#define TRUM_LAP_INTEGRALS(X) \
  X(x) X(xx) X(S) X(xS) X(SS) /* of x, x^2, S, x S and S^2, */ \
  X(friction) X(angle)        /* of f and theta, */ \
  /* of the error, its square and its product with S, of the remainder and its square (defect.h), of the interpolants' error \
   * inside the steps, of the share of an error that is kept; errors and remainders of the integrals of f and theta */ \
  X(error_sum) X(error_square) X(error_S) X(remainder_sum) X(remainder_square) X(inside) X(kept_sum) \
  X(friction_error) X(friction_remainder) X(angle_error) X(angle_remainder)

/* and what holds where it is now, or was seen so far */
#define TRUM_LAP_STATES(X) \
  X(low) X(high) X(S_low) X(S_high) /* lowest and highest x, and S there */ \
  X(full_contact) X(fastest)        /* 1 if ever in full contact; largest surface speed */ \
  X(stiffest)                       /* the largest exponent by which speeds were drawn together in a step */ \
  X(nearness) /* sum of S (S/m)^2, m changes of speed that have saturation begin or end for a moment, 1/(m/s)^2 */ \
  /* first-order error of x by the steps' defects, bound of what it leaves out, share of an error at the start that is kept \
   * (of a long schedule since a watched period began, repeat.h); errors and remainders at the extremes */ \
  X(error) X(remainder) X(kept) X(low_error) X(low_remainder) X(high_error) X(high_remainder) \
  X(lowest) X(highest) /* bounds of x at all extremes, those that are not the lap's by a hair too */

/* Sensitivities of all of these: integrals of dx and x dx; of the extremes; of the integrals of f and theta at fixed speed,
 * and the sums of the latter two's magnitudes, step by step. */
#define TRUM_LAP_SLOPES(X) \
  X(d_x) X(d_xx) X(d_low) X(d_high) X(d_friction) X(d_angle) X(sum_abs_friction) X(sum_abs_angle)

/* Those of the laps in the lanes. */
typedef struct {
#define TRUM_MEMBER(name) real name;
  TRUM_LAP_INTEGRALS(TRUM_MEMBER) TRUM_LAP_STATES(TRUM_MEMBER)
#undef TRUM_MEMBER
#define TRUM_MEMBER(name) real name[PARAMETERS];
  TRUM_LAP_SLOPES(TRUM_MEMBER)
#undef TRUM_MEMBER
} trum_lap;

/* Those of one lap, or of a segment of it, with x, S, the length of steps that errors allow and the sensitivities where it
 * ends. */
typedef struct {
#define TRUM_MEMBER(name) trum_real name;
  TRUM_LAP_INTEGRALS(TRUM_MEMBER) TRUM_LAP_STATES(TRUM_MEMBER) TRUM_MEMBER(end) TRUM_MEMBER(growth) TRUM_MEMBER(step)
#undef TRUM_MEMBER
#define TRUM_MEMBER(name) trum_real name[PARAMETERS];
  TRUM_LAP_SLOPES(TRUM_MEMBER) TRUM_MEMBER(d_end)
#undef TRUM_MEMBER
} trum_lap_sums;

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
