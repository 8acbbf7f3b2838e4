/* Shooting: the start speed that a lap reproduces, by Newton on the lap within a bracket.
 *
 * The gain of speed over a lap falls as the start speed rises, with slope growth - 1 between -1 and 0 (friction draws
 * speeds together), so the root is unique.  Newton's step is gain / (1 - growth); where it leaves the bracket or does
 * not shrink, false position and bisection take turns.  The errors of a lap's steps can only add up, to error in the
 * start speed of their sum over (1 - growth). */
#ifndef TRUM_ORBIT_SHOOTING_H
#define TRUM_ORBIT_SHOOTING_H

/* The level of laps far from the orbit: Newton's step from there leaves its square, so that one fine lap is enough. */
static double trum_rough_level(double tolerance) { return trum_step_share * 0.1 * sqrt(tolerance); }

/* Slopes of the figures once the orbit is found.  The start speed follows a parameter by the implicit function theorem:
 * d0 = dx(end) / (1 - growth). */
static void trum_store_slopes(const trum_lanes* lanes, int i, trum_search* search) {
  const trum_lap* lap = &lanes->lap;
  const double whole = lane_value(&lanes->equation.cycle_time, i), growth = lane_value(&lanes->start.S, i);
  const double decay = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
  const double x = lane_value(&lap->x, i) / whole, S = lane_value(&lap->S, i) / whole;
  const double xS = lane_value(&lap->xS, i) / whole;
  int parameter;
  for (parameter = 0; parameter < PARAMETERS; ++parameter) {
    double(*of)[PARAMETERS] = search->slopes_out->of;
    if (search->stage == STAGE_HELD) {
      if (search->held_laps != 1)
        of[TRUM_OF_CONTACT][parameter] = lane_value(&lap->d_angle[parameter], i) / whole / 3.14159265358979323846;
      if (search->held_laps != 2) of[TRUM_OF_HELD][parameter] = lane_value(&lap->d_friction[parameter], i) / whole;
    } else {
      const double d0 = lane_value(&lanes->sensitivity.x[parameter], i) / decay;
      const double d_x = lane_value(&lap->d_x[parameter], i) / whole;
      of[TRUM_OF_MEAN][parameter] = d_x + S * d0;
      of[TRUM_OF_LOW][parameter] = lane_value(&lap->d_low[parameter], i) + lane_value(&lap->S_low, i) * d0;
      of[TRUM_OF_HIGH][parameter] = lane_value(&lap->d_high[parameter], i) + lane_value(&lap->S_high, i) * d0;
      of[TRUM_OF_VARIANCE][parameter] =
          2.0 * (lane_value(&lap->d_xx[parameter], i) / whole - x * d_x + (xS - x * S) * d0);
    }
  }
}

/* Errors of the next lap's slopes are measured by what this one has summed up. */
static void trum_update_slope_scales(const trum_lanes* lanes, int i, trum_search* search, double growth) {
  int k;
  search->scales.growth = growth;
  for (k = 0; k < PARAMETERS; ++k) {
    search->scales.friction[k] = lane_value(&lanes->lap.sum_abs_friction[k], i) + 1e-250;
    search->scales.angle[k] = lane_value(&lanes->lap.sum_abs_angle[k], i) + 1e-250;
  }
}

/* What a finished lap says of the orbit. */
typedef struct {
  double gain, growth, decay; /* of speed over the lap; S at its end; 1 - growth */
  double low, high;           /* extremes over the start speed */
  double top, bound;          /* the largest speed of the lap; above all speeds that are possible */
  double gain_error, error;   /* bounds of the steps' errors in the gain and in the start speed */
  double fine_level;          /* of laps whose figures count */
  int first, accurate, last;  /* coarse first lap; at the fine level; no more laps are allowed */
} trum_lap_summary;

/* Reads off a lap that has ended, and counts it. */
static trum_lap_summary trum_summarise_lap(const trum_lanes* lanes, int i, trum_search* search) {
  const trum_lap* lap = &lanes->lap;
  trum_lap_summary s;
  double at_low, at_high;
  s.gain = lane_value(&lanes->start.x, i), s.growth = lane_value(&lanes->start.S, i);
  s.decay = 1.0 - s.growth > 1e-14 ? 1.0 - s.growth : 1e-14;
  s.low = lane_value(&lap->low, i), s.high = lane_value(&lap->high, i), s.bound = 1.5 * lane_value(&lap->fastest, i);
  at_low = fabs(search->start_speed + s.low), at_high = fabs(search->start_speed + s.high);
  s.top = at_low > at_high ? at_low : at_high;
  s.gain_error = lane_value(&lap->error, i) * search->in->push, s.error = s.gain_error / s.decay;
  s.fine_level = trum_step_share * search->in->tolerance;
  s.accurate = search->level <= s.fine_level * 1.0001, s.last = ++search->laps >= trum_max_laps;
  s.first = search->laps == 1 && !s.accurate;
  return s;
}

