/* Accepting a step: it adds to its lap's integrals, carries the sensitivities along and sets the next step's length.
 *
 * Integrals are Lobatto's quadrature on the step's own nodes, that of x^2 with Kronrod's.  A new step length is the old one times the fourth root
 * of tolerance over error (a bound on growth and shrinkage), as in any one-step method with an error estimate. */
#ifndef TRUM_ORBIT_ACCEPT_H
#define TRUM_ORBIT_ACCEPT_H

/* Sensitivities over a step: the collocation equations differentiated by each parameter.  K is their Jacobian, the
 * sources come from trum_sensitivity_source.  Adds to the lap's sums where the step is accepted. */
static void trum_accept_sensitivities(trum_lanes* lanes, const trum_trial_step* trial, const real* T_f_v, const real* K,
                                      const trum_factors* equations, mask accepted, real (*d)[NODES]) {
  static const trum_real A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  /* derivative of the logarithm of the drive period by either frequency */
  const real per_frequency = REAL(-1) / (lanes->constants.omega_n + lanes->constants.Delta_omega);
  trum_lap* lap = &lanes->lap;
  real source[NODES], T_theta_E[NODES], right[NODES];
  int i, j, parameter;
  trum_half_angle_jacobian(lanes, trial, T_theta_E);
  for (parameter = 0; parameter < PARAMETERS; ++parameter) {
    real sum_x = REAL(0), sum_xx = REAL(0), sum_f = REAL(0), sum_theta = REAL(0);
    trum_sensitivity_source(lanes, trial, T_f_v, parameter, source);
    source[0] = where(trial->damped, trum_extrapolate_first(source), source[0]);
    for (j = 0; j < NODES; ++j) {
      const real b = REAL(A[LAST_NODE][j]);
      sum_f = sum_f + b * source[j], sum_theta = sum_theta + b * (T_theta_E[j] * trial->derivatives[j].ln_E[parameter]);
      source[j] = lanes->equation.push * source[j];
      if (parameter == TRUM_BY_PREPRESSURE || parameter == TRUM_BY_FRICTION)
        source[j] = source[j] + trial->T[j] * (lanes->equation.push * trial->f[j]);
      if (parameter == TRUM_BY_DRAG) source[j] = source[j] - trial->T[j];
      if (parameter == TRUM_BY_DIFFERENCE || parameter == TRUM_BY_RESONANCE)
        source[j] =
            source[j] + trial->T[j] * ((lanes->equation.push * trial->f[j] - lanes->equation.drag) * per_frequency);
    }
    d[parameter][0] = lanes->sensitivity.x[parameter];
    for (i = 1; i < NODES; ++i) {
      right[i] = lanes->sensitivity.x[parameter] * (REAL(1) + REAL(A[i][0]) * K[0]);
      for (j = 0; j < NODES; ++j) right[i] = right[i] + REAL(A[i][j]) * source[j];
    }
    trum_substitute(equations, right, d[parameter]);
    for (j = 0; j < NODES; ++j) {
      const real b = REAL(A[LAST_NODE][j]) * trial->T[j];
      sum_x = sum_x + b * d[parameter][j], sum_xx = sum_xx + b * (trial->x[j] * d[parameter][j]);
    }
    lap->d_x[parameter] = where(accepted, lap->d_x[parameter] + sum_x, lap->d_x[parameter]);
    lap->d_xx[parameter] = where(accepted, lap->d_xx[parameter] + sum_xx, lap->d_xx[parameter]);
    lap->d_friction[parameter] = where(accepted, lap->d_friction[parameter] + sum_f, lap->d_friction[parameter]);
    lap->sum_abs_friction[parameter] =
        where(accepted, lap->sum_abs_friction[parameter] + absolute(sum_f), lap->sum_abs_friction[parameter]);
    lap->sum_abs_angle[parameter] =
        where(accepted, lap->sum_abs_angle[parameter] + absolute(sum_theta), lap->sum_abs_angle[parameter]);
    lap->d_angle[parameter] = where(accepted, lap->d_angle[parameter] + sum_theta, lap->d_angle[parameter]);
    lanes->sensitivity.x[parameter] = where(accepted, d[parameter][LAST_NODE], lanes->sensitivity.x[parameter]);
  }
  trum_select_derivatives(&lanes->sensitivity.derivatives, &trial->derivatives[LAST_NODE], accepted);
}

