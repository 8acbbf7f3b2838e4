/* The balance of torques under a steady travelling wave.
 *
 * With both phases on all the time, and no free motion, the wave keeps its height and travels at a constant speed:
 * friction depends on the rotor's speed alone and falls with it, so the orbit is the one speed at which it balances the
 * load (eqs. 35, 36), a root. */
#ifndef TRUM_ORBIT_BALANCE_H
#define TRUM_ORBIT_BALANCE_H

/* The angle a from the crest within which the pressure engagement cos u + share adds up to `within`, of theta, and the
 * pressure at a. */
static double trum_angle_within(double engagement, double share, double theta, double within, double* pressure) {
  double a = theta, low = 0.0, high = theta;
  int k;
  for (k = 0; k < 200; ++k) { /* Newton in a bracket */
    const double excess = engagement * sin(a) + share * a - within;
    double next;
    *pressure = engagement * cos(a) + share;
    if (excess > 0.0) high = a;
    else low = a;
    next = *pressure > 0.0 ? a - excess / *pressure : -1.0;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (fabs(next - a) <= 1e-16 * theta || high - low <= 2e-16 * theta) break;
    a = next;
  }
  *pressure = engagement * cos(a) + share;
  return a;
}

/* Stores the speed of balance, if the drive is of that kind; else 0. */
static int trum_solve_balance(trum_lanes* lanes, int i, trum_search* search) {
  const trum_orbit_in* in = search->in;
  trum_orbit_out* out = search->out;
  double a, R_v, theta, sense, pressure, error;
  trum_surface at;
  const double motion = fabs(in->a_A) + fabs(in->a_B) + (fabs(in->b_A) + fabs(in->b_B)) / in->omega_n; /* free */
  if (in->m > in->n) return 0;
  if (!(motion <= 4e-15 * in->W)) return 0;
  trum_start_lap(lanes, i, search);
  trum_evaluate_surface(lanes, lanes->step.tau, &at);
  R_v = lane_value(&at.R_v, i), theta = lane_value(&at.theta, i);
  sense = lane_value(&at.cos_phi, i) < 0.0 ? -1.0 : 1.0; /* in which the crest travels */
  a = trum_angle_within(lane_value(&at.engagement, i), lane_value(&at.share, i), theta,
                        0.5 * (1.0 + sense * in->drag / in->push), &pressure);
  /* rounding, of the shares of the pressure where the contact is narrow and of what is given; the pressure is zero at the
   * contact's edge, where the root is double */
  error = 4e-15 * (6.0 + 3.0 / (theta * theta));
  error = error < 0.5 * pressure * (theta - a)
              ? error / pressure
              : sqrt(error / (lane_value(&at.engagement, i) * sin(theta) + 1e-300)) + error;
  error = R_v * (sin(a) * error + 2e-15);
  out->mean = out->low = out->high = out->start = sense * R_v * cos(a), out->variance = 0.0;
  out->mean_error = out->low_error = out->high_error = error, out->deviation_error = 0.0;
  out->level = trum_fine_level(in->tolerance), out->error = error / fabs(out->mean);
  out->flags += trum_autonomous;
  if (error <= in->tolerance * fabs(out->mean)) out->flags += trum_converged;
  else out->flags += trum_failed_step;
  return 1;
}

#endif
