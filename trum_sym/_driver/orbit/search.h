/* The search for the start speed that a lap reproduces: Newton on the lap, in a bracket. */
#ifndef TRUM_ORBIT_SEARCH_H
#define TRUM_ORBIT_SEARCH_H

/* A drive cycle in the numbers of the kernels. */
static void trum_load_cycle(const trum_orbit_in* in, trum_cycle_constants* cycle, trum_free_motion* before) {
  cycle->omega_n = (trum_real)in->omega_n, cycle->Delta_omega = (trum_real)in->Delta_omega;
  cycle->xi = (trum_real)in->xi, cycle->psi = (trum_real)in->psi, cycle->s = (trum_real)in->s;
  cycle->m = (trum_real)in->m, cycle->n = (trum_real)in->n;
  cycle->W = (trum_real)in->W, cycle->D = (trum_real)in->D, cycle->k_c = (trum_real)in->k_c;
  before->a_A = (trum_real)in->a_A, before->b_A = (trum_real)in->b_A;
  before->a_B = (trum_real)in->a_B, before->b_B = (trum_real)in->b_B;
}

/* Slopes of the phasors at the start of the regions. */
static void trum_load_region_slopes(trum_search* search) {
  const trum_orbit_in* in = search->in;
  const trum_slopes_in* by_ = search->slopes_in;
  trum_cycle_constants cycle;
  trum_free_motion before;
  trum_free_motion_slopes before_slopes;
  trum_real res_[trum_regions_slopes_n_res];
  int k, by, phase, r, part;
  trum_load_cycle(in, &cycle, &before);
#define TRUM_LOAD(name, unit) before_slopes.name = (trum_real)by_->name;
  TRUM_SLOPES_IN(TRUM_LOAD)
#undef TRUM_LOAD
  trum_plain_regions_slopes(&cycle, &before, &before_slopes, res_);
  for (by = k = 0; by < 2; ++by)
    for (phase = 0; phase < 2; ++phase)
      for (r = 0; r < TRUM_REGIONS; ++r)
        for (part = 0; part < 2; ++part) search->region_slopes[by][r][2 * phase + part] = res_[k++];
}

/* Slopes of the figures, when the orbit is found: d0 is that of the start speed which the lap reproduces. */
static void trum_store_slopes(const trum_lanes* lanes, int i, trum_search* search) {
  const trum_lap* lap = &lanes->lap;
  const double whole = lane_value(&lanes->cycle_time, i), growth = lane_value(&lanes->S, i),
               pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
  const double x = lane_value(&lap->x, i) / whole, S = lane_value(&lap->S, i) / whole,
               xS = lane_value(&lap->xS, i) / whole;
  int parameter;
  for (parameter = 0; parameter < PARAMETERS; ++parameter) {
    double(*of)[PARAMETERS] = search->slopes_out->of;
    if (search->stage == STAGE_HELD) {
      if (search->held_laps != 1)
        of[TRUM_OF_CONTACT][parameter] = lane_value(&lap->d_angle[parameter], i) / whole / 3.14159265358979323846;
      if (search->held_laps != 2) of[TRUM_OF_HELD][parameter] = lane_value(&lap->d_friction[parameter], i) / whole;
    } else {
      const double d0 = lane_value(&lanes->slopes_x[parameter], i) / pull,
                   d_x = lane_value(&lap->d_x[parameter], i) / whole;
      of[TRUM_OF_MEAN][parameter] = d_x + S * d0;
      of[TRUM_OF_LOW][parameter] = lane_value(&lap->d_low[parameter], i) + lane_value(&lap->S_low, i) * d0;
      of[TRUM_OF_HIGH][parameter] = lane_value(&lap->d_high[parameter], i) + lane_value(&lap->S_high, i) * d0;
      of[TRUM_OF_VARIANCE][parameter] =
          2.0 * (lane_value(&lap->d_xx[parameter], i) / whole - x * d_x + (xS - x * S) * d0);
    }
  }
}

/* The next lap's slopes are not looked after: nothing is known of their size. */
static void trum_reset_slope_scales(trum_search* search) {
  int k;
  search->growth_scale = 1e300;
  for (k = 0; k < PARAMETERS; ++k) search->friction_scale[k] = search->angle_scale[k] = 1e300;
}