/* Moves an end of the bracket to the lap's start speed, unless a coarse lap leaves the sign of its gain open. */
static void trum_update_bracket(trum_search* search, const trum_lap_summary* s) {
  trum_bracket* b = &search->bracket;
  if (s->first && !(fabs(s->gain) > 10.0 * s->gain_error)) return;
  if (s->gain > 0.0) b->low = search->start_speed, b->gain_low = s->gain;
  else b->high = search->start_speed, b->gain_high = s->gain;
}

/* The next start speed: Newton's, or a division of the bracket where that leaves it or is not half the step before. */
static double trum_next_start(trum_search* search, const trum_lap_summary* s) {
  trum_bracket* b = &search->bracket;
  double next = search->start_speed + s->gain / s->decay;
  next = next > s->bound ? s->bound : next < -s->bound ? -s->bound : next;
  if (next > b->low && next < b->high && fabs(next - search->start_speed) <= 0.5 * search->newton.last_step)
    return next;
  if (b->low > -HUGE_VAL && b->high < HUGE_VAL) {
    const double share = b->bisect_next ? 0.5 : b->gain_low / (b->gain_low - b->gain_high);
    next = b->low + share * (b->high - b->low), b->bisect_next = !b->bisect_next;
  }
  return next;
}

/* Whether a change of the start speed is small enough to end the search at this level.  The figures follow the last
 * change to first order, so its square counts; slopes do not follow it. */
static int trum_change_is_small(const trum_lanes* lanes, trum_search* search, const trum_lap_summary* s,
                                double change) {
  const double tolerance = search->in->tolerance, size = fabs(change);
  const double allowed = s->top * (lanes->slopes && search->stage == STAGE_FINE ? tolerance : sqrt(0.1 * tolerance));
  const int at_resolution =
      !s->first && (size <= s->error || search->bracket.high - search->bracket.low <= 1e-15 * s->bound);
  /* a change leaves its square, or what a lap keeps of it, and a part of the steps' errors, most of which cancel */
  const double remaining = size * (s->growth < size / s->top ? s->growth : size / s->top) + 0.3 * s->error;
  trum_newton_record* newton = &search->newton;
  int small;
  if (newton->last_step > 10.0 * newton->last_error)
    newton->contraction = size < newton->last_step ? size / newton->last_step : 1.0;
  newton->last_step = size, newton->last_error = s->error;
  small = s->accurate ? size <= allowed && size * newton->contraction <= tolerance * s->top : remaining <= allowed;
  return small || at_resolution;
}

/* The figures of the orbit from its last lap, moved along by the last change of the start speed. */
static void trum_store_orbit(const trum_lanes* lanes, int i, trum_search* search, const trum_lap_summary* s,
                             double next) {
  const trum_lap* lap = &lanes->lap;
  const double cycle_time = lane_value(&lanes->equation.cycle_time, i);
  const double mean = lane_value(&lap->x, i) / cycle_time, mean_S = lane_value(&lap->S, i) / cycle_time;
  const double square = lane_value(&lap->xx, i) / cycle_time, mean_xS = lane_value(&lap->xS, i) / cycle_time;
  const double change = next - search->start_speed;
  const double variance = square - mean * mean + 2.0 * change * (mean_xS - mean * mean_S);
  trum_orbit_out* out = search->out;
  if (lanes->slopes) trum_store_slopes(lanes, i, search);
  out->mean = search->start_speed + mean + change * mean_S;
  out->low = search->start_speed + s->low + change * lane_value(&lap->S_low, i);
  out->high = search->start_speed + s->high + change * lane_value(&lap->S_high, i);
  /* the last change leaves the order of nearly equal speeds open */
  out->low = out->low < out->mean ? out->low : out->mean, out->high = out->high > out->mean ? out->high : out->mean;
  out->variance = variance > 0.0 ? variance : 0.0;
  out->start = next, out->level = search->level, out->error = s->error / s->top;
  if (s->error <= search->in->tolerance * s->top) out->flags += trum_converged;
}

/* The figures of the last lap that is allowed, not flagged as converged. */
static void trum_store_last_lap(const trum_lanes* lanes, int i, trum_search* search, const trum_lap_summary* s,
                                double change) {
  const double cycle_time = lane_value(&lanes->equation.cycle_time, i);
  const double mean = lane_value(&lanes->lap.x, i) / cycle_time;
  trum_orbit_out* out = search->out;
  out->mean = search->start_speed + mean, out->low = search->start_speed + s->low;
  out->high = search->start_speed + s->high, out->variance = lane_value(&lanes->lap.xx, i) / cycle_time - mean * mean;
  out->start = search->start_speed, out->level = search->level, out->error = fabs(change) / s->top;
}

