/* The error of a step over its tolerance: what its defect makes the speed at its end be off by, of a held rotor the
 * integrals of f and theta; with slopes also an estimate of the sensitivities' quadrature errors. */
#ifndef TRUM_ORBIT_ERROR_H
#define TRUM_ORBIT_ERROR_H

/* The longest step that is allowed: where friction is saturated at all nodes there is no defect, however long the step,
 * and a brief end of saturation between them must be seen, but for rough laps.  It is nearer the nearer the pressure at the points as fast
 * as the rotor, or the surface's largest speed, comes to where it ends. */
static real trum_longest_step(const trum_lanes* lanes, const trum_trial_step* trial) {
  mask saturated = mask_all(1), inside = mask_all(0), outside = mask_all(0);
  const real scale = reciprocal(trial->at[1].R_v * trial->at[1].R_v + REAL(trum_tiny));
  real highest = REAL(-TRUM_HUGE), lowest = REAL(TRUM_HUGE);
  mask near;
  int j;
  for (j = 0; j < NODES; ++j) {
    const mask slower = less_than(REAL(0), trial->events[j][EVENT_SATURATION]);
    const real margin = where(slower, trial->events[j][EVENT_LARGER_PRESSURE], trial->events[j][EVENT_SATURATION] * scale);
    saturated = saturated & less_than(REAL(trum_all_but_one), absolute(trial->f[j]));
    inside = inside | slower, outside = outside | mask_not(slower);
    highest = maximum(highest, margin), lowest = minimum(lowest, margin);
  }
  near = (inside & outside) | less_than(REAL(0), highest + REAL(0.5) * (highest - lowest));
  return lanes->equation.period *
         where(saturated & mask_not(lanes->status.rough),
               where(near, REAL(trum_max_nearly_saturated_step), REAL(trum_max_saturated_step)), REAL(trum_max_step));
}

/* Error over tolerance of a step, which may be at most `longest`.  Marks lanes whose step cannot be evaluated as failed. */
static real trum_error_ratio(trum_lanes* lanes, const trum_trial_step* trial, mask minimal, const trum_defect* d,
                             real longest) {
  const mask held = at_most(lanes->equation.push, REAL(0));
  const real of_friction = absolute(d->friction) + d->friction_remainder;
  const real of_angle = REAL(0.31830988618379067154) * (absolute(d->angle) + d->angle_remainder);
  const real of_x = (absolute(d->x) + d->remainder) * reciprocal(lanes->equation.push + REAL(trum_tiny));
  real G[NODES], ratio;
  mask finite, turned;
  int j;
  ratio = where(held, maximum(where(lanes->status.contact_only, REAL(0), of_friction), of_angle), of_x) *
          lanes->tolerances.inverse_step;
  /* stiff motion of the size of the tolerance would go on for ever at steps of that size: have it damped at once */
  ratio = where(trial->damped | less_than(REAL(trum_stiff), lanes->step.stiffness * lanes->equation.period *
                                                                REAL(trum_max_step)),
                REAL(trum_stiff_factor) * ratio, ratio);
  if (with_slopes(lanes)) {
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
  turned = d->turns & less_than(REAL(trum_min_step_for_phase) * lanes->equation.period, lanes->step.h);
  ratio = where(turned, maximum(ratio, REAL(40)), ratio);
  return where(less_than(REAL(1.01) * longest, lanes->step.h), maximum(ratio, REAL(10)), ratio);
}

#endif
