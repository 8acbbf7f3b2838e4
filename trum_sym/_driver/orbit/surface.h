/* The stator's surface, the contact and the friction at an instant, from the generated kernels.
 *
 * Wave (eqs. 11, 16, 20), contact of the Winkler layer or of the paper's Hertz width (eqs. 25, 26, 30, 31), net
 * friction fraction in one closed form (eqs. 33 to 37). */
#ifndef TRUM_ORBIT_SURFACE_H
#define TRUM_ORBIT_SURFACE_H

/* Surface and contact at given phasors. */
static void trum_wave_and_contact(const trum_constants* constants, const trum_region* region, int hertz,
                                  const trum_phasors* turn, trum_surface* at) {
  trum_lanes_wave(constants, region, turn, at);
  if (hertz) {
    trum_lanes_contact_hertz(constants, at);
  } else {
    trum_filling_state filling;
    trum_lanes_filling(constants, at, &filling);
    filling.fullness_root = cube_root(filling.fullness);
    trum_lanes_contact_winkler(&filling, at);
  }
}

/* Surface and contact at a time tau after the region's start. */
TRUM_APART static void trum_surface_at(const trum_constants* constants, const trum_region* region, int hertz, real tau,
                                       trum_surface* at) {
  trum_phasors turn;
  trum_lanes_rotation(constants, &turn, tau);
  trum_wave_and_contact(constants, region, hertz, &turn, at);
}

/* Friction fraction, its derivative by v, and the pressures at the two points as fast as the rotor. */
TRUM_APART static void trum_friction_at(const trum_surface* at, real v, trum_friction_state* friction) {
  trum_lanes_friction(at, friction, v);
#if TRUM_REAL_BITS == 32 /* the wave begins so small after a start from rest that a float's shares of the pressure cancel */
  friction->f = maximum(REAL(-1), minimum(REAL(1), friction->f));
#endif
}

/* The larger and the smaller of the two pressures: ordered, because the two swap where the crest jumps. */
static real trum_larger_pressure(const trum_friction_state* friction) { return maximum(friction->p_1, friction->p_2); }
static real trum_smaller_pressure(const trum_friction_state* friction) { return minimum(friction->p_1, friction->p_2); }

#endif
