/* The stator's surface, the contact and the friction at an instant, from the generated kernels.
 *
 * Wave (eqs. 11, 16, 20), contact of the Winkler layer or of the paper's Hertz width (eqs. 25, 26, 30, 31), net
 * friction fraction in one closed form (eqs. 33 to 37). */
#ifndef TRUM_ORBIT_SURFACE_H
#define TRUM_ORBIT_SURFACE_H

/* The rotation of free motion and drive in a time tau after the region's start. */
static void trum_rotate_phasors(const trum_lanes* lanes, real tau, trum_phasors* turn) {
  trum_lanes_rotation(&lanes->constants, turn, tau);
}

/* Surface and contact at given phasors. */
static void trum_evaluate_wave_and_contact(const trum_lanes* lanes, const trum_phasors* turn, trum_surface* at) {
  trum_lanes_wave(&lanes->constants, &lanes->region, turn, at);
  if (with_hertz(lanes)) {
    trum_lanes_contact_hertz(&lanes->constants, at);
  } else {
    trum_filling_state filling;
    trum_lanes_filling(&lanes->constants, at, &filling);
    filling.fullness_root = cube_root(filling.fullness);
    trum_lanes_contact_winkler(&filling, at);
  }
}

/* Surface and contact at a time tau after the region's start. */
static void trum_evaluate_surface(const trum_lanes* lanes, real tau, trum_surface* at) {
  trum_phasors turn;
  trum_rotate_phasors(lanes, tau, &turn);
  trum_evaluate_wave_and_contact(lanes, &turn, at);
}

/* Friction fraction, its derivative by v, and the larger and smaller of the pressures at the two points as fast as the
 * rotor (ordered, because the two swap where the crest jumps). */
static void trum_evaluate_friction(const trum_surface* at, real v, real* f, real* f_v, real* larger, real* smaller) {
  trum_friction_state friction;
  trum_lanes_friction(at, &friction, v);
  *f = friction.f, *f_v = friction.f_v;
#if TRUM_REAL_BITS == 32 /* the wave begins so small after a start from rest that a float's shares of the pressure cancel */
  *f = maximum(REAL(-1), minimum(REAL(1), *f));
#endif
  *larger = maximum(friction.p_1, friction.p_2), *smaller = minimum(friction.p_1, friction.p_2);
}

#endif
