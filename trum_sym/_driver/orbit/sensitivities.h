/* Jacobian and sources of the sensitivity equations.
 *
 * x' = push f(v, t) - drag differentiated by a parameter is linear in dx with Jacobian push f_v.  At saturation f_v is
 * infinite and the step's rate of time T is zero: the products T f_v and T theta_E have finite limits, which are taken
 * from the kernels of derivations/square_roots.py. */
#ifndef TRUM_ORBIT_SENSITIVITIES_H
#define TRUM_ORBIT_SENSITIVITIES_H

/* Replaces T f_v at a square root (0 times infinity) by the extrapolation from the other nodes. */
static void trum_extrapolate_ends(real curvature, real* K) {
  static const trum_real outward[NODES] = TRUM_COLLOCATION_OUTWARD;
  const real first = REAL(outward[1]) * K[1] + REAL(outward[2]) * K[2] + REAL(outward[3]) * K[3];
  const real last = REAL(outward[1]) * K[2] + REAL(outward[2]) * K[1] + REAL(outward[3]) * K[0];
  K[0] = where(less_than(curvature, REAL(0)), first, K[0]);
  K[LAST_NODE] = where(less_than(REAL(0), curvature), last, K[LAST_NODE]);
}

/* The limit of T f_v at saturation. */
static real trum_saturation_limit(const trum_lanes* lanes, const real* e, real R_v_rate, real v, real f) {
  trum_saturation at;
  real limit;
  at.R_v = absolute(v), at.R_v_rate = R_v_rate, at.v = v, at.v_rate = lanes->equation.push * f - lanes->equation.drag;
  at.p_larger = e[EVENT_LARGER_PRESSURE], at.p_smaller = e[EVENT_SMALLER_PRESSURE], at.step = lanes->step.h;
  trum_lanes_friction_limit(&at, &limit);
  return limit;
}

/* T f_v at the nodes: where T is 0 extrapolated, and with slopes the exact limit. */
static void trum_friction_jacobian(const trum_lanes* lanes, const trum_trial_step* trial, real* K) {
  const mask from = less_than(lanes->step.curvature, REAL(0)), to = less_than(REAL(0), lanes->step.curvature);
  const real v0 = lanes->equation.v0 + trial->x[0], v1 = lanes->equation.v0 + trial->x[LAST_NODE];
  mask partly_faster, at_saturation;
  real first, last;
  int j;
  for (j = 0; j < NODES; ++j) K[j] = trial->T[j] * trial->f_v[j];
  trum_extrapolate_ends(lanes->step.curvature, K);
  K[0] = minimum(K[0], REAL(0)), K[LAST_NODE] = minimum(K[LAST_NODE], REAL(0));
  if (!with_slopes(lanes)) return;
  first = trum_saturation_limit(lanes, trial->events[0], trial->derivatives[0].R_v_rate, v0, trial->f[0]);
  last = trum_saturation_limit(lanes, trial->events[LAST_NODE], trial->derivatives[LAST_NODE].R_v_rate, v1,
                               trial->f[LAST_NODE]);
  partly_faster = less_than(
      REAL(0), trial->events[1][EVENT_SATURATION]); /* some of the surface is faster than the rotor within the step */
  at_saturation = less_than(absolute(trial->events[LAST_NODE][EVENT_SATURATION]),
                            REAL(1e-6) * absolute(trial->events[1][EVENT_SATURATION]));
  K[0] = where(from & lanes->start.at_event[EVENT_SATURATION], where(partly_faster, first, REAL(0)), K[0]);
  K[LAST_NODE] = where(to & at_saturation & trum_is_event(lanes->step.target_event, REAL(EVENT_SATURATION)),
                       where(partly_faster, last, REAL(0)), K[LAST_NODE]);
}

/* T times the derivative of f by a parameter at fixed speed. */
static void trum_sensitivity_source(const trum_lanes* lanes, const trum_trial_step* trial, const real* T_f_v,
                                    int parameter, real* source) {
  int j;
  for (j = 0; j < NODES; ++j)
    source[j] = trial->T[j] * trial->derivatives[j].f[parameter] -
                T_f_v[j] * ((lanes->equation.v0 + trial->x[j]) * trial->derivatives[j].ln_R_v[parameter]);
}

/* T theta_E at the nodes, and its limit at full contact. */
static void trum_half_angle_jacobian(const trum_lanes* lanes, const trum_trial_step* trial, real* T_theta_E) {
  const mask from = less_than(lanes->step.curvature, REAL(0)) & lanes->start.at_event[EVENT_FULL_CONTACT];
  const mask to =
      less_than(REAL(0), lanes->step.curvature) & trum_is_event(lanes->step.target_event, REAL(EVENT_FULL_CONTACT));
  const mask partly = less_than(REAL(0), trial->events[1][EVENT_FULL_CONTACT]) & mask_all(!with_hertz(lanes));
  int j;
  for (j = 0; j < NODES; ++j) T_theta_E[j] = trial->T[j] * trial->derivatives[j].theta_E;
  for (j = 0; j < NODES; j += LAST_NODE) {
    trum_full_contact_state at;
    real limit;
    at.W_c_rate = trial->derivatives[j].W_c_rate, at.step = lanes->step.h;
    trum_lanes_contact_limit(&lanes->constants, &at, &limit);
    T_theta_E[j] = where(j == 0 ? from : to, where(partly, limit, REAL(0)), T_theta_E[j]);
  }
}

#endif
