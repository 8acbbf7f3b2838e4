/* The number type of the orbit.
 *
 * Without TRUM_LANES a plain number and one lane; the C++ sources define TRUM_LANES and give `real` (a class of that
 * many points side by side), `mask` (their truth values) and the same operations on them beforehand. */
#ifndef TRUM_ORBIT_NUMBER_H
#define TRUM_ORBIT_NUMBER_H

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
static mask mask_not(mask a) { return !a; }
static mask mask_all(int a) { return a; }
static int any_lane(mask a) { return a; }
static int mask_in_lane(mask a, int i) { return i == 0 && a; }
static real where(mask m, real a, real b) { return m ? a : b; }
static mask where_mask(mask m, mask a, mask b) { return m ? a : b; }
static real minimum(real a, real b) { return a < b ? a : b; }
static real maximum(real a, real b) { return a > b ? a : b; }
static real absolute(real a) { return a < 0 ? -a : a; }
static double lane_value(const real* x, int i) { return (void)i, (double)*x; }
static void set_lane(real* x, int i, double value) { (void)i, *x = (real)value; }
static void set_lane_mask(mask* x, int i, int value) { (void)i, *x = value; }
static real square_root(real a) { return (real)sqrt((double)a); }
static real cube_root(real a) { return (real)cbrt((double)a); }
static real reciprocal(real a) { return 1 / a; }
#endif
#include "trum_collocation.h"
#include "trum_lane_calls.h"
#include "trum_orbit_fields.h"
#include "trum_plain_calls.h"

#define REAL TRUM_NUMBER

#endif
