/* Constants of the method: step lengths, and the shares of the tolerance that each kind of error may take.
 *
 * The shares are measured: with them the figures meet the tolerance over the domain of docs/rotor.md. */
#ifndef TRUM_ORBIT_CONSTANTS_H
#define TRUM_ORBIT_CONSTANTS_H

/* Step lengths, in drive periods */
static const double trum_max_step = 1.0 / 12.0;
static const double trum_max_saturated_step = 1.0 / 30.0; /* where friction is saturated: brief ends must be seen */
static const double trum_max_nearly_saturated_step = 1.0 / 120.0;
static const double trum_first_step = 1.0 / 24.0;   /* of a lap */
static const double trum_min_step = 1e-9;           /* the shortest that may still be rejected */
static const double trum_min_step_for_phase = 2e-4; /* longer ones have to resolve the surface's phase, */
static const double trum_min_phase_cosine = 0.4;    /* by at least this cosine from node to node */
static const double trum_step_safety = 0.8;         /* factor on a new length */
static const double trum_step_growth = 1.5;         /* the most by which a length may grow */

/* Steps with slopes, whose integrands are unbounded at a square root */
static const double trum_min_step_for_slopes = 1e-6;    /* shorter ones' slopes have errors that are mostly rounding */
static const double trum_slope_start_tolerance = 1e-10; /* distance from an event at a step's start, drive periods */
static const double trum_slope_end_tolerance = 1e-15;   /* and at its end */
static const double trum_least_slope = 1e-6;            /* of f and theta by a relative change, that is resolved */
static const double trum_slope_newton_factor = 1e-5;    /* on Newton's tolerance */

/* Shares of the tolerance */
static const double trum_step_share = 0.3;           /* the error of a step, of the tolerance over the drive periods */
static const double trum_coarsest = 1e-3;          /* of the tolerances that steps are chosen by: longer ones miss brief events */
static const double trum_quadrature_share = 0.2;     /* factor on the estimate of a step's quadrature error */
static const double trum_root_share = 0.4;           /* location of an event with a square root, */
static const double trum_kink_share = 100.0;         /* and with a kink */
static const double trum_newton_share = 0.05;        /* Newton's last change, squared */
static const double trum_first_lap_tolerance = 1e-2; /* in place of the tolerance, far from the orbit */

/* What is added to a divisor that may be 0, and what a number is rounded by, in the precision of the kernels */
static const double trum_tiny = sizeof(trum_real) < sizeof(double) ? 1e-37 : 1e-290;
static const double trum_unit = sizeof(trum_real) < sizeof(double) ? 6e-8 : 1.2e-16;

/* Factor of safety on all bounds */
static const double trum_bound_safety = 4.0;

/* Errors that are known to the first order in the defects are known but for this share */
static const double trum_first_order_share = 0.25;

/* A step over which speeds draw together by more than this exponent is damped (step.h) */
static const double trum_stiff = 1.0, trum_stiff_factor = 30.0; /* and its error weighs more */

/* Limits */
static const int trum_max_laps = 60;
static const double trum_max_steps_per_period = 20000.0; /* attempts, accepted or not */

#endif