/* Over 1, by how much the speed would have to be another, at least, for saturation to begin or end for a moment in this step,
 * or not to: at an extremum of R_v^2 - v^2, or where a region ends and the surface's acceleration jumps.  With it a lap's S
 * jumps, however brief the moment (`brief saturation` in derivations/error_bound.py): a change of the start moves the speed
 * there by S times as much, and what the jump makes of that is S at most. */
static real trum_inverse_margin(const trum_cubic* saturation, real v, real at_end, mask finished) {
  real least = where(finished, absolute(at_end), REAL(trum_unmeasured)); /* not of infinity, whose quotient has no value */
  real side = REAL(1);
  int k;
  for (k = 0; k < 2; ++k) {
    const real at = trum_cubic_minimum(saturation, side);
    const mask within = less_than(REAL(-trum_beside_step), at) & less_than(at, REAL(1 + trum_beside_step));
    least = where(within, minimum(least, absolute(trum_cubic_at(saturation, at))), least);
    side = -side;
  }
  return minimum(REAL(trum_most_inverse_margin),
                 (absolute(v) + square_root(v * v + least)) * reciprocal(least + REAL(trum_tiny)));
}

/* Moves the accepted lanes to the end of their step, and of a region if it is finished, and adds the step to their laps. */
static void trum_accept_step(trum_lanes* lanes, const trum_trial_step* trial, mask accepted, mask finished,
                             const trum_defect* defect, const trum_cubic* saturation) {
  static const trum_real A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  const mask held = at_most(lanes->equation.push, REAL(0));
  trum_lap* lap = &lanes->lap;
  trum_factors equations;
  real S[NODES], T_f_v[NODES], K[NODES], rate[NODES], right[NODES], d[PARAMETERS][NODES];
  real sum_f = REAL(0), sum_theta = REAL(0), sum_x = REAL(0), sum_S = REAL(0), sum_xS = REAL(0), sum_SS = REAL(0);
  real inverse_margin;
  int i, j, k;
  for (j = 0; j < NODES; ++j) rate[j] = trial->T[j] * (lanes->equation.push * trial->f[j] - lanes->equation.drag);
  trum_friction_jacobian(lanes, trial, T_f_v);
  for (j = 0; j < NODES; ++j) K[j] = lanes->equation.push * T_f_v[j];
  K[0] = where(trial->damped, REAL(0), K[0]);
  S[0] = lanes->start.S;
  for (i = 1; i < NODES; ++i) right[i] = lanes->start.S * (REAL(1) + REAL(A[i][0]) * K[0]);
  equations = trum_factorise(K, trial->damped);
  trum_substitute(&equations, right, S);
  for (j = 1; j < NODES; ++j)
    S[j] = maximum(REAL(0), minimum(lanes->start.S, S[j])); /* exactly, S falls: friction draws two speeds together */
  for (j = 0; j < NODES; ++j) {
    const real b = REAL(A[LAST_NODE][j]) * trial->T[j];
    sum_f = sum_f + b * trial->f[j], sum_theta = sum_theta + b * (j == 0 ? lanes->start.theta : trial->at[j].theta);
    sum_x = sum_x + b * trial->x[j], sum_SS = sum_SS + b * (S[j] * S[j]);
    sum_S = sum_S + b * S[j], sum_xS = sum_xS + b * (trial->x[j] * S[j]);
  }
  if (with_slopes(lanes)) trum_accept_sensitivities(lanes, trial, T_f_v, K, &equations, accepted, d);
  trum_update_extremes(rate, trial->x, S, d, with_slopes(lanes), accepted & mask_not(held), trial->damped, defect,
                       lap);
  for (j = 1; j < NODES; ++j) {
    lap->fastest = where(accepted, maximum(lap->fastest, trial->at[j].R_v), lap->fastest);
    lap->full_contact =
        where(accepted & at_most(trial->at[j].W_c, lanes->constants.W_full), REAL(1), lap->full_contact);
  }
  lap->friction = where(accepted, lap->friction + sum_f, lap->friction);
  lap->angle = where(accepted, lap->angle + sum_theta, lap->angle);
  lap->x = where(accepted, lap->x + sum_x, lap->x), lap->xx = where(accepted, lap->xx + defect->xx, lap->xx);
  lap->S = where(accepted, lap->S + sum_S, lap->S), lap->xS = where(accepted, lap->xS + sum_xS, lap->xS);
  lap->SS = where(accepted, lap->SS + sum_SS, lap->SS);
  lap->stiffest = where(accepted, maximum(lap->stiffest, defect->stiffness * lanes->step.h), lap->stiffest);
  inverse_margin = trum_inverse_margin(saturation, lanes->equation.v0 + trial->x[0],
                                       trial->events[LAST_NODE][EVENT_SATURATION], finished);
  inverse_margin = S[0] * inverse_margin;
  lap->nearness = where(accepted, lap->nearness + S[0] * (inverse_margin * inverse_margin), lap->nearness);
  trum_add_defect(lanes, defect, S, accepted);
  if (lanes->record && mask_in_lane(accepted, 0)) trum_record_step(lanes->record, lanes, rate);
  lanes->start.x = where(accepted, trial->x[LAST_NODE], lanes->start.x);
  lanes->start.S = where(accepted, S[LAST_NODE], lanes->start.S);
  lanes->start.f = where(accepted, trial->f[LAST_NODE], lanes->start.f);
  lanes->start.f_v = where(accepted, trial->f_v[LAST_NODE], lanes->start.f_v);
  lanes->start.theta = where(accepted, trial->at[LAST_NODE].theta, lanes->start.theta);
  lanes->start.cos_phi = where(accepted, trial->at[LAST_NODE].cos_phi, lanes->start.cos_phi);
  lanes->start.sin_phi = where(accepted, trial->at[LAST_NODE].sin_phi, lanes->start.sin_phi);
  for (k = 0; k < EVENT_COUNT; ++k)
    lanes->start.events[k] = where(accepted, trial->events[LAST_NODE][k], lanes->start.events[k]);
}

