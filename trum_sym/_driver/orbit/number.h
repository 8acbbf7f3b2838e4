/* The number type of the orbit.
 *
 * Without TRUM_LANES a plain number and one lane; the C++ sources define TRUM_LANES and give `real` (a class of that
 * many points side by side), `mask` (their truth values) and the same operations on them beforehand; `lane_index` and what
 * takes numbers from other lanes; and TRUM_APART, by which a function stays one. */
#ifndef TRUM_ORBIT_NUMBER_H
#define TRUM_ORBIT_NUMBER_H

#ifndef TRUM_LANES
#define TRUM_LANES 1
#define TRUM_APART
#include "trum_kernels.h"
typedef trum_real real;
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
static trum_real lane_value(const real* x, int i) { return (void)i, *x; }
static void set_lane(real* x, int i, trum_real value) { (void)i, *x = value; }
static void set_lane_mask(mask* x, int i, int value) { (void)i, *x = value; }
static real square_root(real a) { return trum_sqrt(a); }
static real cube_root(real a) { return trum_cbrt(a); }
static real reciprocal(real a) { return 1 / a; }
#endif
#ifndef TRUM_SLOPES /* whether the search can give slopes of its figures, which trum.h has none of */
#define TRUM_SLOPES (TRUM_LANES > 1)
#endif
#ifndef TRUM_SEGMENTS /* of a lap that are integrated side by side (segments.h); one: none are */
#define TRUM_SEGMENTS (TRUM_LANES > 1 ? 16 : 1)
#endif
#include "trum_collocation.h"
#include "trum_lane_calls.h"
#include "trum_orbit_fields.h"
#include "trum_plain_calls.h"

#define REAL TRUM_NUMBER

#endif
