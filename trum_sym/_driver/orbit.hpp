// The rotor's periodic orbit over a drive cycle, for blocks of points.  Plain data in and out, so that each
// instruction set compiles its own copy of orbit.inc and a pointer picks one when the module loads.
#pragma once

namespace trum {

enum { flag_converged = 1, flag_full_contact = 2, flag_runaway = 4 };

struct OrbitInput {
  double omega_n, Delta_omega, xi, psi, s, m, n;
  double a_A, b_A, a_B, b_B;  // free motion before t1
  double W, D, k_c, engagement_per_height, W_full, hertz, push, drag;
  double tolerance;
};

// Speeds of the rim, m/s; fractions of the prepressure's friction and of pi.
struct OrbitOutput {
  double mean, low, high, variance, contact, held, start, level, error, flags;
};

struct OrbitCode {
  // Orbits of count points with the same m and n.
  void (*orbits)(const OrbitInput* in, OrbitOutput* out, int count);
  // One cycle of a point's orbit: rim speed, distance since t1, and friction fraction at count equal times after t1.
  void (*history)(const OrbitInput* in, const OrbitOutput* orbit, double* speed, double* distance, double* friction,
                  long count);
  int lanes;
  const char* name;
};

extern const OrbitCode orbit_baseline;
extern const OrbitCode orbit_avx2;
extern const OrbitCode orbit_avx512;

}  // namespace trum
