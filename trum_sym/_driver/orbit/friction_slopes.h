/* How friction, contact and surface speed change with the parameters that the sensitivities are by. */
#ifndef TRUM_ORBIT_FRICTION_SLOPES_H
#define TRUM_ORBIT_FRICTION_SLOPES_H

/* At a standstill of the surface nothing is defined, nor does it weigh. */
static real trum_defined(real a) { return sel(less_than(size_of(a), N_(1e100)), a, N_(0)); }

/* How friction, contact and surface change at a speed of the rim. */
static void trum_change(const trum_lanes* l, real tau, const trum_surface* at, real v, trum_changes* by) {
  trum_friction_derivatives friction;
  real wave[trum_wave_slopes_n_res];
  int way;
  trum_lanes_friction_slopes(at, &friction, v);
  trum_lanes_wave_slopes(&l->constants, &l->region, &l->region_slopes, tau, wave);
  if (!l->hertz) friction.E_height = N_(1); /* the Winkler layer's engagement is in proportion to the height */
  for (way = 0; way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) {
    real height = N_(0), speed = N_(0), phase = N_(0); /* slopes of ln (W_c / W_full), ln R_v and phi */
    if (way == TRUM_BY_PREPRESSURE) height = N_(-1);
    if (way == TRUM_BY_AMPLITUDE) height = speed = N_(1);
    if (way == TRUM_BY_RESONANCE || way == TRUM_BY_DIFFERENCE) { /* W_c, R_v and phi by one after the other */
      const int W_c = way == TRUM_BY_RESONANCE ? trum_wave_slopes_out_W_c_omega_n : trum_wave_slopes_out_W_c_Delta_omega;
      height = wave[W_c] / at->W_c, speed = wave[W_c + 1] / at->R_v, phase = wave[W_c + 2];
    }
    height = height * friction.E_height;
    by->f[way] = trum_defined(friction.f_E * height + friction.f_phi * phase);
    by->ln_E[way] = trum_defined(height);
    by->ln_R_v[way] = trum_defined(speed);
  }
  by->theta_E = trum_defined(friction.theta_E);
  by->R_v_rate = wave[trum_wave_slopes_out_R_v_tau], by->W_c_rate = wave[trum_wave_slopes_out_W_c_tau];
}

#endif
