/* The defect of a step, and what it makes the speed be off by (derivations/error_bound.py).
 *
 * The collocation solution u is a polynomial that satisfies the equation of motion at Lobatto's nodes; between them
 * u' = F(u, t) + r.  Its distance e from the exact solution obeys e' = -a e + r with a >= 0, as friction draws speeds
 * together: an error at the step's start is kept by exp(-integral of a), and the defect adds the integral of r times
 * what is kept of it until the step's end.  Lobatto's rule makes most of that integral cancel, so it is taken with sign,
 * by Kronrod's three nodes between Lobatto's four.  A stiff rotor close to saturation keeps more than its slope of friction
 * says: past saturation nothing draws speeds together. */
#ifndef TRUM_ORBIT_DEFECT_H
#define TRUM_ORBIT_DEFECT_H

/* What a step is off by.  Errors are to the first order and have a sign, remainders bound what that leaves out. */
typedef struct {
  real friction, friction_remainder, angle, angle_remainder; /* in the integrals of f and of theta */
  real x, remainder;    /* in x at its end, if it began exactly */
  real x_integral, x_integral_remainder; /* in the integral of x, if it began exactly */
  real inside;          /* bound of the interpolant's error between the ends */
  real xx;              /* the integral of x^2, exact for the interpolant */
  real kept, mean_kept; /* share of an error at the start that is kept at the end, and on average */
  real stiffness;       /* rate at which speeds draw together, 1/s */
  real local_end, local_inside; /* bounds of the error at the end and within, if the step began exactly, */
  real most_end, most_inside;   /* and with what the lap is off by so far */
  mask turns;           /* whether the surface's phase turns by much between two nodes */
} trum_defect;

/* exp(-z) and the mean of exp(-y) for y from 0 to z, for z >= 0, to a few per cent. */
static real trum_decay(real z) {
  return reciprocal(REAL(1) + z * (REAL(1) + z * (REAL(0.5) + z * REAL(1.0 / 6))));
}
static real trum_mean_decay(real z) { return reciprocal(REAL(1) + z * (REAL(0.5) + z * reciprocal(REAL(12) + z + z))); }

/* A bound of what the quadrature of a defect leaves out: the size of the defect times a power of how much of it does not
 * cancel, or of how lopsided it is.  *size is the integral of its magnitude. */
static real trum_quadrature_remainder(const real* r, real* size) {
  static const trum_real b[] = TRUM_CHECK_WEIGHTS;
  const real sum = REAL(b[0]) * r[0] + REAL(b[1]) * r[1] + REAL(b[2]) * r[2];
  const real all =
      REAL(b[0]) * absolute(r[0]) + REAL(b[1]) * absolute(r[1]) + REAL(b[2]) * absolute(r[2]) + REAL(trum_tiny);
  const real inverse = reciprocal(all), even = absolute(sum) * inverse;
  const real odd = REAL(b[0]) * absolute(r[0] - r[2]) * inverse, rough = maximum(even, odd * odd);
  *size = all;
  return all * rough * square_root(rough);
}

/* The defects of f and theta at the check nodes, over a step's parameter; the exponent by which friction draws speeds
 * together from there to the step's end, and the time that is left.  The exponents K at the nodes add up to `stiff`. */
static void trum_evaluate_defect(const trum_lanes* lanes, const trum_trial_step* trial, const real* K, real stiff,
                                 real* r, real* angle, real* exponent, real* left, real* xx) {
  static const trum_real c[] = TRUM_CHECK_POINTS, b[] = TRUM_CHECK_WEIGHTS;
  static const trum_real V[][NODES] = TRUM_CHECK_VALUES, U[][NODES] = TRUM_CHECK_INTEGRALS;
  const trum_equation* equation = &lanes->equation;
  const trum_step_control* step = &lanes->step;
  trum_friction_state friction[CHECKS];
  real v[CHECKS], rate[CHECKS];
  int i, j;
  for (i = 0; i < CHECKS; ++i) {
    const real sigma = REAL(c[i]), z = sigma * (REAL(1) + step->curvature * (REAL(1) - sigma));
    const real T = step->h * (REAL(1) + step->curvature * (REAL(1) - REAL(2) * sigma));
    real x = lanes->start.x, value = REAL(0), theta = REAL(0), ahead = stiff;
    for (j = 0; j < NODES; ++j) {
      const real G = trial->T[j] * trial->f[j];
      x = x + REAL(U[i][j]) * (equation->push * G - trial->T[j] * equation->drag);
      value = value + REAL(V[i][j]) * G;
      theta = theta + REAL(V[i][j]) * (trial->T[j] * (j == 0 ? lanes->start.theta : trial->at[j].theta));
      ahead = ahead - REAL(U[i][j]) * K[j];
    }
    v[i] = equation->v0 + x;
    r[i] = value, angle[i] = theta - T * trial->at[NODES + i].theta;
    exponent[i] = maximum(REAL(0), ahead), left[i] = step->h * (REAL(1) - z);
    *xx = *xx + REAL(b[i]) * T * (x * x);
    rate[i] = T;
  }
  trum_evaluate_frictions(lanes, trial->at + NODES, v, friction, CHECKS);
  for (i = 0; i < CHECKS; ++i) r[i] = r[i] - rate[i] * friction[i].f;
}

