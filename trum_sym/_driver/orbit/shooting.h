/* Shooting: the start speed that a lap reproduces, by Newton on the lap within a bracket.
 *
 * The gain of speed over a lap falls as the start speed rises, with slope growth - 1 between -1 and 0 (friction draws
 * speeds together), so the root is unique.  A gain whose sign is certain in spite of the lap's errors bounds it.
 * Newton's step is gain / (1 - growth); where it leaves the bracket or does not shrink, false position and bisection
 * take turns.  Newton's step is believed where laps around it draw speeds together alike; near the largest load, where
 * most laps are saturated, the bracket is. */
#ifndef TRUM_ORBIT_SHOOTING_H
#define TRUM_ORBIT_SHOOTING_H

/* The level of laps far from the orbit: their start is known so well in the end that one fine lap is enough. */
static trum_real trum_rough_level(trum_real tolerance) { return TRUM_C(0.2) * trum_pow(tolerance, TRUM_C(0.8)); }

/* That of laps whose segments are side by side: their figures are known to the second order in what these begin beside. */
static trum_real trum_side_by_side_level(trum_real tolerance) { return TRUM_C(0.03) * trum_sqrt(tolerance); }

/* The level at which a lap's own errors, which are `excess` times the tolerance at the level of this one, would be a
 * third of it.  A finer level has more steps, whose errors add up, so that these fall more slowly than the level. */
static trum_real trum_level_for(trum_real level, trum_real excess) {
  return level * trum_pow(trum_larger(TRUM_C(0.35) / excess, TRUM_C(1e-3)), TRUM_C(1.2));
}

/* What a finished lap says of the orbit. */
typedef struct {
  trum_real gain, growth, decay;     /* of speed over the lap; S at its end; 1 - growth */
  trum_real off;                     /* what it is off by, at most */
  trum_real exact_gain, uncertainty; /* the gain without the lap's errors; what it may still be off by */
  trum_real top, bound;              /* the largest speed of the lap; above all speeds that are possible */
  trum_real newton, saturated_gain;  /* Newton's step; the gain of a lap with saturated friction, where that is smaller */
  trum_real change, trusted;         /* of ln decay since the lap before; how far around decay is alike */
  trum_real slope_error;             /* of the lap's slope, beside that of the secant to the lap before */
  trum_real share;                   /* of Newton's step that is uncertain, as the slope is off */
  int certain, known;             /* has the exact gain a certain sign?  is Newton's step to be believed? */
  int loose;                      /* is the gain uncertain for the jumps between segments most? */
  int accurate, last;             /* at the fine level; no more laps are allowed */
} trum_lap_summary;

/* Reads off a lap that has ended, and counts it. */
static trum_lap_summary trum_summarise_lap(trum_search* search) {
  const trum_lap_sums* lap = &search->lap;
  const trum_orbit_in* in = search->in;
  const trum_real error = lap->error, v0 = search->v0;
  trum_lap_summary s;
  s.gain = lap->end - (search->start_speed - v0), s.growth = lap->growth;
  s.decay = trum_larger(1 - s.growth, trum_least_decay);
  s.off = (1 + trum_first_order_share) * trum_fabs(error) + lap->remainder;
  s.exact_gain = s.gain - error, s.uncertainty = TRUM_C(0.1) * trum_fabs(error) + lap->remainder;
  s.bound = TRUM_C(1.5) * lap->fastest;
  s.top = trum_larger(trum_fabs(v0 + lap->low), trum_fabs(v0 + lap->high));
  s.newton = s.gain / s.decay;
  s.saturated_gain = (in->push - trum_fabs(in->drag)) * search->cycle_time;
  s.certain = trum_fabs(s.exact_gain) > s.uncertainty, s.loose = search->jumps > TRUM_C(0.5) * s.uncertainty;
  s.accurate = search->level <= trum_fine_level(in->tolerance) * TRUM_C(1.0001), s.last = ++search->laps >= trum_max_laps;
  return s;
}

