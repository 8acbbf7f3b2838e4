/* The stator's surface, the contact and the friction at an instant, from the generated kernels (eqs. 11 to 37). */
#ifndef TRUM_ORBIT_SURFACE_H
#define TRUM_ORBIT_SURFACE_H

static void trum_turn(const trum_lanes* l, real tau, real* turn) {
  const real* arg[trum_rotation_n_arg];
  real* res[trum_rotation_n_res];
  int k;
  arg[trum_rotation_in_Delta_omega] = &l->Delta_omega, arg[trum_rotation_in_omega_n] = &l->omega_n;
  arg[trum_rotation_in_tau] = &tau, arg[trum_rotation_in_xi] = &l->xi;
  for (k = 0; k < 4; ++k) res[k] = &turn[k];
  TRUM_KERNEL(trum_rotation)(arg, res, 0, 0, 0);
}

/* The surface once the phasors have turned. */
static void trum_see(const trum_lanes* l, const real* turn, trum_surface* at) {
  {
    const real* arg[trum_wave_n_arg];
    real* res[trum_wave_n_res];
    arg[trum_wave_in_omega_n] = &l->omega_n, arg[trum_wave_in_Delta_omega] = &l->Delta_omega;
    arg[trum_wave_in_xi] = &l->xi, arg[trum_wave_in_s] = &l->s, arg[trum_wave_in_W] = &l->W;
    arg[trum_wave_in_D] = &l->D, arg[trum_wave_in_k_c] = &l->k_c;
    arg[trum_wave_in_f_A_re] = &l->free_[0], arg[trum_wave_in_f_A_im] = &l->free_[1];
    arg[trum_wave_in_f_B_re] = &l->free_[2], arg[trum_wave_in_f_B_im] = &l->free_[3];
    arg[trum_wave_in_p_re] = &l->drive_re, arg[trum_wave_in_p_im] = &l->drive_im;
    arg[trum_wave_in_e_re] = &turn[0], arg[trum_wave_in_e_im] = &turn[1];
    arg[trum_wave_in_d_re] = &turn[2], arg[trum_wave_in_d_im] = &turn[3];
    arg[trum_wave_in_g_A] = &l->g_A, arg[trum_wave_in_g_B] = &l->g_B;
    res[trum_wave_out_W_c] = &at->W_c, res[trum_wave_out_R_v] = &at->R_v, res[trum_wave_out_phi] = &at->phi;
    res[trum_wave_out_cos_phi] = &at->cos_phi, res[trum_wave_out_sin_phi] = &at->sin_phi;
    TRUM_KERNEL(trum_wave)(arg, res, 0, 0, 0);
  }
  if (l->hertz) {
    const real* arg[trum_contact_hertz_n_arg];
    real* res[trum_contact_hertz_n_res];
    arg[trum_contact_hertz_in_W_c] = &at->W_c, arg[trum_contact_hertz_in_W_full] = &l->W_full;
    res[trum_contact_hertz_out_theta] = &at->theta, res[trum_contact_hertz_out_sin_theta] = &at->sin_theta;
    res[trum_contact_hertz_out_share] = &at->share, res[trum_contact_hertz_out_engagement] = &at->engagement;
    TRUM_KERNEL(trum_contact_hertz)(arg, res, 0, 0, 0);
  } else {
    real fullness, fullness_root;
    const real* arg[trum_contact_winkler_n_arg];
    real* res[trum_contact_winkler_n_res];
    {
      const real* arg_[trum_filling_n_arg];
      real* res_[trum_filling_n_res];
      arg_[trum_filling_in_W_c] = &at->W_c;
      arg_[trum_filling_in_engagement_per_height] = &l->engagement_per_height;
      res_[trum_filling_out_engagement] = &at->engagement, res_[trum_filling_out_fullness] = &fullness;
      TRUM_KERNEL(trum_filling)(arg_, res_, 0, 0, 0);
    }
    fullness_root = cube_root_of(fullness);
    arg[trum_contact_winkler_in_fullness] = &fullness, arg[trum_contact_winkler_in_fullness_root] = &fullness_root;
    res[trum_contact_winkler_out_theta] = &at->theta, res[trum_contact_winkler_out_sin_theta] = &at->sin_theta;
    res[trum_contact_winkler_out_share] = &at->share;
    TRUM_KERNEL(trum_contact_winkler)(arg, res, 0, 0, 0);
  }
}

static void trum_look(const trum_lanes* l, real tau, trum_surface* at) {
  real turn[4];
  trum_turn(l, tau, turn);
  trum_see(l, turn, at);
}

/* Friction fraction, its slope, and the larger and smaller pressure at the points as fast as the rotor: where the crest
 * jumps, those two points swap. */
static void trum_rub(const trum_surface* at, real v, real* f, real* f_v, real* larger, real* smaller) {
  real p_1, p_2;
  const real* arg[trum_friction_n_arg];
  real* res[trum_friction_n_res];
  arg[trum_friction_in_R_v] = &at->R_v, arg[trum_friction_in_phi] = &at->phi;
  arg[trum_friction_in_cos_phi] = &at->cos_phi, arg[trum_friction_in_sin_phi] = &at->sin_phi;
  arg[trum_friction_in_engagement] = &at->engagement, arg[trum_friction_in_share] = &at->share;
  arg[trum_friction_in_theta] = &at->theta, arg[trum_friction_in_sin_theta] = &at->sin_theta;
  arg[trum_friction_in_v] = &v;
  res[trum_friction_out_f] = f, res[trum_friction_out_f_v] = f_v;
  res[trum_friction_out_p_1] = &p_1, res[trum_friction_out_p_2] = &p_2;
  TRUM_KERNEL(trum_friction)(arg, res, 0, 0, 0);
  *larger = most(p_1, p_2), *smaller = least(p_1, p_2);
}

#endif
