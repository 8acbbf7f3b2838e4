// A value class over LANES points, on which the generated C runs unmodified.  Every operation acts on each lane
// alone and in the same order whatever the width (one register of the instruction set: GCC breaks wider ones up), so a result does not depend on the width or on its neighbours.
// Include inside a namespace of its own, with LANES defined.

// plain numbers keep their own functions
using ::atan2;
using ::cos;
using ::exp;
using ::expm1;
using ::fabs;
using ::fmax;
using ::fmin;
using ::sin;
using ::sqrt;

// TRUM_PLAIN_LANES: without the vector types of GCC and Clang; on for a compiler that has none.
#if !defined(__GNUC__) && !defined(__clang__) && !defined(TRUM_PLAIN_LANES)
#define TRUM_PLAIN_LANES
#endif
#if defined(TRUM_PLAIN_LANES)
#include "lanes_plain.hpp"
#else
typedef double Vector __attribute__((vector_size(8 * LANES)));
typedef long long Bits __attribute__((vector_size(8 * LANES)));
inline Vector either(Bits mask, Vector a, Vector b) { return mask ? a : b; }
#endif

struct Lane {
  Vector v;
  Lane() = default;
  Lane(Vector vector) : v(vector) {}
  Lane(double x) : v(x - Vector{}) {}
  Lane(int x) : Lane(static_cast<double>(x)) {}
  double operator[](int i) const { return v[i]; }
  void set(int i, double x) { v[i] = x; }
};

inline Lane operator+(Lane a, Lane b) { return a.v + b.v; }
inline Lane operator-(Lane a, Lane b) { return a.v - b.v; }
inline Lane operator*(Lane a, Lane b) { return a.v * b.v; }
inline Lane operator/(Lane a, Lane b) { return a.v / b.v; }
inline Lane operator-(Lane a) { return -a.v; }
inline Lane& operator+=(Lane& a, Lane b) { return a = a + b; }

inline Lane one_where(Bits mask) { return (Vector)(mask & (Bits)Lane(1.0).v); }
inline Lane operator<(Lane a, Lane b) { return one_where(a.v < b.v); }

inline Lane select(Bits mask, Lane a, Lane b) { return either(mask, a.v, b.v); }

inline Lane fabs(Lane a) { return (Vector)((Bits)a.v & ~(Bits)Lane(-0.0).v); }
#if defined(__AVX512F__) && !defined(TRUM_PLAIN_LANES)
static_assert(LANES == 8, "one register of lanes");
inline Lane sqrt(Lane a) { return (Vector)_mm512_sqrt_pd((__m512d)a.v); }
inline Lane fmin(Lane a, Lane b) { return (Vector)_mm512_min_pd((__m512d)a.v, (__m512d)b.v); }
inline Lane fmax(Lane a, Lane b) { return (Vector)_mm512_max_pd((__m512d)a.v, (__m512d)b.v); }
// 1/a to the last digits, without the divider's wait; a must be finite and not 0.
inline Lane reciprocal(Lane a) {
  const Lane r = (Vector)_mm512_rcp14_pd((__m512d)a.v), s = r + r * (Lane(1.0) - a * r);
  return s + s * (Lane(1.0) - a * s);
}
#elif defined(__AVX2__) && !defined(TRUM_PLAIN_LANES)
static_assert(LANES == 4, "one register of lanes");
inline Lane sqrt(Lane a) { return (Vector)_mm256_sqrt_pd((__m256d)a.v); }
inline Lane fmin(Lane a, Lane b) { return (Vector)_mm256_min_pd((__m256d)a.v, (__m256d)b.v); }
inline Lane fmax(Lane a, Lane b) { return (Vector)_mm256_max_pd((__m256d)a.v, (__m256d)b.v); }
inline Lane reciprocal(Lane a) { return Lane(1.0) / a; }
inline bool any_lane(Bits mask) { return _mm256_movemask_pd((__m256d)mask) != 0; }
#else
inline Lane fmin(Lane a, Lane b) { return select(a.v < b.v, a, b); }
inline Lane fmax(Lane a, Lane b) { return select(a.v > b.v, a, b); }
inline Lane sqrt(Lane a) {
  Lane root;
  for (int i = 0; i < LANES; ++i) root.v[i] = ::sqrt(a.v[i]);
  return root;
}
inline Lane reciprocal(Lane a) { return Lane(1.0) / a; }
inline bool any_lane(Bits mask) {
  long long found = 0;
  for (int i = 0; i < LANES; ++i) found |= mask[i];
  return found != 0;
}
#endif

