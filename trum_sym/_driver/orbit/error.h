/* The error of a step: estimate over tolerance.
 *
 * The lap's result depends on the integral of f (and of theta while the rotor is held), so its quadrature error is what
 * is controlled; with slopes also that of the sensitivities' integrands. */
#ifndef TRUM_ORBIT_ERROR_H
#define TRUM_ORBIT_ERROR_H

/* Error over tolerance of a step, and in *error its error in the integral of f.  Marks lanes whose step cannot be
 * evaluated as failed. */
static real trum_error_ratio(trum_lanes* lanes, const trum_trial_step* trial, mask minimal, real* error) {
  const mask held = at_most(lanes->equation.push, REAL(0));
  real G[NODES], ratio, cosine = lanes->start.cos_phi, sine = lanes->start.sin_phi;
  mask finite, phase_unresolved = mask_all(0);
  int j;
  for (j = 0; j < NODES; ++j) G[j] = trial->T[j] * trial->f[j];
  *error = trum_quadrature_error(G);
  if (any_lane(held & lanes->status.active)) { /* a lap of the held rotor also integrates theta */
    G[0] = trial->T[0] * lanes->start.theta;
    for (j = 1; j < NODES; ++j) G[j] = trial->T[j] * trial->at[j].theta;
    *error = where(lanes->status.contact_only, REAL(0), *error);
    *error = where(held, maximum(*error, REAL(0.31830988618379067154) * trum_quadrature_error(G)), *error);
  }
  ratio = *error * lanes->tolerances.inverse_step;
  if (lanes->slopes) {
    const mask resolved = less_than(REAL(trum_min_step_for_slopes) * lanes->equation.period, lanes->step.h);
    const int contact = any_lane(held & lanes->status.active); /* not wanted of a free rotor */
    real T_f_v[NODES], T_theta_E[NODES], slope_ratio;
    int parameter;
    trum_friction_jacobian(lanes, trial, T_f_v);
    if (contact) trum_half_angle_jacobian(lanes, trial, T_theta_E);
    slope_ratio = lanes->equation.push * lanes->tolerances.inverse_growth * trum_quadrature_error(T_f_v);
    for (parameter = 0; parameter < PARAMETERS; ++parameter) {
      if (parameter == TRUM_BY_DRAG || parameter == TRUM_BY_FRICTION) continue;
      trum_sensitivity_source(lanes, trial, T_f_v, parameter, G);
      slope_ratio = maximum(slope_ratio, lanes->tolerances.inverse_friction[parameter] * trum_quadrature_error(G));
      if (!contact) continue;
      for (j = 0; j < NODES; ++j) G[j] = T_theta_E[j] * trial->derivatives[j].ln_E[parameter];
      slope_ratio =
          where(held, maximum(slope_ratio, lanes->tolerances.inverse_angle[parameter] * trum_quadrature_error(G)),
                slope_ratio);
    }
    ratio = where(resolved & less_than(slope_ratio, REAL(1e30)), maximum(ratio, slope_ratio), ratio);
  }
  finite = less_than(ratio, REAL(1e30));
  ratio = where(finite & mask_not(trial->not_converged), minimum(ratio, REAL(1e6)), REAL(1e6));
  lanes->status.failed = lanes->status.failed | (lanes->status.active & mask_not(finite) & minimal);
  /* near a standing wave the surface's phase turns fast: the nodes must resolve it, unless the whole wave touches */
  for (j = 1; j < NODES; ++j) {
    const real along = cosine * trial->at[j].cos_phi + sine * trial->at[j].sin_phi;
    phase_unresolved =
        phase_unresolved |
        (less_than(along, REAL(trum_min_phase_cosine)) &
         less_than(REAL(0), maximum(trial->events[j][EVENT_FULL_CONTACT], trial->events[j - 1][EVENT_FULL_CONTACT])));
    cosine = trial->at[j].cos_phi, sine = trial->at[j].sin_phi;
  }
  phase_unresolved =
      phase_unresolved & less_than(REAL(trum_min_step_for_phase) * lanes->equation.period, lanes->step.h);
  return where(phase_unresolved, maximum(ratio, REAL(40)), ratio);
}

#endif