/* How far an event with a square root lies ahead of a step without curvature, in lengths of the step; 2 if it is
 * further than 1.5 or not in this region. */
static real trum_distance_to_root(const trum_lanes* lanes, const trum_trial_step* trial, int event) {
  const trum_node_distances distances = trum_distances_of(trial->z);
  const trum_cubic c = trum_interpolate(&distances, trial->events[0][event], trial->events[1][event],
                                        trial->events[2][event], trial->events[LAST_NODE][event]);
  const mask plain = at_most(absolute(lanes->step.curvature), REAL(0)) & less_than(REAL(0), c.e0);
  real root = REAL(1);
  int j;
  for (j = 0; j < 3; ++j) {
    const real slope = trum_cubic_slope(&c, root);
    const mask falling = less_than(slope, REAL(-trum_no_slope));
    root = where(falling, root - trum_cubic_at(&c, root) * reciprocal(where(falling, slope, REAL(1))), REAL(2));
    root = maximum(REAL(0), minimum(REAL(2), root));
  }
  return where(plain & less_than(REAL(1), root) & less_than(root, REAL(1.5)) &
                   less_than(lanes->step.h * root, lanes->step.time_left),
               root, REAL(2));
}

/* With slopes: a step that ends shortly before a square root, and is too inaccurate or too short to be measured, is
 * extended to end at the root, since the sensitivities' integrands grow without bound towards it.  Returns the lanes
 * whose step is extended. */
static mask trum_extend_to_root(const trum_lanes* lanes, const trum_trial_step* trial, mask accepted, mask shrink,
                                trum_next_step* next) {
  const mask slopes_unresolved =
      accepted & mask_not(less_than(REAL(trum_min_step_for_slopes) * lanes->equation.period, lanes->step.h));
  const mask held = at_most(lanes->equation.push, REAL(0));
  const mask overshot = shrink & less_than(REAL(0), lanes->step.curvature);
  const real speed = where(held, REAL(2), trum_distance_to_root(lanes, trial, EVENT_SATURATION));
  const real full = trum_distance_to_root(lanes, trial, EVENT_FULL_CONTACT);
  const real root = minimum(speed, full);
  const mask near_root = (shrink | slopes_unresolved) & less_than(root, REAL(2));
  next->h =
      where(near_root, lanes->step.h * root, where(overshot, minimum(next->h, REAL(0.5) * lanes->step.h), next->h));
  next->target_event = where(near_root, where(less_than(full, speed), REAL(EVENT_FULL_CONTACT), REAL(EVENT_SATURATION)),
                             next->target_event);
  next->curvature = where(near_root, REAL(1), next->curvature);
  return near_root;
}

