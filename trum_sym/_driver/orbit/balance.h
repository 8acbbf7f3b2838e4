/* The balance of torques under a steady travelling wave.
 *
 * With both phases on all the time, and no free motion, the wave keeps its height and travels at a constant speed:
 * friction depends on the rotor's speed alone and falls with it, so the orbit is the one speed at which it balances the
 * load (eqs. 35, 36), a root. */
#ifndef TRUM_ORBIT_BALANCE_H
#define TRUM_ORBIT_BALANCE_H

/* The angle a from the crest within which the pressure engagement cos u + share adds up to `within`, of theta, and the
 * pressure at a. */
static trum_real trum_angle_within(trum_real engagement, trum_real share, trum_real theta, trum_real within, trum_real* pressure) {
  trum_real a = theta, low = 0, high = theta;
  int k;
  for (k = 0; k < 200; ++k) { /* Newton in a bracket */
    const trum_real excess = engagement * trum_sin(a) + share * a - within;
    trum_real next;
    *pressure = engagement * trum_cos(a) + share;
    if (excess > 0) high = a;
    else low = a;
    next = *pressure > 0 ? a - excess / *pressure : -1;
    if (!(next > low && next < high)) next = TRUM_C(0.5) * (low + high);
    if (trum_fabs(next - a) <= TRUM_EITHER(1e-16, 6e-8) * theta || high - low <= TRUM_EITHER(2e-16, 1.2e-7) * theta) break;
    a = next;
  }
  *pressure = engagement * trum_cos(a) + share;
  return a;
}

/* Whether a drive is of that kind. */
static int trum_is_balance(const trum_orbit_in* in) {
  const trum_real motion = trum_fabs(in->a_A) + trum_fabs(in->a_B) + (trum_fabs(in->b_A) + trum_fabs(in->b_B)) / in->omega_n; /* free */
  return !(in->m > in->n) && motion <= TRUM_EITHER(4e-15, 2e-6) * in->W;
}

/* Stores the speed of balance, if the drive is of that kind; else 0. */
static int trum_solve_balance(trum_lanes* lanes, int i, trum_search* search) {
  const trum_orbit_in* in = search->in;
  trum_orbit_out* out = search->out;
  trum_real a, R_v, theta, sense, pressure, error;
  trum_surface at;
  if (!trum_is_balance(in)) return 0;
  trum_start_segment(lanes, i, search, 0);
  set_lane_mask(&lanes->status.active, i, 0); /* the lane has its constants, and nothing to integrate */
  trum_surface_at(&lanes->constants, &lanes->region, with_hertz(lanes), lanes->step.tau, &at);
  R_v = lane_value(&at.R_v, i), theta = lane_value(&at.theta, i);
  sense = lane_value(&at.cos_phi, i) < 0 ? -1 : 1; /* in which the crest travels */
  a = trum_angle_within(lane_value(&at.engagement, i), lane_value(&at.share, i), theta,
                        TRUM_C(0.5) * (1 + sense * in->drag / in->push), &pressure);
  /* rounding, of the shares of the pressure where the contact is narrow and of what is given; the pressure is zero at the
   * contact's edge, where the root is double */
  error = TRUM_EITHER(4e-15, 2e-6) * (6 + 3 / (theta * theta));
  error = error < TRUM_C(0.5) * pressure * (theta - a)
              ? error / pressure
              : trum_sqrt(error / (lane_value(&at.engagement, i) * trum_sin(theta) + trum_tiny)) + error;
  error = R_v * (trum_sin(a) * error + TRUM_EITHER(2e-15, 1e-6));
  out->mean = out->low = out->high = out->start = sense * R_v * trum_cos(a), out->variance = 0;
  out->mean_error = out->low_error = out->high_error = error, out->deviation_error = 0;
  out->level = trum_fine_level(in->tolerance), out->error = error / trum_fabs(out->mean);
  out->flags += trum_autonomous;
  if (error <= in->tolerance * trum_fabs(out->mean)) out->flags += trum_converged;
  else out->flags += trum_failed_step;
  return 1;
}

#endif