/* Compares a lap with the one before: how far laps draw speeds together alike, and whether Newton's step stays within a
 * part of that. */
static void trum_compare_laps(const trum_search* search, trum_lap_summary* s) {
  const trum_newton_record* before = &search->newton;
  const trum_real distance = trum_fabs(search->start_speed - before->start), allowed = search->in->tolerance * s->top;
  const trum_real step = trum_fabs(s->newton) + s->uncertainty / s->decay;
  const trum_real beside = step * step * search->lap.nearness; /* at which S jumps with a moment's saturation */
  trum_real secant_error = before->slope_error;
  s->change = before->decay > 0 ? trum_fabs(trum_log(s->decay / before->decay)) : TRUM_HUGE;
  s->trusted = s->change < TRUM_C(0.7) ? trum_larger(distance, before->trusted - distance) : 0;
  if (distance * s->decay > 30 * (s->uncertainty + before->uncertainty)) {
    const trum_real secant = (before->exact_gain - s->exact_gain) / (search->start_speed - before->start);
    secant_error = 2 * trum_fabs(secant / s->decay - 1);
  }
  s->slope_error = s->change + secant_error < 1 ? s->change + secant_error : 1;
  /* from the orbit to where laps are saturated the decay falls to 0, so it changes as the gain does */
  s->share = TRUM_C(0.02) + s->slope_error + 10 * trum_fabs(s->gain) / s->saturated_gain + 8 * beside;
  if (s->share > 1) s->share = 1;
  s->known = s->change < TRUM_C(0.7) && trum_fabs(s->gain) <= TRUM_C(0.1) * s->saturated_gain && beside < TRUM_C(0.0625) &&
             step <= trum_larger(TRUM_C(0.1) * s->trusted, TRUM_C(0.05) * allowed);
}

/* By how much more than a lap's lowest and highest speed others may move, when its start changes so that its end changes by
 * `change`.  Any speed moves by `growth` to 1 times the start's change, so that by which they differ is no more than the
 * end's, for certain; and the start is off by the lap's own errors, twice. */
static trum_real trum_rival(trum_real off, trum_real change) { return (change + 2 * off) / trum_bound_safety; }

/* What the change of the start speed is uncertain by: Newton's step in the ratio in which its slope is off, or the
 * bracket. */
static trum_start_change trum_uncertain_change(const trum_search* search, const trum_lap_summary* s, trum_real change) {
  const trum_real width = search->bracket.sure_high - search->bracket.sure_low;
  trum_start_change start;
  start.change = s->known ? s->newton : change;
  start.uncertainty = s->known ? trum_fabs(s->newton) * s->share : TRUM_HUGE;
  if (width < 2 * s->bound && width < start.uncertainty) start.uncertainty = width;
  start.rival = trum_rival(s->off, trum_fabs(s->gain));
  return start;
}

/* Moves an end of the bracket to the lap's start speed, if the sign of its gain is certain.  A fine lap overrules rough
 * ones, and any lap coarse ones: the other end is wrong if it is on the wrong side, or closer than the gain, which falls by no
 * more than the start speed rises. */
static void trum_update_bracket(trum_search* search, const trum_lap_summary* s) {
  trum_bracket* b = &search->bracket;
  const trum_real start = search->start_speed;
  const int overrules = s->accurate || b->coarse;
  b->coarse = 0;
  if (!s->certain) return;
  if (s->exact_gain > 0) {
    b->low = start, b->gain_low = s->exact_gain;
    if (s->accurate) b->sure_low = start;
    if (!(b->high > start + (overrules ? s->exact_gain - s->uncertainty : 0))) b->high = b->sure_high;
  } else {
    b->high = start, b->gain_high = s->exact_gain;
    if (s->accurate) b->sure_high = start;
    if (!(b->low < start + (overrules ? s->exact_gain + s->uncertainty : 0))) b->low = b->sure_low;
  }
}

/* The next start speed: Newton's, or a division of the bracket where that is not to be believed, and leaves the bracket
 * or is not half the step before. */
