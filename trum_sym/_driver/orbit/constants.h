/* Constants of the method: step lengths, and the shares of the tolerance that each kind of error may take.
 *
 * The shares are measured: with them the figures meet the tolerance over the domain of docs/rotor.md. */
#ifndef TRUM_ORBIT_CONSTANTS_H
#define TRUM_ORBIT_CONSTANTS_H

/* Step lengths, in drive periods */
static const trum_real trum_max_step = TRUM_C(1.0 / 12.0);
static const trum_real trum_beside_step = TRUM_C(0.02); /* of its length: an extremum at its end may be found so far outside */
static const trum_real trum_max_saturated_step = TRUM_C(1.0 / 30.0); /* where friction is saturated: brief ends are seen */
static const trum_real trum_max_nearly_saturated_step = TRUM_C(1.0 / 120.0);
static const trum_real trum_first_step = TRUM_C(1.0 / 24.0);   /* of a lap */
static const trum_real trum_min_step = TRUM_EITHER(1e-9, 1e-6); /* the shortest that may still be rejected */
static const trum_real trum_min_slow_step = TRUM_EITHER(1e-10, 1e-6); /* likewise where the rotor is slow, */
static const trum_real trum_slow = TRUM_C(1e-3);                     /* by this share of the surface's largest speed */
static const trum_real trum_min_step_for_phase = TRUM_C(2e-4); /* longer ones have to resolve the surface's phase, */
static const trum_real trum_min_phase_cosine = TRUM_C(0.4);    /* by at least this cosine from node to node */
static const trum_real trum_step_safety = TRUM_C(0.8);         /* factor on a new length */
static const trum_real trum_step_growth = TRUM_C(1.5);         /* the most by which a length may grow */

/* Steps with slopes, whose integrands are unbounded at a square root */
static const trum_real trum_min_step_for_slopes = TRUM_C(1e-6);    /* shorter ones' slopes have errors that are mostly rounding */
static const trum_real trum_slope_start_tolerance = TRUM_C(1e-10); /* distance from an event at a step's start, drive periods */
static const trum_real trum_slope_end_tolerance = TRUM_C(1e-15);   /* and at its end */
static const trum_real trum_least_slope = TRUM_C(1e-6);            /* of f and theta by a relative change, that is resolved */
static const trum_real trum_slope_newton_factor = TRUM_C(1e-5);    /* on Newton's tolerance */

/* Shares of the tolerance */
static const trum_real trum_step_share = TRUM_C(0.3);           /* the error of a step, of the tolerance over the drive periods */
static const trum_real trum_coarsest = TRUM_C(1e-3);          /* of the tolerances that steps are chosen by: longer ones miss brief events */
static const trum_real trum_quadrature_share = TRUM_C(0.2);     /* factor on the estimate of a step's quadrature error */
static const trum_real trum_root_share = TRUM_C(0.4);           /* location of an event with a square root, */
static const trum_real trum_kink_share = 100;         /* and with a kink */
static const trum_real trum_newton_share = TRUM_C(0.05);        /* Newton's last change, squared */
static const trum_real trum_repetition_share = TRUM_C(0.3);   /* of periods that are counted and not integrated, of a lap's error */
static const trum_real trum_least_counted = 100; /* drive periods, at least, over which the errors of a long lap's steps add up */
static const trum_real trum_first_lap_tolerance = TRUM_C(1e-2); /* in place of the tolerance, far from the orbit */

/* Coarse laps (coarse.h): steps a drive period; what they may be off by and how near to the orbit is enough, over the largest
 * speed */
static const trum_real trum_first_coarse_steps = 24, trum_coarse_steps = 96;
static const trum_real trum_coarse_error = TRUM_C(1e-3), trum_coarse_enough = TRUM_C(2e-3);
static const int trum_most_coarse_laps = 8;
static const trum_real trum_coarse_stiff = TRUM_C(0.2); /* the exponent of a coarse step from which on friction is stiff in longer ones */

/* By how much, over the largest speed, a lap may begin beside the one before if its segments are to be side by side */
static const trum_real trum_side_by_side_change = TRUM_C(5e-3);
#if TRUM_SEGMENTS > 1
static const trum_real trum_least_jump_share = TRUM_C(5e-4); /* what a jump's change is uncertain by at least */
#endif

/* Limits of the number's type: what is added to a divisor that may be 0, what a number is rounded by, slopes that count as
 * none, friction that counts as saturated, the least that speeds draw together over a lap, a margin's inverse at most, a scale nothing is known of */
static const trum_real trum_tiny = TRUM_EITHER(1e-290, 1e-37);
static const trum_real trum_unit = TRUM_EITHER(1.2e-16, FLT_EPSILON / 2);
static const trum_real trum_no_slope = TRUM_EITHER(1e-200, 1e-30);
static const trum_real trum_all_but_one = TRUM_EITHER(1 - 1e-9, 1 - 8 * FLT_EPSILON);
static const trum_real trum_least_decay = TRUM_EITHER(1e-14, FLT_EPSILON);
static const trum_real trum_most_inverse_margin = TRUM_EITHER(1e100, 1e15);
static const trum_real trum_unmeasured = TRUM_EITHER(1e300, 1e30);

/* Factor of safety on all bounds */
static const trum_real trum_bound_safety = TRUM_EITHER(4, 2); /* in single precision rounding is most of a bound */

/* Errors that are known to the first order in the defects are known but for this share */
static const trum_real trum_first_order_share = TRUM_C(0.25);

/* A step over which speeds draw together by more than this exponent is damped (step.h) */
static const trum_real trum_stiff = 1, trum_stiff_factor = 30; /* and its error weighs more */

/* Limits */
static const int trum_max_laps = 60;
static const trum_real trum_max_steps_per_period = 20000; /* attempts, accepted or not */

#endif
