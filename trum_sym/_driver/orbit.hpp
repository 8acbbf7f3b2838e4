// The rotor's periodic orbit and the determinants' sums, for blocks of points: each instruction set compiles its own
// copy, and a pointer picks one when the module loads.
#pragma once

#include "trum_orbit_fields.h"

namespace trum {

struct OrbitCode {
  // Orbits of count points of one contact law, and the slopes of their figures unless those pointers are null.
  void (*orbits)(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in, trum_slopes_out* slopes,
                 long count);
  // One cycle of a point's orbit: rim speed and distance since t1 at count equal times after t1.
  void (*history)(const trum_orbit_in* in, const trum_orbit_out* orbit, double* speed, double* distance,
                  long count);
  // Sums of the determinants of count cycles.
  void (*sums)(const trum_cycle_sums_in* in, trum_cycle_sums_out* out, long count);
  // For benchmarks: count steps of wave, contact and friction (0), or of one operation of a step (1 and on).
  double (*steps)(int operation, long count);
  int lanes;
  const char* name;
};

extern const OrbitCode orbit_baseline;
extern const OrbitCode orbit_avx2;
extern const OrbitCode orbit_avx512;

}  // namespace trum
