/* Constants of the method: step lengths, and the shares of the tolerance that each kind of error may take. */
#ifndef TRUM_ORBIT_CONSTANTS_H
#define TRUM_ORBIT_CONSTANTS_H

/* Step lengths in drive periods: the longest, a lap's first, the shortest that may still be rejected; and the shortest
 * that has to resolve the surface's phase, whose cosine from node to node must not be below this. */
static const double trum_max_step = 1.0 / 24.0, trum_first_step = 1.0 / 24.0, trum_min_step = 1e-9;
static const double trum_min_step_for_phase = 2e-4, trum_min_phase_cosine = 0.4;
/* With slopes, whose integrands are unbounded at a square root: the shortest step, in drive periods, whose slopes'
 * error is measured (below, it is mostly rounding); how near to an event a step may begin and end, in drive periods;
 * the factor on Newton's tolerance. */
static const double trum_min_step_for_slopes = 1e-6, trum_slope_start_tolerance = 1e-10,
                    trum_slope_end_tolerance = 1e-15, trum_slope_newton_factor = 1e-5;
/* Factor of safety on a new step length, and the most by which it may grow. */
static const double trum_step_safety = 0.8, trum_step_growth = 1.5;
/* Shares of the tolerance, measured over the domain: error of the steps per drive period, factor on the quadrature's
 * estimate, location of events with a square root and with a kink, Newton's last change squared. */
static const double trum_step_share = 0.05, trum_quadrature_share = 0.2, trum_root_share = 4.0, trum_kink_share = 100.0,
                    trum_newton_share = 0.05;
/* The tolerance of the first lap, which starts far from the orbit. */
static const double trum_first_lap_tolerance = 1e-2;

#endif
