/* The library's number and its mathematics.
 *
 * trum_real is double, or float where all files are compiled with -DTRUM_REAL_BITS=32; every number of kernels and drivers is
 * one, every constant TRUM_C(x), as UINT32_C(x) is of uint32_t, and a limit that the precision sets is TRUM_EITHER(of
 * double, of float).  Functions are called by the type's own names (sqrt or sqrtf), so nothing here needs tgmath.h.
 * Compilers that cannot keep this are refused. */
#ifndef TRUM_MATH_H
#define TRUM_MATH_H

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>

#ifdef casadi_real
#error "trum: choose the type of number by TRUM_REAL_BITS, 64 or 32, not by casadi_real"
#endif
#ifndef TRUM_REAL_BITS
#define TRUM_REAL_BITS 64
#endif
#if FLT_RADIX != 2
#error "trum: numbers have to be binary"
#endif

#if TRUM_REAL_BITS == 64
#if DBL_MANT_DIG != 53 || DBL_MAX_EXP != 1024
#error "trum: double is no 64-bit number here (a C28x with COFF?): compile all files with -DTRUM_REAL_BITS=32"
#endif
typedef double trum_real;
#define TRUM_EITHER(of_double, of_float) ((trum_real)(of_double))
#define TRUM_MATH(name) name
#define TRUM_HUGE HUGE_VAL
#elif TRUM_REAL_BITS == 32
#if FLT_MANT_DIG != 24 || FLT_MAX_EXP != 128
#error "trum: float is no 32-bit number here"
#endif
typedef float trum_real;
#define TRUM_EITHER(of_double, of_float) ((trum_real)(of_float))
#define TRUM_MATH(name) name##f
#define TRUM_HUGE HUGE_VALF
#else
#error "trum: TRUM_REAL_BITS has to be 64 or 32"
#endif

/* The size is negative, and the compiler stops, where a type is not as wide as its name says. */
typedef char trum_real_has_other_bits_than_TRUM_REAL_BITS[sizeof(trum_real) * CHAR_BIT == TRUM_REAL_BITS ? 1 : -1];

#define TRUM_C(x) ((trum_real)(x))
#define TRUM_NAN TRUM_C(NAN)
/* Tolerances of an operating point that this type can keep */
#define TRUM_FINEST_TOLERANCE TRUM_EITHER(1e-9, 1e-3)
#define TRUM_COARSEST_TOLERANCE TRUM_C(1e-2)
/* Periods of a drive cycle up to which each is integrated; of more, those that repeat others are counted (orbit/repeat.h) */
#ifndef TRUM_REPEATS_BEYOND
#define TRUM_REPEATS_BEYOND 10000
#endif
/* 1 or 0 */
#define TRUM_LESS(a, b) (((a) < (b)) ? TRUM_C(1.0) : TRUM_C(0.0))

#define trum_sqrt(x) TRUM_MATH(sqrt)(x)
#define trum_cbrt(x) TRUM_MATH(cbrt)(x)
#define trum_sin(x) TRUM_MATH(sin)(x)
#define trum_cos(x) TRUM_MATH(cos)(x)
#define trum_atan(x) TRUM_MATH(atan)(x)
#define trum_atan2(y, x) TRUM_MATH(atan2)((y), (x))
#define trum_exp(x) TRUM_MATH(exp)(x)
#define trum_expm1(x) TRUM_MATH(expm1)(x)
#define trum_sinh(x) TRUM_MATH(sinh)(x)
#define trum_cosh(x) TRUM_MATH(cosh)(x)
#define trum_log(x) TRUM_MATH(log)(x)
#define trum_pow(x, y) TRUM_MATH(pow)((x), (y))
#define trum_fabs(x) TRUM_MATH(fabs)(x)
#define trum_floor(x) TRUM_MATH(floor)(x)
#define trum_ceil(x) TRUM_MATH(ceil)(x)
#if TRUM_REAL_BITS == 64
#define trum_fmin(x, y) fmin((x), (y))
#define trum_fmax(x, y) fmax((x), (y))
#else /* as fminf and fmaxf, which embedded libraries make 60 instructions of */
static inline float trum_fmin(float x, float y) { return ((x < y) || (y != y)) ? x : y; }
static inline float trum_fmax(float x, float y) { return ((x > y) || (y != y)) ? x : y; }
#endif

#endif
