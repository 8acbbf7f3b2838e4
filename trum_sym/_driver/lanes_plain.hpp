// Vector and Bits of lanes.hpp for a compiler without vector types: arrays of LANES numbers, each operated on by itself,
// in the same order as there.

template <class Number>
struct Array {
  Number at[LANES];
  Number operator[](int i) const { return at[i]; }
  Number& operator[](int i) { return at[i]; }
};

struct Bits : Array<long long> {
  Bits() = default;
  Bits(long long x) { for (long long& lane : at) lane = x; }
};
struct Vector : Array<double> {
  Vector() = default;
  Vector(double x) { for (double& lane : at) lane = x; }
  explicit Vector(Bits bits) { memcpy(at, bits.at, sizeof at); }
  explicit operator Bits() const {
    Bits bits;
    memcpy(bits.at, at, sizeof at);
    return bits;
  }
};

#define TRUM_BY_LANE(Result, Of, op, value) \
  inline Result operator op(Of a, Of b) { \
    Result result; \
    for (int i = 0; i < LANES; ++i) result[i] = value; \
    return result; \
  }
#define TRUM_NUMBERS(Of, op) TRUM_BY_LANE(Of, Of, op, a[i] op b[i])
#define TRUM_TRUTH(Of, op) TRUM_BY_LANE(Bits, Of, op, a[i] op b[i] ? -1 : 0)
TRUM_NUMBERS(Vector, +) TRUM_NUMBERS(Vector, -) TRUM_NUMBERS(Vector, *) TRUM_NUMBERS(Vector, /)
TRUM_NUMBERS(Bits, +) TRUM_NUMBERS(Bits, *) TRUM_NUMBERS(Bits, &) TRUM_NUMBERS(Bits, |) TRUM_NUMBERS(Bits, ^)
TRUM_TRUTH(Vector, <) TRUM_TRUTH(Vector, >) TRUM_TRUTH(Vector, <=) TRUM_TRUTH(Vector, >=)
TRUM_TRUTH(Bits, ==) TRUM_TRUTH(Bits, !=)
// shifts as of unsigned numbers, and to the right with the sign
TRUM_BY_LANE(Bits, Bits, <<, static_cast<long long>(static_cast<unsigned long long>(a[i]) << b[i]))
TRUM_BY_LANE(Bits, Bits, >>, a[i] >> b[i])
#undef TRUM_TRUTH
#undef TRUM_NUMBERS
#undef TRUM_BY_LANE

inline Vector operator-(Vector a) {
  for (double& lane : a.at) lane = -lane;
  return a;
}
inline Bits operator~(Bits a) {
  for (long long& lane : a.at) lane = ~lane;
  return a;
}
inline Bits& operator|=(Bits& a, Bits b) { return a = a | b; }
inline Bits& operator&=(Bits& a, Bits b) { return a = a & b; }
inline Vector either(Bits mask, Vector a, Vector b) {
  for (int i = 0; i < LANES; ++i) a[i] = mask[i] ? a[i] : b[i];
  return a;
}
