/* The stator's surface, the contact and the friction at an instant, from the generated kernels (eqs. 11 to 37). */
#ifndef TRUM_ORBIT_SURFACE_H
#define TRUM_ORBIT_SURFACE_H

static void trum_turn(const trum_lanes* l, real tau, trum_phasors* turn) {
  trum_lanes_rotation(&l->constants, turn, tau);
}

/* The surface once the phasors have turned. */
static void trum_see(const trum_lanes* l, const trum_phasors* turn, trum_surface* at) {
  trum_lanes_wave(&l->constants, &l->region, turn, at);
  if (l->hertz) {
    trum_lanes_contact_hertz(&l->constants, at);
  } else {
    trum_filling_state filling;
    trum_lanes_filling(&l->constants, at, &filling);
    filling.fullness_root = cube_root_of(filling.fullness);
    trum_lanes_contact_winkler(&filling, at);
  }
}

static void trum_look(const trum_lanes* l, real tau, trum_surface* at) {
  trum_phasors turn;
  trum_turn(l, tau, &turn);
  trum_see(l, &turn, at);
}

/* Friction fraction, its slope, and the larger and smaller pressure at the points as fast as the rotor: where the crest
 * jumps, those two points swap. */
static void trum_rub(const trum_surface* at, real v, real* f, real* f_v, real* larger, real* smaller) {
  trum_friction_state friction;
  trum_lanes_friction(at, &friction, v);
  *f = friction.f, *f_v = friction.f_v;
  *larger = most(friction.p_1, friction.p_2), *smaller = least(friction.p_1, friction.p_2);
}

#endif