/* What rounding makes of a step's integral of f: friction is a difference of two shares of the pressure, each rounded,
 * the more so the narrower the contact.  A wave that is small beside its phases' amplitude has an uncertain phase, of
 * which all of a held rotor's friction depends (where the layer is elastic, no more than there is) and none of it where
 * the rotor is faster than all of the surface.  After a start from rest (exactly no displacement) the rounding is as
 * small as the time; else it is that of the amplitude. */
static real trum_rounding(const trum_lanes* lanes, const trum_trial_step* trial) {
  const real theta = lanes->start.theta, h = lanes->step.h;
  const mask held = at_most(lanes->equation.push, REAL(0));
  const mask from_rest = at_most(absolute(lanes->region.f_A_re) + absolute(lanes->region.f_B_re), REAL(0));
  const real turn = (lanes->constants.omega_n + absolute(lanes->constants.Delta_omega)) * (lanes->step.tau + h);
  const real scale = lanes->constants.W * where(from_rest, minimum(REAL(1), turn), REAL(1));
  const real phase = minimum(REAL(2), REAL(40 * trum_unit) * scale * reciprocal(trial->at[1].W_c + REAL(trum_tiny)));
  real at_stake = REAL(0);
  int j;
  for (j = 0; j < NODES; ++j) {
    const real f = absolute(trial->f[j]);
    at_stake = maximum(at_stake, where(held, with_hertz(lanes) ? REAL(1) : f, REAL(1) - f));
  }
  return h * (REAL(10 * trum_unit) * (REAL(1) + REAL(3) * reciprocal(theta * theta + REAL(trum_tiny))) + phase * at_stake);
}

/* Whether the surface's phase turns by much between two nodes, as it does near a standing wave; where the whole wave touches
 * a layer it does not matter, as the pressure is nearly even then; under the Hertz width it keeps its crest. */
static mask trum_phase_turns(const trum_lanes* lanes, const trum_trial_step* trial) {
  real cosine = lanes->start.cos_phi, sine = lanes->start.sin_phi;
  mask turns = mask_all(0);
  int j;
  for (j = 1; j < NODES; ++j) {
    const real along = cosine * trial->at[j].cos_phi + sine * trial->at[j].sin_phi;
    turns = turns | (less_than(along, REAL(trum_min_phase_cosine)) &
                     (with_hertz(lanes) ? mask_all(1)
                                        : less_than(REAL(0), maximum(trial->events[j][EVENT_FULL_CONTACT],
                                                                     trial->events[j - 1][EVENT_FULL_CONTACT]))));
    cosine = trial->at[j].cos_phi, sine = trial->at[j].sin_phi;
  }
  return turns;
}

/* What friction does within such a turn and the nodes do not see: a peak of which they see the sides
 * (derivations/error_bound.py, hidden_peak). */
static real trum_hidden_peak(const trum_lanes* lanes, const trum_trial_step* trial) {
  real highest = trial->f[0], lowest = trial->f[0];
  int j;
  for (j = 1; j < NODES; ++j) highest = maximum(highest, trial->f[j]), lowest = minimum(lowest, trial->f[j]);
  return REAL(TRUM_HIDDEN_PEAK) * lanes->step.h * (highest - lowest);
}

/* Bounds of an error where R_v passes zero faster than steps resolve: a rotor that is faster than the surface is slowed by
 * push - |drag|, so that |v| - R_v of the exact solution grows above what it is at the step's start (or 0) by no more than
 * what R_v changes faster than that, and so the two solutions are no further apart than both are from 0.  Between nodes R_v
 * changes up to a quarter faster than from node to node. */
