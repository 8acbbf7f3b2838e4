/* Derivatives of friction, contact and surface speed by the parameters that the sensitivities are by. */
#ifndef TRUM_ORBIT_DERIVATIVES_H
#define TRUM_ORBIT_DERIVATIVES_H

/* a, or 0 where the surface stands still and a is not finite: such an instant contributes nothing. */
static real trum_finite_or_zero(real a) { return where(less_than(absolute(a), REAL(TRUM_EITHER(1e100, 1e37))), a, REAL(0)); }

/* The derivatives at an instant (tau after the region's start) and a speed v of the rim. */
TRUM_APART static void trum_derivatives_at(const trum_constants* constants, const trum_region* region,
                                           const trum_region_slopes* slopes, int hertz, real tau, const trum_surface* at,
                                           real v, trum_derivatives* by) {
  trum_friction_derivatives friction;
  real wave[trum_wave_slopes_n_res];
  int parameter;
  trum_lanes_friction_slopes(at, &friction, v);
  trum_lanes_wave_slopes(constants, region, slopes, tau, wave);
  if (!hertz) friction.E_height = REAL(1); /* the Winkler layer's engagement is in proportion to the height */
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

#if TRUM_LANES > 1
/* The same at `count` nodes, as many at once as there are places (sharing.h). */
static void trum_share_derivatives(const trum_lanes* lanes, const real* tau, const trum_surface* at, const real* v,
                                   trum_derivatives* by, int count) {
  const trum_sharing* sharing = &lanes->sharing;
  trum_constants constants;
  trum_region region;
  trum_region_slopes slopes;
  int first, place, k;
  trum_struct_to_places(sharing, (const real*)&lanes->constants, (real*)&constants, TRUM_MEMBERS(trum_constants));
  trum_struct_to_places(sharing, (const real*)&lanes->region, (real*)&region, TRUM_MEMBERS(trum_region));
  trum_struct_to_places(sharing, (const real*)&lanes->region_slopes, (real*)&slopes, TRUM_MEMBERS(trum_region_slopes));
  for (first = 0; first < count; first += sharing->places) {
    const int here = count - first < sharing->places ? count - first : sharing->places;
    trum_surface shared;
    trum_derivatives found;
    trum_surfaces_to_places(sharing, at + first, &shared, here);
    trum_derivatives_at(&constants, &region, &slopes, with_hertz(lanes), trum_to_places(sharing, tau + first, here), &shared,
                        trum_to_places(sharing, v + first, here), &found);
    for (place = 0; place < here; ++place)
      for (k = 0; k < TRUM_MEMBERS(trum_derivatives); ++k)
        ((real*)&by[first + place])[k] = trum_from_place(sharing, ((real*)&found)[k], place);
  }
}
#endif

/* Derivatives at `count` nodes. */
static void trum_evaluate_derivatives(const trum_lanes* lanes, const real* tau, const trum_surface* at, const real* v,
                                      trum_derivatives* by, int count) {
  int j;
#if TRUM_LANES > 1
  if (lanes->sharing.places > 1) {
    trum_share_derivatives(lanes, tau, at, v, by, count);
    return;
  }
#endif
  for (j = 0; j < count; ++j)
    trum_derivatives_at(&lanes->constants, &lanes->region, &lanes->region_slopes, with_hertz(lanes), tau[j], &at[j], v[j],
                        &by[j]);
}

#endif