static trum_real trum_next_start(trum_search* search, const trum_lap_summary* s) {
  trum_bracket* b = &search->bracket;
  trum_real next = search->start_speed + s->exact_gain / s->decay;
  next = next > s->bound ? s->bound : next < -s->bound ? -s->bound : next;
  if (s->known && next > b->sure_low && next < b->sure_high) return next;
  if (next > b->low && next < b->high && trum_fabs(next - search->start_speed) <= TRUM_C(0.5) * search->newton.last_step)
    return next;
  if (b->low > -TRUM_HUGE && b->high < TRUM_HUGE) {
    const trum_real ratio = b->gain_low / -b->gain_high; /* one end is saturated if the other's gain is much larger */
    const trum_real share =
        b->bisect_next || ratio > 10 || ratio < TRUM_C(0.1) ? TRUM_C(0.5) : b->gain_low / (b->gain_low - b->gain_high);
    next = b->low + share * (b->high - b->low), b->bisect_next = !b->bisect_next;
  }
  return next;
}

/* The speed that errors of the next lap are measured by: the smaller the decay, the more an error of a step weighs. */
static trum_real trum_scale_of(const trum_search* search, trum_real top, trum_real decay) {
  const trum_real reach = search->in->push * search->cycle_time;
  return top * (decay > TRUM_C(1e-3) ? decay : TRUM_C(1e-3) * (reach < top ? decay + reach / top : 1));
}

/* A lap of the held rotor has ended.  Without slopes it is repeated until its bounds meet the tolerance; with slopes
 * there are two more, one with errors measured by the friction's slopes and one by the contact's. */
static int trum_finish_held_lap(const trum_lanes* lanes, trum_search* search) {
  const int met = trum_store_held(search);
  trum_orbit_out* out = search->out;
  if (with_slopes(lanes)) trum_store_slopes(search);
  if (with_slopes(lanes) && search->held_laps < 2) {
    if (!search->held_laps) trum_update_slope_scales(search, trum_unmeasured);
    ++search->held_laps;
    return 1;
  }
  if (!with_slopes(lanes) && !met && ++search->refinements <= 6) {
    const trum_real error = trum_larger(out->contact_error, out->held_error);
    search->level = trum_level_for(search->level, error / search->in->tolerance);
    return 1;
  }
  if (search->lap.full_contact > 0) out->flags += trum_full_contact;
  return 0;
}

/* Repeats a lap: in turn, if its segments were side by side; one that could not be followed with shorter steps, a few times at
 * most: steps that are too long alternate between the sides of a line contact that is as fast as the rotor.  But not for
 * want of steps if one with longer steps was followed. */
static int trum_repeat_lap(trum_search* search) {
  const trum_real fine_level = trum_fine_level(search->in->tolerance);
  const int too_short = search->out_of_steps && search->newton.last_bound > 0;
  if (search->side_by_side && !too_short) {
    trum_integrate_in_turn(search), ++search->laps;
    return 1;
  }
  if (too_short || ++search->refinements > 3) {
    search->out->flags += search->out_of_steps ? (trum_real)trum_too_many_steps : (trum_real)trum_failed_step;
    return 0;
  }
  search->level = search->level > fine_level ? fine_level : TRUM_C(0.1) * search->level, ++search->laps;
  return 1;
}

/* The bound of a lap's figures over its largest speed, were its start off by no more than the lap's own errors make it, and
 * its segments where they belong.  Stores nothing. */
static trum_real trum_own_bound(trum_search* search, const trum_lap_summary* s) {
  const trum_lap_sums* lap = &search->lap;
  const trum_real error = trum_fabs(lap->error), uncertainty = s->share * error / s->decay;
  const trum_orbit_out kept = *search->out;
  trum_start_change own;
  trum_real bound;
  own.change = s->newton, own.uncertainty = uncertainty, own.rival = trum_rival(s->off - search->jumps, error);
#if TRUM_SEGMENTS > 1
  trum_lap_sums joined;
  if (search->side_by_side) trum_join_segments(search, &joined, 0, 0), lap = &joined;
#endif
  trum_store_orbit(search, lap, own, s->top);
  bound = search->out->error, *search->out = kept;
  return bound;
}

