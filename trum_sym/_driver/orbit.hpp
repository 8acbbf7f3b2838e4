// The rotor's periodic orbit and the determinants' sums, for blocks of points: plain doubles in and out, in the order of trum_orbit.h, so that
// each instruction set compiles its own copy and a pointer picks one when the module loads.
#pragma once

namespace trum {

struct OrbitCode {
  // Orbits of count points of one contact law, and the slopes of their figures unless those pointers are null.
  void (*orbits)(const double* in, double* out, const double* slopes_in, double* slopes, long count);
  // One cycle of a point's orbit: rim speed and distance since t1 at count equal times after t1.
  void (*history)(const double* in, const double* orbit, double* speed, double* distance, long count);
  // Sums of the determinants of count cycles: 12 doubles each (omega_n Delta_omega xi psi s m n a_A b_A a_B b_B and
  // panels in a period), 4 back.
  void (*sums)(const double* in, double* out, long count);
  // For benchmarks: count steps of wave, contact and friction (0), or of one operation of a step (1 and on).
  double (*steps)(int operation, long count);
  int lanes;
  const char* name;
};

extern const OrbitCode orbit_baseline;
extern const OrbitCode orbit_avx2;
extern const OrbitCode orbit_avx512;

}  // namespace trum
