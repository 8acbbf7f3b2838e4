/* The right-hand side at a lap's start; from then on every step begins with its predecessor's last node. */
#ifndef TRUM_ORBIT_LAP_START_H
#define TRUM_ORBIT_LAP_START_H

/* Copies derivatives in the lanes of a mask. */
static void trum_select_derivatives(trum_derivatives* kept, const trum_derivatives* by, mask here) {
  int parameter;
  for (parameter = 0; parameter < PARAMETERS; ++parameter) {
    kept->f[parameter] = where(here, by->f[parameter], kept->f[parameter]);
    kept->ln_E[parameter] = where(here, by->ln_E[parameter], kept->ln_E[parameter]);
    kept->ln_R_v[parameter] = where(here, by->ln_R_v[parameter], kept->ln_R_v[parameter]);
  }
  kept->theta_E = where(here, by->theta_E, kept->theta_E);
  kept->R_v_rate = where(here, by->R_v_rate, kept->R_v_rate);
  kept->W_c_rate = where(here, by->W_c_rate, kept->W_c_rate);
}

/* Evaluates surface, friction and events where a lap starts. */
static void trum_evaluate_lap_start(trum_lanes* lanes) {
  trum_surface at;
  trum_friction_state friction;
  real e[EVENT_COUNT];
  int k;
  trum_surface_at(&lanes->constants, &lanes->region, with_hertz(lanes), lanes->step.tau, &at);
  trum_friction_at(&at, lanes->equation.v0 + lanes->start.x, &friction);
  e[EVENT_LARGER_PRESSURE] = trum_larger_pressure(&friction);
  e[EVENT_SMALLER_PRESSURE] = trum_smaller_pressure(&friction);
  e[EVENT_SATURATION] = at.R_v * at.R_v - (lanes->equation.v0 + lanes->start.x) * (lanes->equation.v0 + lanes->start.x);
  e[EVENT_FULL_CONTACT] = at.W_c * at.W_c - lanes->constants.W_full * lanes->constants.W_full;
  lanes->start.f = where(lanes->status.at_lap_start, friction.f, lanes->start.f);
  lanes->start.f_v = where(lanes->status.at_lap_start, friction.f_v, lanes->start.f_v);
  lanes->start.theta = where(lanes->status.at_lap_start, at.theta, lanes->start.theta);
  lanes->start.cos_phi = where(lanes->status.at_lap_start, at.cos_phi, lanes->start.cos_phi);
  lanes->start.sin_phi = where(lanes->status.at_lap_start, at.sin_phi, lanes->start.sin_phi);
  if (with_slopes(lanes)) {
    trum_derivatives by;
    trum_derivatives_at(&lanes->constants, &lanes->region, &lanes->region_slopes, with_hertz(lanes), lanes->step.tau, &at,
                        lanes->equation.v0 + lanes->start.x, &by);
    trum_select_derivatives(&lanes->sensitivity.derivatives, &by, lanes->status.at_lap_start);
  }
  for (k = 0; k < EVENT_COUNT; ++k) {
    lanes->start.events[k] = where(lanes->status.at_lap_start, e[k], lanes->start.events[k]);
    lanes->start.at_event[k] = lanes->start.at_event[k] & mask_not(lanes->status.at_lap_start);
  }
  lanes->status.at_lap_start = mask_all(0);
}

#endif
