// Laps of phases, contact and rotor: each instruction set compiles its own copy, and a pointer picks one when the module
// loads.
#pragma once

#include "trum_orbit_fields.h"

namespace trum {

// Rows of a lap's slopes (its end state and the mean speed) and columns (the state at its start).
enum { coupled_rows = 8, coupled_columns = 7 };

// A lap and, unless that is null, its slopes.
typedef void (*CoupledLap)(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, double* slopes);

void coupled_baseline(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, double* slopes);
void coupled_avx2(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, double* slopes);
void coupled_avx512(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, double* slopes);

}  // namespace trum