// Even and odd powers apart: two short chains of operations instead of a long one.
template <int n>
inline Lane polynomial(const double (&c)[n], Lane x) {
  const Lane q = x * x;
  Lane first = c[n - 1], second = c[n - 2];
  for (int k = n - 3; k >= 0; k -= 2) {
    first = first * q + c[k];
    if (k > 0) second = second * q + c[k - 1];
  }
  return n % 2 == 1 ? first + x * second : second + x * first;
}

// sin and cos of moderate arguments: quarter turns off in two parts, then the polynomial of the quadrant.
struct Turn {
  Lane sine, cosine;
  Bits quadrant;
};
inline Turn quarter_turn(Lane x) {
  static constexpr double sine[] = TRUM_SIN_COEFFICIENTS, cosine[] = TRUM_COS_COEFFICIENTS;
  const double magic = 6755399441055744.0;
  const Lane shifted = x * Lane(0.63661977236758134308) + Lane(magic);
  const Lane n = shifted - Lane(magic);
  const Lane r = (x - n * Lane(1.5707963267948965580)) - n * Lane(6.1232339957367658e-17);
  const Lane q = r * r;
  return {r * polynomial(sine, q), polynomial(cosine, q), (Bits)shifted.v};
}
inline Lane sin(Lane x) {
  const Turn t = quarter_turn(x);
  const Lane value = select((t.quadrant & 1) == 1, t.cosine, t.sine);
  return select((t.quadrant & 2) == 2, -value, value);
}
inline Lane cos(Lane x) {
  const Turn t = quarter_turn(x);
  const Lane value = select((t.quadrant & 1) == 1, t.sine, t.cosine);
  return select(((t.quadrant + 1) & 2) == 2, -value, value);
}

inline Lane atan2(Lane y, Lane x) {
  static constexpr double coefficients[] = TRUM_ATAN_COEFFICIENTS;
  const Lane ax = fabs(x), ay = fabs(y), low = fmin(ax, ay), high = fmax(ax, ay);
  const Bits steep = ay.v > ax.v;
  const Bits upper = low.v > (high * Lane(0.41421356237309504880)).v;
  const Lane u = select(upper, low - high, low) / (select(upper, low + high, high) + Lane(1e-300));
  Lane angle = u * polynomial(coefficients, u * u);
  angle = select(upper, angle + Lane(0.78539816339744830962), angle);
  angle = select(steep, Lane(1.57079632679489661923) - angle, angle);
  angle = select(x.v < Vector{}, Lane(3.14159265358979323846) - angle, angle);
  return select(y.v < Vector{}, -angle, angle);
}

inline Lane exp(Lane x) {
  static constexpr double coefficients[] = TRUM_EXP_COEFFICIENTS;
  const double magic = 6755399441055744.0;
  const Lane bounded = fmax(x, Lane(-700.0));
  const Lane shifted = bounded * Lane(1.4426950408889634074) + Lane(magic);
  const Lane n = shifted - Lane(magic);
  const Lane r = (bounded - n * Lane(0.69314718055994528623)) - n * Lane(2.3190468138462995584e-17);
  return (Vector)((Bits)polynomial(coefficients, r).v + ((Bits)shifted.v << 52));
}

// exp(x) - 1, as exact near 0.
inline Lane expm1(Lane x) {
  static constexpr double coefficients[] = TRUM_EXPM1_COEFFICIENTS;
  const double magic = 6755399441055744.0;
  const Lane bounded = fmax(x, Lane(-700.0));
  const Lane shifted = bounded * Lane(1.4426950408889634074) + Lane(magic);
  const Lane n = shifted - Lane(magic);
  const Lane r = (bounded - n * Lane(0.69314718055994528623)) - n * Lane(2.3190468138462995584e-17);
  const Lane scale = (Vector)((Bits)Lane(1.0).v + ((Bits)shifted.v << 52));
  return scale * (r * polynomial(coefficients, r)) + (scale - Lane(1.0));
}