/* The speed that errors of the next lap are measured by: the smaller the decay, the more an error of a step weighs. */
static double trum_scale_of(const trum_orbit_in* in, const trum_lap_summary* s, double cycle_time) {
  const double reach = in->push * cycle_time;
  return s->top * (s->decay > 1e-3 ? s->decay : 1e-3 * (reach < s->top ? s->decay + reach / s->top : 1.0));
}

/* The level of the first fine lap after one whose error is known: the steps' errors add up to what goes as the level to
 * the power 3/4. */
static double trum_level_after(const trum_search* search, const trum_lap_summary* s, double previous_error) {
  const double ratio = s->fine_level * search->scales.speed / previous_error;
  const double expected = s->error * sqrt(ratio) * sqrt(sqrt(ratio)),
               excess = search->in->tolerance * s->top / expected;
  return excess < 1.0 ? s->fine_level * 0.5 * (excess > 0.01 ? excess : 0.01) : s->fine_level;
}

/* The next lap is a fine one: its level, and a bracket that starts anew as errors differ. */
static void trum_start_fine_laps(trum_search* search, double level) {
  search->stage = STAGE_FINE, search->level = level;
  search->bracket.low = -HUGE_VAL, search->bracket.high = HUGE_VAL;
}

/* A lap of the held rotor has ended.  With slopes there are two more, one with errors measured by the friction's slopes
 * and one by the contact's. */
static int trum_finish_held_lap(trum_lanes* lanes, int i, trum_search* search) {
  const int failed = mask_in_lane(lanes->status.failed, i);
  const double cycle_time = lane_value(&lanes->equation.cycle_time, i);
  trum_orbit_out* out = search->out;
  out->contact = failed ? NAN : lane_value(&lanes->lap.angle, i) / cycle_time / 3.14159265358979323846;
  out->held = failed ? NAN : lane_value(&lanes->lap.friction, i) / cycle_time;
  if (lanes->slopes && !failed) trum_store_slopes(lanes, i, search);
  if (lanes->slopes && !failed && search->held_laps < 2) {
    if (!search->held_laps) trum_update_slope_scales(lanes, i, search, 1e300);
    ++search->held_laps;
    trum_start_lap(lanes, i, search);
    return 1;
  }
  if (lane_value(&lanes->lap.full_contact, i) > 0.0) out->flags += trum_full_contact;
  return 0;
}

/* Repeats a lap that could not be followed with shorter steps, three times at most: steps that are too long alternate
 * between the sides of a line contact that is as fast as the rotor. */
static int trum_repeat_failed_lap(trum_lanes* lanes, int i, trum_search* search) {
  const double fine_level = trum_step_share * search->in->tolerance;
  if (++search->refinements > 3) return 0;
  search->level = search->level > fine_level ? fine_level : 0.1 * search->level, ++search->laps;
  trum_start_lap(lanes, i, search);
  return 1;
}

/* What follows a lap that has ended: stores figures, or starts the next lap.  Returns 0 when the task is done. */
static int trum_finish_lap(trum_lanes* lanes, int i, trum_search* search) {
  const trum_orbit_in* in = search->in;
  trum_lap_summary s;
  double previous_error, next, change;
  int small, done;
  if (search->stage == STAGE_HELD) return trum_finish_held_lap(lanes, i, search);
  if (mask_in_lane(lanes->status.failed, i)) return trum_repeat_failed_lap(lanes, i, search);
  s = trum_summarise_lap(lanes, i, search);
  previous_error = search->level * search->scales.speed;
  trum_update_bracket(search, &s);
  next = trum_next_start(search, &s), change = next - search->start_speed;
  small = trum_change_is_small(lanes, search, &s, change);
  if (lanes->slopes) trum_update_slope_scales(lanes, i, search, s.decay);
  search->scales.speed = trum_scale_of(in, &s, lane_value(&lanes->equation.cycle_time, i));
  if (lanes->slopes && search->stage == STAGE_ROUGH) { /* the first lap from a known orbit has measured its slopes */
    trum_start_fine_laps(search, s.fine_level);
    trum_start_lap(lanes, i, search);
    return 1;
  }
  done = small && (s.accurate || s.last);
  if (done && !s.last && s.error > in->tolerance * s.top && ++search->refinements <= 3) done = 0;
  if (done) {
    trum_store_orbit(lanes, i, search, &s, next);
    return 0;
  }
  if (s.last) {
    trum_store_last_lap(lanes, i, search, &s, change);
    return 0;
  }
  if (small) {
    trum_start_fine_laps(search, trum_level_after(search, &s, previous_error));
  } else if (s.first) {
    search->level = trum_rough_level(in->tolerance);
  }
  search->start_speed = next;
  trum_start_lap(lanes, i, search);
  return 1;
}

#endif