static void trum_bound_by_surface(const trum_lanes* lanes, const trum_trial_step* trial, trum_defect* d) {
  static const trum_real c[NODES] = TRUM_COLLOCATION_POINTS, check[CHECKS] = TRUM_CHECK_POINTS;
  const trum_equation* equation = &lanes->equation;
  const real first = equation->v0 + lanes->start.x, past = absolute(first);
  const real off = REAL(1 + trum_first_order_share) * absolute(lanes->lap.error) + lanes->lap.remainder;
  const real R_first = square_root(maximum(lanes->start.events[EVENT_SATURATION] + first * first, REAL(0)));
  const mask straight = trial->damped & at_most(absolute(lanes->step.curvature), REAL(0));
  real before = R_first, since = REAL(0), fastest = R_first, furthest = past, change = REAL(0), ahead, end;
  int j, k;
  for (j = 1; j < NODES; ++j) {
    for (k = 1; k >= 0; --k) {
      const real R_v = trial->at[k ? NODES + j - 1 : j].R_v, at = REAL(k ? check[j - 1] : c[j]);
      change = maximum(change, absolute(R_v - before) * reciprocal(at - since));
      fastest = maximum(fastest, R_v), before = R_v, since = at;
    }
    furthest = maximum(furthest, absolute(equation->v0 + trial->x[j]));
  }
  ahead = REAL(1.25) * change - (equation->push - absolute(equation->drag)) * lanes->step.h;
  ahead = maximum(REAL(0), ahead) + REAL(100 * trum_unit) * lanes->lap.fastest;
  end = before + absolute(equation->v0 + trial->x[LAST_NODE]) + ahead, furthest = fastest + furthest + ahead;
  ahead = maximum(REAL(0), past - R_first);
  d->local_end = where(straight, end + ahead, REAL(TRUM_HUGE));
  d->local_inside = where(straight, furthest + ahead, REAL(TRUM_HUGE));
  ahead = maximum(REAL(0), past + off - R_first);
  d->most_end = where(straight, end + ahead, REAL(TRUM_HUGE));
  d->most_inside = where(straight, furthest + ahead, REAL(TRUM_HUGE));
}

/* What a trial step is off by. */
static void trum_step_defect(const trum_lanes* lanes, const trum_trial_step* trial, real root_error, trum_defect* d) {
  static const trum_real b[] = TRUM_CHECK_WEIGHTS, full[] = TRUM_CHECK_FULL_WEIGHTS;
  static const trum_real A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  const real push = lanes->equation.push, h = lanes->step.h;
  real K[NODES], r[3], angle[3], exponent[3], left[3], stiff = REAL(0), to_saturation = REAL(0), all, least;
  real size, rounding, hidden, first, damped, weakest = REAL(trum_unmeasured), largest = REAL(0), lasting;
  int i, j;
  for (j = 0; j < NODES; ++j) K[j] = trial->T[j] * trial->f_v[j];
  trum_extrapolate_ends(lanes->step.curvature, K);
  d->xx = REAL(0);
  for (j = 0; j < NODES; ++j) {
    const real weight = REAL(A[LAST_NODE][j]);
    K[j] = absolute(push * minimum(K[j], REAL(0)));
    stiff = stiff + weight * K[j], weakest = minimum(weakest, K[j]);
    to_saturation = to_saturation + weight * (trial->T[j] * maximum(REAL(0), REAL(1) - absolute(trial->f[j])));
    d->xx = d->xx + REAL(full[j]) * trial->T[j] * (trial->x[j] * trial->x[j]);
  }
  trum_evaluate_defect(lanes, trial, K, stiff, r, angle, exponent, left, &d->xx);
  d->kept = trum_decay(stiff), d->mean_kept = trum_mean_decay(stiff);
  d->stiffness = stiff * reciprocal(h + REAL(trum_tiny));
  first = REAL(full[0]) * trial->T[0] * (trial->f[0] - lanes->start.f); /* of a damped step, at its first node */
  all = push * absolute(first) + absolute(lanes->lap.error) + lanes->lap.remainder;
  for (i = 0; i < 3; ++i) all = all + push * absolute(REAL(b[i]) * r[i]);
  /* however steep friction is, it takes from an error no more than what is left to saturation; half of that is counted */
  least = where(less_than(REAL(trum_stiff), stiff),
                REAL(1) - REAL(0.5) * push * to_saturation * reciprocal(all + REAL(trum_tiny)), REAL(0));
  d->kept = maximum(d->kept, least), d->mean_kept = maximum(d->mean_kept, least);
  d->friction = first, d->x = first * d->kept, d->x_integral = push * (first * h * d->mean_kept);
  damped = absolute(first) * d->kept, lasting = absolute(first) * h * d->mean_kept;
  for (i = 0; i < 3; ++i) {
    const real share = REAL(b[i]) * r[i], kept = maximum(least, trum_decay(exponent[i]));
    const real lasts = left[i] * maximum(least, trum_mean_decay(exponent[i]));
    d->friction = d->friction + share, d->x = d->x + share * kept;
    d->x_integral = d->x_integral + push * (share * lasts);
    damped = damped + absolute(share) * kept, lasting = lasting + absolute(share) * lasts;
    largest = maximum(largest, absolute(r[i]));
  }
  d->x = push * d->x;
  rounding = trum_rounding(lanes, trial);
  d->friction_remainder = trum_quadrature_remainder(r, &size);
  d->turns = trum_phase_turns(lanes, trial);
  hidden = where(d->turns, trum_hidden_peak(lanes, trial), REAL(0));
  d->friction_remainder = where(trial->damped, damped, d->friction_remainder) + rounding + root_error + hidden;
  /* between the ends of a damped step the error is where friction balances the defect */
  d->inside = push * where(trial->damped, minimum(REAL(0.5) * size, largest * reciprocal(REAL(1) + weakest)),
                           REAL(0.5) * size);
  d->inside = d->inside + push * hidden;
  /* the decay of errors is known to the first order only */
  d->remainder = push * d->friction_remainder + trial->unsolved +
                 push * size * stiff * stiff * reciprocal(REAL(20) + stiff * stiff * (REAL(4) + stiff));
  d->x_integral_remainder = where(trial->damped, push * lasting, h * d->remainder);
  d->most_end = d->most_inside = REAL(TRUM_HUGE);
  if (any_lane(trial->damped & lanes->status.active)) {
    mask closer;
    trum_bound_by_surface(lanes, trial, d);
    closer = less_than(d->local_end, absolute(d->x) + d->remainder);
    d->x = where(closer, REAL(0), d->x), d->remainder = where(closer, d->local_end, d->remainder);
    d->inside = minimum(d->inside, d->local_inside);
    closer = less_than(h * d->local_inside, absolute(d->x_integral) + d->x_integral_remainder);
    d->x_integral = where(closer, REAL(0), d->x_integral);
    d->x_integral_remainder = where(closer, h * d->local_inside, d->x_integral_remainder);
  }
  d->angle_remainder = trum_quadrature_remainder(angle, &size) + REAL(TRUM_EITHER(1e-15, 5e-7)) * h;
  d->angle = REAL(b[0]) * angle[0] + REAL(b[1]) * angle[1] + REAL(b[2]) * angle[2];
}

