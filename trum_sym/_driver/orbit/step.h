/* A step by collocation at Lobatto's four nodes (order 6), solved by Newton with the friction's own derivative.
 *
 * Lobatto's rule reflects what is stiff (a light rotor's return to the balance of torques) instead of damping it.  Where
 * that matters the rate at the first node is replaced by the extrapolation of the other three: order 3, and stiff motion
 * is gone at the step's end. */
#ifndef TRUM_ORBIT_STEP_H
#define TRUM_ORBIT_STEP_H

/* An estimate of a step's quadrature error, from the decay of its integrand's Legendre coefficients. */
static real trum_quadrature_error(const real* G) {
  static const trum_real L[NODES][NODES] = TRUM_COLLOCATION_LEGENDRE;
  real size[NODES], whole, second, third;
  int k, j;
  for (k = 0; k < NODES; ++k) {
    size[k] = REAL(L[k][0]) * G[0];
    for (j = 1; j < NODES; ++j) size[k] = size[k] + REAL(L[k][j]) * G[j];
    size[k] = absolute(size[k]);
  }
  whole = size[0] + size[1] + REAL(1e-37);
  second = size[2] / whole, third = cube_root(size[3] / whole + REAL(1e-37));
  return REAL(trum_quadrature_share) * maximum(size[2] * second * square_root(second), size[3] * third * third);
}

/* An attempt at a step: location z and rate of time T of the nodes, and the solution there. */
typedef struct {
  trum_surface at[NODES + CHECKS]; /* from the second node on; then at the check nodes (defect.h) */
  real z[NODES], T[NODES], x[NODES], f[NODES], f_v[NODES], events[NODES][EVENT_COUNT];
  trum_derivatives derivatives[NODES]; /* if slopes are wanted */
  mask damped;                         /* the first node's rate is extrapolated */
  mask not_converged;                  /* Newton has not converged */
  real unsolved;                       /* bound of what Newton leaves of the speeds' changes */
} trum_trial_step;

/* Whether two event numbers are the same. */
static mask trum_is_event(real a, real b) { return at_most(absolute(a - b), REAL(0.25)); }

/* A first guess of the speed's change at a node: the rate at the start goes on; stiff motion keeps its share of the
 * surface's speed, as it follows the balance of torques. */
static real trum_guess(const trum_lanes* lanes, const trum_trial_step* trial, int j) {
  const real v = lanes->equation.v0 + lanes->start.x, lead = lanes->start.events[EVENT_SATURATION];
  const real R_v = square_root(maximum(lead + v * v, REAL(trum_tiny)));
  const real rate = lanes->equation.push * lanes->start.f - lanes->equation.drag;
  return lanes->start.x + where(trial->damped & less_than(REAL(0), lead), v * (trial->at[j].R_v * reciprocal(R_v) - REAL(1)),
                                lanes->step.h * trial->z[j] * rate);
}

/* Newton's next speed change at a node: |f| <= 1 bounds it; stiff motion that is slower than the surface goes most of
 * the way at most to where friction is saturated and has no slope. */
static real trum_limited(const trum_lanes* lanes, const trum_trial_step* trial, int j, real next) {
  const real drift = lanes->start.x - lanes->step.h * trial->z[j] * lanes->equation.drag;
  const real reach = lanes->step.h * trial->z[j] * lanes->equation.push;
  const real v = lanes->equation.v0 + trial->x[j], R_v = trial->at[j].R_v;
  const real to_top = REAL(0.75) * (R_v - v), to_bottom = REAL(-0.75) * (R_v + v);
  const real kept = maximum(trial->x[j] + to_bottom, minimum(trial->x[j] + to_top, next));
  next = where(trial->damped & less_than(absolute(v), R_v), kept, next);
  return maximum(drift - reach, minimum(drift + reach, next));
}

/* Solves x_i = x_0 + sum_j A_ij T_j (push f(x_j) - drag) for the three nodes after the first.
 *
 * What Newton leaves: the next change is smaller in the same ratio at least, as f is convex or concave between its events.
 * The first change has no ratio, and near saturation, where 1 - |f| goes as a root of the speed, changes shrink without
 * end on the way to a saturation that they never reach: friction is off by f'' y^2 with f'' about f'^2 / (1 - |f|), which
 * counts for a first change y, and for one that takes f more than half of the way to saturation; at most f goes on to
 * saturation, or not at all. */