/* The rough level that makes one fine lap enough: Newton's step from there leaves its square. */
static double trum_rough_level(double tolerance) { return trum_step_share * 0.1 * sqrt(tolerance); }

/* A point's search for its orbit begins from rest, or from where it is known to begin; 0 if no speed balances the load.
 */
static int trum_start_search(trum_lanes* lanes, int i, trum_search* search, double known) {
  const trum_orbit_in* in = search->in;
  if (!(in->push > fabs(in->drag))) {
    search->out->flags += trum_runaway;
    return 0;
  }
  search->stage = STAGE_ROUGH, search->level = trum_step_share * trum_first_lap_tolerance;
  search->speed_scale = 0.1 * in->D * in->k_c * in->W * (in->omega_n + in->Delta_omega);
  if (!isnan(known)) search->start_speed = known, search->laps = 1;
  trum_start_lap(lanes, i, search);
  return 1;
}

/* Puts a piece of a point's work into a lane: its rotor held, or the search for its orbit, from where that begins if it
 * is known.  0 if there is nothing to do. */
static int trum_load_task(trum_lanes* lanes, int i, trum_search* search, const trum_orbit_in* in, trum_orbit_out* out,
                          int held, double known) {
  const double period = 6.283185307179586477 / (in->omega_n + in->Delta_omega);
  trum_cycle_constants cycle;
  trum_free_motion before;
  trum_real res_[trum_regions_n_res];
  int r, phase;
  set_lane(&lanes->constants.omega_n, i, in->omega_n), set_lane(&lanes->constants.Delta_omega, i, in->Delta_omega),
      set_lane(&lanes->constants.xi, i, in->xi);
  set_lane(&lanes->constants.s, i, in->s), set_lane(&lanes->constants.W, i, in->W),
      set_lane(&lanes->constants.D, i, in->D), set_lane(&lanes->constants.k_c, i, in->k_c);
  set_lane(&lanes->constants.engagement_per_height, i, in->engagement_per_height),
      set_lane(&lanes->constants.W_full, i, in->W_full);
  set_lane(&lanes->constants.p_re, i, cos(in->psi)), set_lane(&lanes->constants.p_im, i, sin(in->psi));
  set_lane(&lanes->period, i, period), set_lane(&lanes->cycle_time, i, period * in->m);
  trum_load_cycle(in, &cycle, &before);
  trum_plain_regions(&cycle, &before, res_);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    search->pulses[r] = floor(res_[trum_regions_out_time_redu + r] / period + 0.5);
    for (phase = 0; phase < 2; ++phase) {
      trum_phasor_in at;
      trum_phasor_out z;
      at.a = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase];
      at.b = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase + 1];
      at.omega_n = (trum_real)in->omega_n, at.xi = (trum_real)in->xi;
      trum_plain_phasor(&at, &z);
      search->region_start[r][2 * phase] = z.re, search->region_start[r][2 * phase + 1] = z.im;
    }
  }
  search->in = in, search->out = out;
  search->laps = search->refinements = search->bisect_next = 0, search->last_newton_step = search->last_lap_error = 0.0,
  search->contraction = 1.0;
  search->stage = STAGE_HELD, search->start_speed = 0.0, search->bracket_low = -HUGE_VAL,
  search->bracket_high = HUGE_VAL;
  search->speed_scale = 0.0, search->level = trum_step_share * in->tolerance;
  search->held_laps = 0, trum_reset_slope_scales(search);
  if (lanes->slopes) trum_load_region_slopes(search);
  if (!held) return trum_start_search(lanes, i, search, known);
  trum_start_lap(lanes, i, search);
  return 1;
}

/* Errors of the next lap's slopes are measured by what this one has added up. */
static void trum_update_slope_scales(const trum_lanes* lanes, int i, trum_search* search, double growth) {
  int k;
  search->growth_scale = growth;
  for (k = 0; k < PARAMETERS; ++k) {
    search->friction_scale[k] = lane_value(&lanes->lap.sum_abs_friction[k], i) + 1e-250,
    search->angle_scale[k] = lane_value(&lanes->lap.sum_abs_angle[k], i) + 1e-250;
  }
}