// Cube root of a positive number to 1e-4: a first guess is all that it serves as.
inline Lane cube_root(Lane t) {
  const Bits high = (Bits)t.v >> 32;
  const Bits third = ((high * 0x55555556LL) >> 32) + 0x2A9F7893LL;
  const Lane r = (Vector)(third << 32), cube = r * r * r;
  return r * (cube + t + t) / (cube + cube + t);
}

// What trum_orbit.h asks of numbers and of their truth values, which AVX-512 keeps in registers of one bit a lane.
#if defined(__AVX512F__) && !defined(TRUM_PLAIN_LANES)
typedef __mmask8 Mask;
inline Mask less_than(Lane a, Lane b) { return _mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_LT_OQ); }
inline Mask at_most(Lane a, Lane b) { return _mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_LE_OQ); }
inline Mask mask_not(Mask a) { return static_cast<Mask>(~a); }
inline Mask mask_all(int a) { return a ? 0xff : 0; }
inline int mask_in_lane(Mask a, int i) { return a >> i & 1; }
inline Lane where(Mask m, Lane a, Lane b) { return (Vector)_mm512_mask_blend_pd(m, (__m512d)b.v, (__m512d)a.v); }
inline Mask where_mask(Mask m, Mask a, Mask b) { return static_cast<Mask>((m & a) | (~m & b)); }
inline bool any_lane(Mask m) { return m != 0; }
inline void set_lane_mask(Mask* x, int i, int value) {
  *x = static_cast<Mask>(value ? *x | 1 << i : *x & ~(1 << i));
}
#else
typedef Bits Mask;
inline Mask less_than(Lane a, Lane b) { return a.v < b.v; }
inline Mask at_most(Lane a, Lane b) { return a.v <= b.v; }
inline Mask mask_not(Mask a) { return ~a; }
inline Mask mask_all(int a) { return a ? ~Mask{} : Mask{}; }
inline int mask_in_lane(Mask a, int i) { return a[i] != 0; }
inline Lane where(Mask m, Lane a, Lane b) { return select(m, a, b); }
inline Mask where_mask(Mask m, Mask a, Mask b) { return (m & a) | (~m & b); }
inline void set_lane_mask(Mask* x, int i, int value) { (*x)[i] = value ? -1 : 0; }
#endif
inline Lane minimum(Lane a, Lane b) { return fmin(a, b); }
inline Lane maximum(Lane a, Lane b) { return fmax(a, b); }
inline Lane absolute(Lane a) { return fabs(a); }
inline Lane square_root(Lane a) { return sqrt(a); }
inline double lane_value(const Lane* x, int i) { return x->v[i]; }
inline void set_lane(Lane* x, int i, double value) { x->v[i] = value; }

// Numbers of other lanes: lane i of the result is lane from[i] of a.
inline Bits lane_numbers() {
  Bits numbers;
  for (int i = 0; i < LANES; ++i) numbers[i] = i;
  return numbers;
}
inline void set_lane_number(Bits* x, int i, int value) { (*x)[i] = value; }
#if defined(__AVX512F__) && !defined(TRUM_PLAIN_LANES)
inline Lane taken_from(Lane a, Bits from) { return (Vector)_mm512_permutexvar_pd((__m512i)from, (__m512d)a.v); }
#elif defined(__AVX2__) && !defined(TRUM_PLAIN_LANES)
inline Lane taken_from(Lane a, Bits from) {  // halves of numbers are what can be moved
  const Bits halves = (from << 1) + (from << 33) + (1LL << 32);
  return (Vector)_mm256_permutevar8x32_ps((__m256)a.v, (__m256i)halves);
}
#else
inline Lane taken_from(Lane a, Bits from) {
  Lane taken;
  for (int i = 0; i < LANES; ++i) taken.v[i] = a.v[from[i]];
  return taken;
}
#endif
