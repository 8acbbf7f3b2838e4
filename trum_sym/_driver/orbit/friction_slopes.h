/* How friction, contact and surface speed change with the parameters that the sensitivities are by. */
#ifndef TRUM_ORBIT_FRICTION_SLOPES_H
#define TRUM_ORBIT_FRICTION_SLOPES_H

/* At a standstill of the surface nothing is defined, nor does it weigh. */
static real trum_defined(real a) { return sel(less_than(size_of(a), N_(1e100)), a, N_(0)); }

/* How friction, contact and surface change at a speed of the rim. */
static void trum_change(const trum_lanes* l, real tau, const trum_surface* at, real v, trum_changes* by) {
  real f_phi, f_E, theta_E, of_height, wave[trum_wave_slopes_n_res];
  int k, way;
  {
    const real* arg[trum_friction_slopes_n_arg];
    real* res[trum_friction_slopes_n_res];
    arg[trum_friction_slopes_in_R_v] = &at->R_v, arg[trum_friction_slopes_in_phi] = &at->phi;
    arg[trum_friction_slopes_in_cos_phi] = &at->cos_phi, arg[trum_friction_slopes_in_sin_phi] = &at->sin_phi;
    arg[trum_friction_slopes_in_engagement] = &at->engagement, arg[trum_friction_slopes_in_share] = &at->share;
    arg[trum_friction_slopes_in_theta] = &at->theta, arg[trum_friction_slopes_in_sin_theta] = &at->sin_theta;
    arg[trum_friction_slopes_in_v] = &v;
    res[trum_friction_slopes_out_f_phi] = &f_phi, res[trum_friction_slopes_out_f_E] = &f_E;
    res[trum_friction_slopes_out_theta_E] = &theta_E, res[trum_friction_slopes_out_E_height] = &of_height;
    TRUM_KERNEL(trum_friction_slopes)(arg, res, 0, 0, 0);
  }
  {
    const real* arg[trum_wave_slopes_n_arg];
    real* res[trum_wave_slopes_n_res];
    arg[trum_wave_slopes_in_omega_n] = &l->omega_n, arg[trum_wave_slopes_in_Delta_omega] = &l->Delta_omega;
    arg[trum_wave_slopes_in_xi] = &l->xi, arg[trum_wave_slopes_in_s] = &l->s, arg[trum_wave_slopes_in_W] = &l->W;
    arg[trum_wave_slopes_in_D] = &l->D, arg[trum_wave_slopes_in_k_c] = &l->k_c, arg[trum_wave_slopes_in_tau] = &tau;
    arg[trum_wave_slopes_in_f_A_re] = &l->free_[0], arg[trum_wave_slopes_in_f_A_im] = &l->free_[1];
    arg[trum_wave_slopes_in_f_B_re] = &l->free_[2], arg[trum_wave_slopes_in_f_B_im] = &l->free_[3];
    arg[trum_wave_slopes_in_f_A_re_omega_n] = &l->slopes_[0][0];
    arg[trum_wave_slopes_in_f_A_im_omega_n] = &l->slopes_[0][1];
    arg[trum_wave_slopes_in_f_B_re_omega_n] = &l->slopes_[0][2];
    arg[trum_wave_slopes_in_f_B_im_omega_n] = &l->slopes_[0][3];
    arg[trum_wave_slopes_in_f_A_re_Delta_omega] = &l->slopes_[1][0];
    arg[trum_wave_slopes_in_f_A_im_Delta_omega] = &l->slopes_[1][1];
    arg[trum_wave_slopes_in_f_B_re_Delta_omega] = &l->slopes_[1][2];
    arg[trum_wave_slopes_in_f_B_im_Delta_omega] = &l->slopes_[1][3];
    arg[trum_wave_slopes_in_p_re] = &l->drive_re, arg[trum_wave_slopes_in_p_im] = &l->drive_im;
    arg[trum_wave_slopes_in_g_A] = &l->g_A, arg[trum_wave_slopes_in_g_B] = &l->g_B;
    for (k = 0; k < trum_wave_slopes_n_res; ++k) res[k] = &wave[k];
    TRUM_KERNEL(trum_wave_slopes)(arg, res, 0, 0, 0);
  }
  if (!l->hertz) of_height = N_(1); /* the Winkler layer's engagement is in proportion to the height */
  for (way = 0; way < WAYS; ++way) {
    real height = N_(0), speed = N_(0), phase = N_(0); /* slopes of ln (W_c / W_full), ln R_v and phi */
    if (way == BY_PREPRESSURE) height = N_(-1);
    if (way == BY_AMPLITUDE) height = speed = N_(1);
    if (way == BY_RESONANCE || way == BY_DIFFERENCE) {
      const int first = way == BY_RESONANCE ? trum_wave_slopes_out_W_c_omega_n : trum_wave_slopes_out_W_c_Delta_omega;
      height = wave[first] / at->W_c, speed = wave[first + 1] / at->R_v, phase = wave[first + 2];
    }
    height = height * of_height;
    by->f[way] = trum_defined(f_E * height + f_phi * phase);
    by->ln_E[way] = trum_defined(height);
    by->ln_R_v[way] = trum_defined(speed);
  }
  by->theta_E = trum_defined(theta_E);
  by->R_v_rate = wave[trum_wave_slopes_out_R_v_tau], by->W_c_rate = wave[trum_wave_slopes_out_W_c_tau];
}

#endif
