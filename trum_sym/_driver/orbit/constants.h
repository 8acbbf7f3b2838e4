/* Constants of the method: step lengths, and the shares of the tolerance that each kind of error may take. */
#ifndef TRUM_ORBIT_CONSTANTS_H
#define TRUM_ORBIT_CONSTANTS_H

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

#endif
