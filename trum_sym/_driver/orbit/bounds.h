/* An orbit's figures with bounds of their errors, from a lap that almost is one (derivations/error_bound.py).
 *
 * To the first order in its defects a lap is off by error(t), which starts at 0.  Its start speed is off, too: the
 * orbit's is start + gain / decay, up to the lap's error at its end over the decay, and a change of the start changes
 * the speed by S times it.  So the speed that is reported is off by error(t) + S(t) error(end) / decay to the first
 * order; what that leaves out is bounded by the remainders and by how well the change of the start speed is known. */
#ifndef TRUM_ORBIT_BOUNDS_H
#define TRUM_ORBIT_BOUNDS_H

/* How the start speed of an orbit lies to that of a lap: to be changed by this, which is uncertain by that, beside the
 * lap's own errors; and by how much more than the extremes that are seen others may move with it. */
typedef struct {
  trum_real change, uncertainty, rival;
} trum_start_change;

/* Bounds of a lap's errors: at its start, of its mean, and of its deviation, whose variance is stored. */
static void trum_store_bounds(trum_search* search, const trum_lap_sums* lap, trum_start_change start, trum_real top) {
  const trum_real cycle_time = search->cycle_time, growth = lap->growth;
  const trum_real decay = trum_larger(1 - growth, trum_least_decay), share = trum_first_order_share;
  const trum_real S = lap->S / cycle_time, SS = lap->SS / cycle_time;
  const trum_real end_error = lap->error, start_error = end_error / decay;
  const trum_real start_remainder = (share * trum_fabs(end_error) + lap->remainder) / decay + start.uncertainty;
  const trum_real mean_error = lap->error_sum / cycle_time, rounding = TRUM_EITHER(4e-15, 2e-6) * top;
  const trum_real mean_remainder = share * trum_fabs(mean_error) + lap->remainder_sum / cycle_time;
  const trum_real of_start = trum_fabs(start_error) + start_remainder, of_extremes = start.rival + rounding;
  const trum_real whole_error = mean_error + S * start_error;
  const trum_real square = lap->error_square / cycle_time - whole_error * whole_error +
                        start_error * (2 * lap->error_S / cycle_time + start_error * SS);
  const trum_real of_variance = TRUM_EITHER(1e-15, 5e-7) * (lap->xx / cycle_time + start.change * start.change * SS);
  const trum_real low = (1 + share) * lap->low_error + lap->low_remainder;
  const trum_real high = (1 + share) * lap->high_error + lap->high_remainder;
  const trum_real low_rival = lap->low - lap->lowest; /* of the lap's other extremes */
  const trum_real high_rival = lap->highest - lap->high;
  trum_orbit_out* out = search->out;
  out->mean_error = trum_fabs(whole_error) + mean_remainder + S * start_remainder + rounding;
  out->low_error = lap->S_low * of_start + trum_larger(low, low_rival) + of_extremes;
  out->high_error = lap->S_high * of_start + trum_larger(high, high_rival) + of_extremes;
  /* by the triangle inequality the deviation is off by no more than the deviation of the error */
  out->deviation_error = trum_sqrt(square > 0 ? square : 0) + share * (trum_fabs(mean_error) + trum_fabs(end_error)) +
                         trum_sqrt(SS > S * S ? SS - S * S : 0) * start_remainder +
                         trum_sqrt(lap->remainder_square / cycle_time) +
                         TRUM_C(0.05) * lap->inside / cycle_time + rounding +
                         of_variance / (trum_sqrt(out->variance) + trum_sqrt(of_variance) + trum_tiny);
  out->mean_error *= trum_bound_safety, out->deviation_error *= trum_bound_safety;
  out->low_error *= trum_bound_safety, out->high_error *= trum_bound_safety;
  out->error = trum_larger(trum_larger(out->low_error, out->high_error),
                           trum_larger(out->mean_error, out->deviation_error)) / top;
}

/* The figures of the orbit whose start speed a lap's is to be changed to, to the first order in the change. */
static void trum_store_orbit(trum_search* search, const trum_lap_sums* lap, trum_start_change start, trum_real top) {
  const trum_real cycle_time = search->cycle_time, change = start.change;
  const trum_real x = lap->x / cycle_time, xx = lap->xx / cycle_time;
  const trum_real S = lap->S / cycle_time, SS = lap->SS / cycle_time;
  const trum_real xS = lap->xS / cycle_time;
  const trum_real variance = xx - x * x + change * (2 * (xS - x * S) + change * (SS - S * S));
  const trum_real v0 = search->v0;
  trum_orbit_out* out = search->out;
  out->start = search->start_speed + change, out->level = search->level;
  out->mean = v0 + x + change * S;
  out->low = v0 + lap->low + change * lap->S_low;
  out->high = v0 + lap->high + change * lap->S_high;
  /* the change leaves the order of nearly equal speeds open */
  out->low = out->low < out->mean ? out->low : out->mean, out->high = out->high > out->mean ? out->high : out->mean;
  out->variance = variance > 0 ? variance : 0;
  trum_store_bounds(search, lap, start, top);
}

/* Contact and friction of the held rotor; 1 if both bounds meet the tolerance. */
static int trum_store_held(trum_search* search) {
  const trum_lap_sums* lap = &search->lap;
  const trum_real cycle_time = search->cycle_time, pi_time = cycle_time * TRUM_C(3.14159265358979323846);
  const trum_real contact = lap->angle / pi_time, held = lap->friction / cycle_time;
  trum_orbit_out* out = search->out;
  out->contact = contact < 1 ? contact : 1, out->held = held > 1 ? 1 : held < -1 ? -1 : held;
  out->contact_error = ((1 + trum_first_order_share) * trum_fabs(lap->angle_error) +
                        lap->angle_remainder) / pi_time;
  out->held_error = ((1 + trum_first_order_share) * trum_fabs(lap->friction_error) +
                     lap->friction_remainder) / cycle_time;
  out->contact_error *= trum_bound_safety, out->held_error *= trum_bound_safety;
  return out->contact_error <= search->in->tolerance && out->held_error <= search->in->tolerance;
}

#endif
