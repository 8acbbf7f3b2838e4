// Orbits on a grid of equal time steps, for maps at coarse tolerances: each instruction set compiles its own copy.
#pragma once

#include "trum_orbit_fields.h"

namespace trum {

struct GridCode {
  // Orbits of count points of one contact law.  What the grid cannot bound within the tolerance has no flags and no
  // figures: it is left to OrbitCode.
  void (*orbits)(const trum_orbit_in* in, trum_orbit_out* out, long count);
};

extern const GridCode grid_baseline;
extern const GridCode grid_avx2;
extern const GridCode grid_avx512;

}  // namespace trum