/* A lap's error and remainder at a step's end. */
static void trum_end_errors(const trum_lap* lap, const trum_defect* d, real* error, real* remainder) {
  mask closer;
  *error = lap->error * d->kept + d->x, *remainder = lap->remainder * d->kept + d->remainder;
  closer = less_than(d->most_end, absolute(*error) + *remainder);
  *error = where(closer, REAL(0), *error), *remainder = where(closer, d->most_end, *remainder);
}

/* Adds an accepted step's errors to its lap's; to be called before S and x move on. */
static void trum_add_defect(trum_lanes* lanes, const trum_defect* d, const real* S, mask accepted) {
  trum_lap* lap = &lanes->lap;
  const real h = lanes->step.h, half = REAL(0.5) * h;
  real within, error, remainder;
  trum_end_errors(lap, d, &error, &remainder);
  lap->error_sum = where(accepted, lap->error_sum + h * lap->error * d->mean_kept + d->x_integral, lap->error_sum);
  lap->error_square =
      where(accepted, lap->error_square + half * (lap->error * lap->error + error * error), lap->error_square);
  lap->error_S = where(accepted, lap->error_S + half * (lap->error * S[0] + error * S[LAST_NODE]), lap->error_S);
  lap->remainder_sum = where(
      accepted, lap->remainder_sum + h * (lap->remainder * d->mean_kept) + d->x_integral_remainder, lap->remainder_sum);
  /* within the step what is left of the start's decays, and the defect adds its own */
  within = lap->remainder * square_root(d->mean_kept) + d->remainder;
  lap->remainder_square = where(accepted, lap->remainder_square + h * (within * within), lap->remainder_square);
  lap->inside = where(accepted, lap->inside + h * d->inside, lap->inside);
  lap->kept_sum = where(accepted, lap->kept_sum + h * (lap->kept * d->mean_kept), lap->kept_sum);
  lap->kept = where(accepted, lap->kept * d->kept, lap->kept);
  lap->error = where(accepted, error, lap->error), lap->remainder = where(accepted, remainder, lap->remainder);
  lap->friction_error = where(accepted, lap->friction_error + d->friction, lap->friction_error);
  lap->friction_remainder =
      where(accepted, lap->friction_remainder + d->friction_remainder, lap->friction_remainder);
  lap->angle_error = where(accepted, lap->angle_error + d->angle, lap->angle_error);
  lap->angle_remainder = where(accepted, lap->angle_remainder + d->angle_remainder, lap->angle_remainder);
  lanes->step.stiffness =
      where(accepted, maximum(d->stiffness, REAL(0.8) * lanes->step.stiffness), lanes->step.stiffness);
}

#endif