/* After a fine lap of a known start: shorter steps if its own errors are too large, the next of which are to be better. */
static void trum_shorten_steps(trum_search* search, const trum_lap_summary* s) {
  const trum_real bound = trum_own_bound(search, s), excess = bound / search->in->tolerance;
  trum_newton_record* newton = &search->newton;
  if (excess <= 1) return;
  newton->in_vain = trum_fabs(bound - newton->last_bound) < TRUM_C(0.1) * bound ? newton->in_vain + 1 : 0;
  newton->last_bound = bound;
  if (++search->refinements <= 12) search->level = trum_level_for(search->level, excess);
}

/* After a fine lap whose bounds do not meet the tolerance: shorter steps, or from a better start, or on both sides of a
 * start whose gain has no certain sign.  Returns the next start. */
static trum_real trum_refine(trum_search* search, const trum_lap_summary* s, trum_real next) {
  const trum_real allowed = search->in->tolerance * s->top;
  const trum_real width = search->bracket.high - search->bracket.low, middle = search->start_speed;
  trum_newton_record* newton = &search->newton;
  if (s->known) {
    trum_shorten_steps(search, s);
    return next;
  }
  if (s->certain || s->loose) return next;
  newton->last_step = TRUM_HUGE;
  if (width <= TRUM_C(0.5) * allowed || ++newton->probes > 8) {
    search->level *= TRUM_C(0.1), ++search->refinements, newton->probes = 0;
    return next;
  }
  next = TRUM_C(0.3) * allowed * trum_pow(TRUM_C(3.0), (trum_real)(newton->probes / 2));
  next = search->bracket.high - middle > middle - search->bracket.low ? middle + next : middle - next;
  if (next < search->bracket.high && next > search->bracket.low) return next;
  return TRUM_C(0.5) * (search->bracket.low + search->bracket.high);
}

/* A lap with slopes along an orbit that is known: the first one measures them, the next ones end when their start is
 * good enough.  Returns 1 if there is another lap to do. */
static int trum_finish_lap_with_slopes(trum_search* search, const trum_lap_summary* s, trum_real change) {
  trum_update_slope_scales(search, s->decay);
  if (search->stage == STAGE_ROUGH) {
    search->stage = STAGE_FINE, search->level = trum_fine_level(search->in->tolerance);
    search->scales.speed = s->top * trum_larger(s->decay, TRUM_C(1e-3));
    return 1;
  }
  trum_store_slopes(search);
  return trum_fabs(change) > search->in->tolerance * s->top && s->certain && !s->last;
}

/* After a lap far from the orbit: its last figures if no more are allowed (returns 0), or a finer level. */
static int trum_finish_rough_lap(trum_search* search, const trum_lap_summary* s, trum_real change) {
  const trum_real nearly = s->top * trum_sqrt(TRUM_C(0.1) * search->in->tolerance);
  /* where laps forget their start, the next one begins close to the orbit however far this one did */
  const int forgets = 5 * s->growth * trum_fabs(change) <= nearly && s->growth < TRUM_C(0.1) &&
                      trum_fabs(change) >= TRUM_C(0.9) * trum_fabs(s->newton);
  if (s->last) {
    const trum_start_change start = {change, TRUM_HUGE, 0};
    trum_store_orbit(search, &search->lap, start, s->top);
    search->out->flags += trum_too_many_laps;
    return 0;
  }
  if ((trum_fabs(change) <= nearly && s->change < TRUM_C(0.7)) || forgets || (!s->certain && !s->loose) ||
      search->bracket.high - search->bracket.low <= nearly) {
    const trum_real fine_level = trum_fine_level(search->in->tolerance);
    trum_real wanted = fine_level;
    if (s->known) /* what a lap elsewhere is off by says little */
      wanted = trum_level_for(search->level, trum_own_bound(search, s) / search->in->tolerance);
    search->stage = STAGE_FINE, search->level = wanted < fine_level ? wanted : fine_level;
  } else if (search->laps == 1) {
    search->level = trum_rough_level(search->in->tolerance);
  }
  return 1;
}