/* One attempt at a step on all lanes: collocation, events, error.  Returns the lanes whose step was accepted. */
static mask trum_advance_step(trum_lanes* lanes) {
  const mask slow = less_than(absolute(lanes->equation.v0 + lanes->start.x), REAL(trum_slow) * lanes->lap.fastest);
  const real shortest = where(slow, REAL(trum_min_slow_step), REAL(trum_min_step)) * lanes->equation.period;
  const mask minimal = at_most(lanes->step.h, shortest);
  trum_trial_step trial;
  trum_next_step next;
  trum_defect defect;
  real ratio, factor, longest;
  mask wrong, accepted, shrink;
  int k;
  trum_solve_collocation(lanes, &trial);
  next = trum_adjust_to_events(lanes, &trial, minimal);
  trum_step_defect(lanes, &trial, next.root_error, &defect);
  longest = trum_longest_step(lanes, &trial);
  ratio = trum_error_ratio(lanes, &trial, minimal, &defect, longest);
  wrong = mask_not(at_most(ratio, REAL(1))) & mask_not(minimal);
  factor = REAL(trum_step_safety) * reciprocal(square_root(square_root(maximum(ratio, REAL(1e-5)))));
  factor = minimum(lanes->step.growth, maximum(REAL(0.15), factor));
  accepted = lanes->status.active & mask_not(next.retry) & mask_not(wrong), shrink = wrong & mask_not(next.retry);
  next.h = where(shrink, lanes->step.h * factor, next.h);
  lanes->step.growth = where(shrink, REAL(1), where(accepted, REAL(trum_step_growth), lanes->step.growth));
  lanes->step.free_h = where(shrink, next.h, lanes->step.free_h);
  next.target_event = where(shrink, REAL(-1), next.target_event);
  next.curvature = where(shrink & less_than(REAL(0), next.curvature), REAL(0), next.curvature);
  if (with_slopes(lanes)) accepted = accepted & mask_not(trum_extend_to_root(lanes, &trial, accepted, shrink, &next));
  lanes->step.retries = where(next.retry, lanes->step.retries + REAL(1), where(accepted, REAL(0), lanes->step.retries));
  if (any_lane(accepted)) {
    const real grown = minimum(longest, lanes->step.h * factor);
    const mask finished = accepted & at_most(lanes->step.time_left, lanes->step.h * REAL(TRUM_EITHER(1.0000001, 1.000001)));
    const mask cut_short = finished | at_most(REAL(0), lanes->step.target_event);
    trum_accept_step(lanes, &trial, accepted, finished, &defect, &next.saturation);
    /* a step cut short by an event or a region's end does not make the next one shorter */
    lanes->step.free_h = where(accepted, where(cut_short, minimum(longest, maximum(lanes->step.free_h, grown)), grown),
                               lanes->step.free_h);
    /* where errors are mostly rounding, they are no reason to go on ever more slowly */
    lanes->step.free_h = maximum(lanes->step.free_h, shortest);
    lanes->step.tau = where(accepted, lanes->step.tau + lanes->step.h, lanes->step.tau);
    lanes->step.time_left =
        where(accepted, where(finished, REAL(0), lanes->step.time_left - lanes->step.h), lanes->step.time_left);
    next.h = where(accepted, lanes->step.free_h, next.h);
    next.curvature = where(accepted, REAL(0), next.curvature);
    for (k = 0; k < EVENT_COUNT; ++k) {
      const mask is_this = next.at_target & trum_is_event(lanes->step.target_event, REAL(k));
      lanes->start.at_event[k] = where_mask(accepted, is_this, lanes->start.at_event[k]);
      if (k == EVENT_SATURATION || k == EVENT_FULL_CONTACT)
        next.curvature = where(accepted & is_this, REAL(-1), next.curvature);
    }
    next.target_event = where(accepted, REAL(-1), next.target_event);
  }
  lanes->step.h = minimum(next.h, lanes->step.time_left), lanes->step.curvature = next.curvature;
  lanes->step.target_event = next.target_event;
  lanes->step.steps_left = lanes->step.steps_left - REAL(1);
  return accepted;
}

#endif