static void trum_solve_collocation(const trum_lanes* lanes, trum_trial_step* trial) {
  static const trum_real A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS, c[NODES] = TRUM_COLLOCATION_POINTS,
                         check[CHECKS] = TRUM_CHECK_POINTS;
  trum_factors equations;
  trum_friction_state friction[NODES];
  real tau[NODES + CHECKS], v[NODES], G[NODES], right[NODES], y[NODES], T_f[NODES], last_change = REAL(TRUM_EITHER(1e100, 1e37));
  int i, j, k, tries;
  for (j = 0; j < NODES; ++j) {
    const real sigma = REAL(c[j]);
    trial->z[j] = sigma * (REAL(1) + lanes->step.curvature * (REAL(1) - sigma));
    trial->T[j] = lanes->step.h * (REAL(1) + lanes->step.curvature * (REAL(1) - REAL(2) * sigma));
  }
  trial->damped = less_than(REAL(trum_stiff), lanes->step.stiffness * lanes->step.h) &
                  at_most(REAL(0), lanes->step.curvature);
  trial->not_converged = lanes->status.active, trial->unsolved = REAL(0);
  trial->x[0] = lanes->start.x, trial->f[0] = lanes->start.f, trial->f_v[0] = lanes->start.f_v;
  for (k = 0; k < EVENT_COUNT; ++k) trial->events[0][k] = lanes->start.events[k];
  for (j = 1; j < NODES; ++j) tau[j] = lanes->step.tau + lanes->step.h * trial->z[j];
  for (j = 0; j < CHECKS; ++j) {
    const real sigma = REAL(check[j]);
    tau[NODES + j] = lanes->step.tau + lanes->step.h * (sigma * (REAL(1) + lanes->step.curvature * (REAL(1) - sigma)));
  }
  trum_evaluate_surfaces(lanes, tau + 1, trial->at + 1, NODES - 1 + CHECKS);
  for (j = 1; j < NODES; ++j) {
    trial->x[j] = trum_guess(lanes, trial, j);
    trial->f[j] = lanes->start.f, trial->f_v[j] = REAL(0), trial->events[j][EVENT_LARGER_PRESSURE] = REAL(0);
    trial->events[j][EVENT_SMALLER_PRESSURE] = REAL(0);
  }
  for (tries = 0; tries < 12 && any_lane(trial->not_converged); ++tries) {
    real change = REAL(0), bent = REAL(0), slope[NODES];
    slope[0] = REAL(0);
    for (j = 1; j < NODES; ++j) v[j] = lanes->equation.v0 + trial->x[j];
    trum_evaluate_frictions(lanes, trial->at + 1, v + 1, friction + 1, NODES - 1);
    for (j = 1; j < NODES; ++j) {
      real* events = trial->events[j];
      trial->f[j] = where(trial->not_converged, friction[j].f, trial->f[j]);
      trial->f_v[j] = where(trial->not_converged, friction[j].f_v, trial->f_v[j]);
      events[EVENT_LARGER_PRESSURE] =
          where(trial->not_converged, trum_larger_pressure(&friction[j]), events[EVENT_LARGER_PRESSURE]);
      events[EVENT_SMALLER_PRESSURE] =
          where(trial->not_converged, trum_smaller_pressure(&friction[j]), events[EVENT_SMALLER_PRESSURE]);
      G[j] = trial->T[j] * (lanes->equation.push * trial->f[j] - lanes->equation.drag);
      slope[j] = trial->T[j] * (lanes->equation.push * trial->f_v[j]);
    }
    G[0] = where(trial->damped, trum_extrapolate_first(G),
                 trial->T[0] * (lanes->equation.push * lanes->start.f - lanes->equation.drag));
    for (i = 1; i < NODES; ++i) {
      right[i] = lanes->start.x - trial->x[i];
      for (j = 0; j < NODES; ++j) right[i] = right[i] + REAL(A[i][j]) * G[j];
    }
    equations = trum_factorise(slope, trial->damped);
    trum_substitute(&equations, right, y);
    for (j = 1; j < NODES; ++j) {
      const real next = trum_limited(lanes, trial, j, trial->x[j] + y[j]);
      const real f_change = trial->f_v[j] * y[j], to_saturation = REAL(1) - absolute(trial->f[j]);
      const real left = REAL(1) - maximum(absolute(trial->f[j]), absolute(trial->f[j] + f_change));
      const real bend = absolute(trial->T[j]) *
                        minimum(absolute(f_change) + absolute(to_saturation),
                                f_change * f_change * reciprocal(maximum(left, REAL(trum_tiny))));
      const mask within = at_most(absolute(f_change), REAL(0.5) * to_saturation);
      change = maximum(change, absolute(y[j])); /* not of what it is limited to, which may end at the limit */
      bent = maximum(bent, tries == 0 ? bend : where(within, REAL(0), bend));
      trial->f[j] = where(trial->not_converged, trial->f[j] + trial->f_v[j] * (next - trial->x[j]), trial->f[j]);
      trial->x[j] = where(trial->not_converged, next, trial->x[j]);
    }
    bent = lanes->equation.push * bent;
    trial->unsolved =
        where(trial->not_converged,
              maximum(bent, tries == 0                      ? REAL(0)
                            : where(less_than(change, last_change), change * (change * reciprocal(last_change)), change)),
              trial->unsolved);
    last_change = where(trial->not_converged, change, last_change);
    /* a first change says nothing of the next where friction is steep; the error of a damped step weighs more (error.h) */
    trial->not_converged =
        trial->not_converged &
        mask_not(at_most(change, lanes->tolerances.newton) &
                 at_most(bent * lanes->tolerances.inverse_step, REAL(trum_newton_share) * lanes->equation.push) &
                 mask_not(trial->damped & less_than(REAL(trum_newton_share / trum_stiff_factor) * lanes->equation.push,
                                                    trial->unsolved * lanes->tolerances.inverse_step)) &
                 (tries > 0 ? mask_all(1) : mask_not(trial->damped)));
  }
  for (j = 1; j < NODES; ++j) T_f[j] = trial->T[j] * trial->f[j];
  trial->f[0] = where(trial->damped, trum_extrapolate_first(T_f) * reciprocal(where(trial->damped, trial->T[0], REAL(1))),
                      trial->f[0]);
  for (j = 1; j < NODES; ++j) {
    v[j] = lanes->equation.v0 + trial->x[j];
    trial->events[j][EVENT_SATURATION] = trial->at[j].R_v * trial->at[j].R_v - v[j] * v[j];
    trial->events[j][EVENT_FULL_CONTACT] =
        trial->at[j].W_c * trial->at[j].W_c - lanes->constants.W_full * lanes->constants.W_full;
  }
  if (with_slopes(lanes)) {
    trial->derivatives[0] = lanes->sensitivity.derivatives;
    trum_evaluate_derivatives(lanes, tau + 1, trial->at + 1, v + 1, trial->derivatives + 1, NODES - 1);
  }
}

#endif