/* The bounds after a fine lap: 1 if they meet the tolerance, or if no more laps are allowed. */
static int trum_finish_fine_lap(trum_search* search, const trum_lap_summary* s, trum_real change) {
  trum_store_orbit(search, &search->lap, trum_uncertain_change(search, s, change), s->top);
  if (search->out->error <= search->in->tolerance) search->out->flags += trum_converged;
  else if (s->last) search->out->flags += trum_too_many_laps;
  else return 0;
  return 1;
}

/* What is kept of a lap for the next one. */
static void trum_record_lap(trum_search* search, const trum_lap_summary* s) {
  trum_newton_record* newton = &search->newton;
  newton->start = search->start_speed, newton->decay = s->decay, newton->exact_gain = s->exact_gain;
  newton->uncertainty = s->uncertainty, newton->trusted = s->trusted, newton->slope_error = s->slope_error;
  search->top = s->top;
}

/* The start of the next lap of the search, whose segments begin where they did in the one before but for its change, or where
 * the orbit is known to have them. */
static void trum_go_on(trum_search* search, trum_real next, int known) {
  const trum_real change = next - search->start_speed;
  int k;
  search->start_speed = next;
  trum_prepare_lap(search, change);
  for (k = 1; known && search->side_by_side && k < search->segments; ++k) search->at[k].speed = search->about->at[k].speed;
}

/* The speeds at which the orbit's segments begin. */
static void trum_keep_boundaries(trum_search* search) {
  const trum_real change = search->out->start - search->start_speed;
  int k;
  search->about->found = !search->in_turn;
  for (k = 0; k < search->segments; ++k) search->about->at[k].speed = search->at[k].speed + search->at[k].S * change;
}

/* What follows a lap that has ended: stores figures, or prepares the next lap.  Returns 0 when the task is done. */
static int trum_finish_lap(const trum_lanes* lanes, trum_search* search) {
  trum_lap_summary s;
  trum_real next;
  int known_start;
  if (search->failed || !trum_may_join(search)) {
    if (!trum_repeat_lap(search)) return 0;
    trum_go_on(search, search->start_speed, 0);
    return 1;
  }
  trum_join_lap(search, with_slopes(lanes));
  if (search->stage == STAGE_HELD) {
    if (!trum_finish_held_lap(lanes, search)) return 0;
    trum_go_on(search, search->start_speed, 0);
    return 1;
  }
  s = trum_summarise_lap(search);
  trum_compare_laps(search, &s);
  trum_update_bracket(search, &s);
  next = trum_next_start(search, &s), search->newton.last_step = trum_fabs(next - search->start_speed);
  known_start = with_slopes(lanes) && search->stage == STAGE_ROUGH; /* is kept for the lap whose slopes count */
  if (with_slopes(lanes)) {
    if (!trum_finish_lap_with_slopes(search, &s, next - search->start_speed)) return 0;
    if (known_start) next = search->start_speed;
  } else if (s.accurate) {
    if (trum_finish_fine_lap(search, &s, next - search->start_speed)) {
      trum_keep_boundaries(search);
      return 0;
    }
    next = trum_refine(search, &s, next);
    if (search->newton.in_vain > 1) {
      search->out->flags += trum_rounding_limit;
      return 0;
    }
  } else if (!trum_finish_rough_lap(search, &s, next - search->start_speed)) {
    return 0;
  }
  if (!with_slopes(lanes)) search->scales.speed = trum_scale_of(search, s.top, s.decay);
  trum_record_lap(search, &s);
  trum_go_on(search, next, known_start);
  return 1;
}

#endif
