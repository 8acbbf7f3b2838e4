/* Derivatives of friction, contact and surface speed by the parameters that the sensitivities are by. */
#ifndef TRUM_ORBIT_DERIVATIVES_H
#define TRUM_ORBIT_DERIVATIVES_H

/* a, or 0 where the surface stands still and a is not finite: such an instant contributes nothing. */
static real trum_finite_or_zero(real a) { return where(less_than(absolute(a), REAL(TRUM_EITHER(1e100, 1e37))), a, REAL(0)); }

/* The derivatives at an instant (tau after the region's start) and a speed v of the rim. */
static void trum_evaluate_derivatives(const trum_lanes* lanes, real tau, const trum_surface* at, real v,
                                      trum_derivatives* by) {
  trum_friction_derivatives friction;
  real wave[trum_wave_slopes_n_res];
  int parameter;
  trum_lanes_friction_slopes(at, &friction, v);
  trum_lanes_wave_slopes(&lanes->constants, &lanes->region, &lanes->region_slopes, tau, wave);
  if (!with_hertz(lanes)) friction.E_height = REAL(1); /* the Winkler layer's engagement is in proportion to the height */
  for (parameter = 0; parameter < PARAMETERS; ++parameter) {
    real height = REAL(0), speed = REAL(0), phase = REAL(0); /* derivatives of ln (W_c / W_full), ln R_v and phi */
    if (parameter == TRUM_BY_PREPRESSURE) height = REAL(-1);
    if (parameter == TRUM_BY_AMPLITUDE) height = speed = REAL(1);
    if (parameter == TRUM_BY_RESONANCE || parameter == TRUM_BY_DIFFERENCE) { /* those of W_c, R_v, phi in a row */
      const int W_c =
          parameter == TRUM_BY_RESONANCE ? trum_wave_slopes_out_W_c_omega_n : trum_wave_slopes_out_W_c_Delta_omega;
      height = wave[W_c] / at->W_c, speed = wave[W_c + 1] / at->R_v, phase = wave[W_c + 2];
    }
    height = height * friction.E_height;
    by->f[parameter] = trum_finite_or_zero(friction.f_E * height + friction.f_phi * phase);
    by->ln_E[parameter] = trum_finite_or_zero(height);
    by->ln_R_v[parameter] = trum_finite_or_zero(speed);
  }
  by->theta_E = trum_finite_or_zero(friction.theta_E);
  by->R_v_rate = wave[trum_wave_slopes_out_R_v_tau], by->W_c_rate = wave[trum_wave_slopes_out_W_c_tau];
}

#endif