/* A lap is over: the next one, or 0 when the point is done.  Gain falls as the start rises: Newton in a bracket. */
static int trum_finish_lap(trum_lanes* lanes, int i, trum_search* search) {
  const trum_orbit_in* in = search->in;
  trum_orbit_out* out = search->out;
  const trum_lap* lap = &lanes->lap;
  const double whole = lane_value(&lanes->cycle_time, i);
  const int lost = mask_in_lane(lanes->failed, i);
  if (search->stage == STAGE_HELD) {
    out->contact = lost ? NAN : lane_value(&lap->angle, i) / whole / 3.14159265358979323846;
    out->held = lost ? NAN : lane_value(&lap->friction, i) / whole;
    if (lanes->slopes && !lost) trum_store_slopes(lanes, i, search);
    if (lanes->slopes && !lost &&
        search->held_laps < 2) { /* once more for the friction, and for the contact by itself */
      if (!search->held_laps) trum_update_slope_scales(lanes, i, search, 1e300);
      ++search->held_laps;
      trum_start_lap(lanes, i, search);
      return 1;
    }
    if (lane_value(&lap->full_contact, i) > 0.0) out->flags += trum_full_contact;
    return 0;
  }
  if (lost) { /* steps that are too bold chatter where the rotor is as fast as a line of contact */
    const double fine = trum_step_share * in->tolerance;
    if (++search->refinements > 3) return 0;
    search->level = search->level > fine ? fine : 0.1 * search->level, ++search->laps;
    trum_start_lap(lanes, i, search);
    return 1;
  }
  {
    const double gain = lane_value(&lanes->x, i), growth = lane_value(&lanes->S, i),
                 pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
    const double low = lane_value(&lap->low, i), high = lane_value(&lap->high, i),
                 bound = 1.5 * lane_value(&lap->fastest, i);
    const double top = fabs(search->start_speed + low) > fabs(search->start_speed + high)
                           ? fabs(search->start_speed + low)
                           : fabs(search->start_speed + high);
    const double fine = trum_step_share * in->tolerance;
    const int accurate = search->level <= fine * 1.0001, last = ++search->laps >= trum_max_laps;
    /* a Newton step this small leaves an error of its square: the figures' derivatives take it along, slopes do not */
    const double nearly =
        top * (lanes->slopes && search->stage == STAGE_FINE ? in->tolerance : sqrt(0.1 * in->tolerance));
    const int coarse = search->laps == 1 && !accurate;
    const double missed = lane_value(&lap->error, i) * in->push, noise = missed / pull,
                 was = search->level * search->speed_scale;
    double next = search->start_speed + gain / pull, away, left;
    int inside, pinned, close;
    if (!coarse || fabs(gain) > 10.0 * missed) {
      if (gain > 0.0) search->bracket_low = search->start_speed, search->gain_low = gain;
      else search->bracket_high = search->start_speed, search->gain_high = gain;
    }
    next = next > bound ? bound : next < -bound ? -bound : next;
    /* Newton's step is not taken out of the bracket, nor if it is not getting shorter: it may go round in circles */
    inside = next > search->bracket_low && next < search->bracket_high &&
             fabs(next - search->start_speed) <= 0.5 * search->last_newton_step;
    if (!inside && search->bracket_low > -HUGE_VAL && search->bracket_high < HUGE_VAL) {
      const double share = search->bisect_next ? 0.5 : search->gain_low / (search->gain_low - search->gain_high);
      next = search->bracket_low + share * (search->bracket_high - search->bracket_low),
      search->bisect_next = !search->bisect_next;
    }
    away = next - search->start_speed;
    pinned = !coarse && (fabs(away) <= noise || search->bracket_high - search->bracket_low <= 1e-15 * bound);
    /* what Newton's step leaves is its square, or what a lap keeps of it, and of the steps' errors a part: most cancel
     */
    left = fabs(away) * (growth < fabs(away) / top ? growth : fabs(away) / top) + 0.3 * noise;
    if (search->last_newton_step > 10.0 * search->last_lap_error)
      search->contraction = fabs(away) < search->last_newton_step ? fabs(away) / search->last_newton_step : 1.0;
    search->last_newton_step = fabs(away), search->last_lap_error = noise;
    close = accurate ? fabs(away) <= nearly && fabs(away) * search->contraction <= in->tolerance * top : left <= nearly;
    close = close || pinned;
    if (lanes->slopes) trum_update_slope_scales(lanes, i, search, pull);
    /* the less a lap pulls speeds together, the more an error of a step weighs */
    search->speed_scale =
        top * (pull > 1e-3 ? pull : 1e-3 * (in->push * whole < top ? pull + in->push * whole / top : 1.0));
    if (lanes->slopes && search->stage == STAGE_ROUGH) { /* the orbit is known, and now its slopes' size is */
      search->stage = STAGE_FINE, search->level = fine, search->bracket_low = -HUGE_VAL,
      search->bracket_high = HUGE_VAL;
      trum_start_lap(lanes, i, search);
      return 1;
    }
    if (close && accurate && noise > in->tolerance * top && !last && ++search->refinements <= 3) {
      const double excess = in->tolerance * top / noise;
      search->level *= 0.3 * (excess > 0.01 ? excess : 0.01);
    } else if (close && (accurate || last)) {
      const double mean = lane_value(&lap->x, i) / whole, mean_S = lane_value(&lap->S, i) / whole;
      const double square = lane_value(&lap->xx, i) / whole, mean_xS = lane_value(&lap->xS, i) / whole;
      const double variance = square - mean * mean + 2.0 * away * (mean_xS - mean * mean_S);
      if (lanes->slopes) trum_store_slopes(lanes, i, search);
      out->mean = search->start_speed + mean + away * mean_S;
      out->low = search->start_speed + low + away * lane_value(&lap->S_low, i),
      out->high = search->start_speed + high + away * lane_value(&lap->S_high, i);
      /* Newton's last change leaves the order of nearly equal speeds open */
      out->low = out->low < out->mean ? out->low : out->mean, out->high = out->high > out->mean ? out->high : out->mean;
      out->variance = variance > 0.0 ? variance : 0.0;
      out->start = next, out->level = search->level, out->error = noise / top;
      if (noise <= in->tolerance * top) out->flags += trum_converged;
      return 0;
    }
    if (last) { /* the best there is, and not flagged as converged */
      out->mean = search->start_speed + lane_value(&lap->x, i) / whole, out->low = search->start_speed + low,
      out->high = search->start_speed + high;
      out->variance =
          lane_value(&lap->xx, i) / whole - (lane_value(&lap->x, i) / whole) * (lane_value(&lap->x, i) / whole);
      out->start = search->start_speed, out->level = search->level, out->error = fabs(away) / top;
      return 0;
    }
    if (close) {
      /* the steps' errors add up to what follows the level's power 3/4 */
      const double ratio = fine * search->speed_scale / was, expected = noise * sqrt(ratio) * sqrt(sqrt(ratio));
      const double excess = in->tolerance * top / expected;
      search->level = excess < 1.0 ? fine * 0.5 * (excess > 0.01 ? excess : 0.01) : fine;
      search->stage = STAGE_FINE, search->bracket_low = -HUGE_VAL, search->bracket_high = HUGE_VAL;
    } else if (coarse) {
      search->level = trum_rough_level(in->tolerance);
    }
    search->start_speed = next;
  }
  trum_start_lap(lanes, i, search);
  return 1;
}

static void trum_initialise_lanes(trum_lanes* lanes, int hertz, int slopes) {
  int k;
  lanes->active = lanes->at_lap_start = lanes->failed = lanes->contact_only = mask_all(0), lanes->hertz = hertz,
  lanes->slopes = slopes, lanes->record = 0;
  for (k = 0; k < EVENT_COUNT; ++k) lanes->at_event[k] = mask_all(0), lanes->events[k] = TRUM_NUMBER(0);
  lanes->tau = lanes->time_left = lanes->h = lanes->step_size = lanes->curvature = lanes->target_event =
      lanes->retries = lanes->steps_left = TRUM_NUMBER(0);
}

#endif
