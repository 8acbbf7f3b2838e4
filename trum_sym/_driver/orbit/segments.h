/* A lap's segments side by side: multiple shooting.
 *
 * From the second lap on it is known about where each segment begins, so that all of a lap's can be integrated at once, in
 * as many lanes as are idle.  A segment begins by `jump` beside where the one before ended, and what that changes in all
 * that follows is known to the first order: S times it, as of a change of the start.  So the segments are joined to the
 * lap from the start speed; the jumps are smaller from lap to lap as Newton's steps are.  The rest of the search
 * (shooting.h) does not see the difference, but for the remainder, which has what the first order leaves out.
 *
 * A rotor whose friction is stiff keeps more of an error than S says, the more the larger the error is (defect.h).  A
 * segment does not know what the lap is off by where it begins; so the laps of such a rotor are integrated in turn. */
#ifndef TRUM_ORBIT_SEGMENTS_H
#define TRUM_ORBIT_SEGMENTS_H

#if TRUM_SEGMENTS > 1

/* What a jump's change of a segment's speeds is uncertain by, over the change: S is that of the segment's own start, and
 * the lap before, which began elsewhere, shows how it differs from one start to another; but it jumps where the change has
 * saturation begin or end for a moment.  Any speed moves by 0 to 1 times the change. */
static trum_real trum_jump_share(const trum_boundary* before, const trum_lap_sums* part, trum_real duration, trum_real change) {
  const trum_real by_end = trum_fabs(part->growth - before->growth), by_mean = trum_fabs(part->S / duration - before->mean_S);
  const trum_real share = trum_least_jump_share + 2 * trum_larger(by_end, by_mean) + 4 * part->nearness * change * change;
  return share < 1 ? share : 1;
}

/* What is known of a lap where a segment begins: by how much the segment's speeds are to be changed, S, error, remainder, and
 * the sensitivities. */
typedef struct {
  trum_real change, S, error, remainder, d[PARAMETERS];
} trum_joint;

/* What is known at a segment's end of change, S and error, from what is at its begin; behind the last, the change of the lap. */
static void trum_pass_segment(const trum_search* search, int segment, trum_joint* at) {
  const trum_lap_sums* part = &search->part[segment];
  at->change *= part->growth, at->error = part->error + at->error * part->growth, at->S *= part->growth;
  if (segment + 1 < search->segments) at->change += part->end - (search->at[segment + 1].speed - search->v0);
}

/* Adds a segment's extremes to a lap's. */
static void trum_join_extremes(trum_lap_sums* lap, const trum_lap_sums* part, const trum_joint* at, trum_real jump, int counted,
                               int slopes) {
  const trum_real low = part->low + at->change * part->S_low, high = part->high + at->change * part->S_high;
  const trum_real off = trum_fabs(at->error) + at->remainder + jump;
  const trum_real least = at->change * (!counted ? part->S_low : at->change < 0 ? 1 : part->growth);
  const trum_real most = at->change * (!counted ? part->S_high : at->change > 0 ? 1 : part->growth);
  int k;
  if (low < lap->low) {
    lap->low = low, lap->S_low = at->S * part->S_low;
    lap->low_error = part->low_error + trum_fabs(at->error) * part->S_low;
    lap->low_remainder = part->low_remainder + at->remainder + jump;
    for (k = 0; slopes && k < PARAMETERS; ++k) lap->d_low[k] = part->d_low[k] + at->d[k] * part->S_low;
  }
  if (high > lap->high) {
    lap->high = high, lap->S_high = at->S * part->S_high;
    lap->high_error = part->high_error + trum_fabs(at->error) * part->S_high;
    lap->high_remainder = part->high_remainder + at->remainder + jump;
    for (k = 0; slopes && k < PARAMETERS; ++k) lap->d_high[k] = part->d_high[k] + at->d[k] * part->S_high;
  }
  if (part->lowest + least - off < lap->lowest) lap->lowest = part->lowest + least - off;
  if (part->highest + most + off > lap->highest) lap->highest = part->highest + most + off;
}

/* Adds a segment's integrals and bounds to a lap's. */
static void trum_join_sums(trum_lap_sums* lap, const trum_lap_sums* part, const trum_joint* at, trum_real jump,
                           trum_real duration, int slopes) {
  const trum_real change = at->change, error = at->error;
  const trum_real root = trum_sqrt(part->remainder_square) + at->remainder * trum_sqrt(part->kept_sum) + jump * trum_sqrt(duration);
  int k;
  lap->x += part->x + change * part->S, lap->xx += part->xx + change * (2 * part->xS + change * part->SS);
  lap->S += at->S * part->S, lap->xS += at->S * (part->xS + change * part->SS), lap->SS += at->S * at->S * part->SS;
  lap->friction += part->friction, lap->angle += part->angle;
  lap->error_sum += part->error_sum + error * part->S;
  lap->error_square += part->error_square + error * (2 * part->error_S + error * part->SS);
  lap->error_S += at->S * (part->error_S + error * part->SS);
  lap->remainder_sum += part->remainder_sum + at->remainder * part->kept_sum + jump * duration;
  lap->remainder_square += root * root, lap->inside += part->inside;
  lap->friction_error += part->friction_error, lap->friction_remainder += part->friction_remainder;
  lap->angle_error += part->angle_error, lap->angle_remainder += part->angle_remainder;
  lap->full_contact = trum_larger(lap->full_contact, part->full_contact);
  lap->fastest = trum_larger(lap->fastest, part->fastest), lap->stiffest = trum_larger(lap->stiffest, part->stiffest);
  lap->nearness += at->S * at->S * at->S * part->nearness;
  for (k = 0; slopes && k < PARAMETERS; ++k) {
    lap->d_x[k] += part->d_x[k] + at->d[k] * part->S, lap->d_xx[k] += part->d_xx[k] + at->d[k] * part->xS;
    lap->d_friction[k] += part->d_friction[k], lap->d_angle[k] += part->d_angle[k];
    lap->sum_abs_friction[k] += part->sum_abs_friction[k], lap->sum_abs_angle[k] += part->sum_abs_angle[k];
  }
}

/* Joins the segments of a lap to its sums.  The share of the jumps that is uncertain is counted unless they are only to be
 * known with what the steps leave; their sum so far, as it is at the lap's end, is returned. */
static trum_real trum_join_segments(const trum_search* search, trum_lap_sums* lap, int counted, int slopes) {
  static const trum_lap_sums none = {0};
  trum_joint at = {0};
  trum_real jumps = 0;
  int k, parameter;
  *lap = none, lap->low = lap->lowest = TRUM_HUGE, lap->high = lap->highest = -TRUM_HUGE, lap->kept = at.S = 1;
  for (k = 0; k < search->segments; ++k) {
    const trum_lap_sums* part = &search->part[k];
    const trum_real duration = search->segment_of[k].duration;
    const trum_real share = counted ? trum_jump_share(&search->at[k], part, duration, at.change) : 0;
    const trum_real jump = share * trum_fabs(at.change);
    trum_join_extremes(lap, part, &at, jump, counted, slopes), trum_join_sums(lap, part, &at, jump, duration, slopes);
    at.remainder = part->remainder + at.remainder * part->kept + jump, jumps = jumps * part->kept + jump;
    trum_pass_segment(search, k, &at);
    for (parameter = 0; slopes && parameter < PARAMETERS; ++parameter)
      at.d[parameter] = part->d_end[parameter] + at.d[parameter] * part->growth;
  }
  lap->end = search->part[search->segments - 1].end + at.change, lap->growth = at.S, lap->error = at.error, lap->remainder = at.remainder;
  for (parameter = 0; slopes && parameter < PARAMETERS; ++parameter) lap->d_end[parameter] = at.d[parameter];
  return jumps;
}

/* Takes the speeds at which the segments begin for what the joined lap has there. */
static void trum_move_boundaries(trum_search* search) {
  trum_joint at = {0};
  int k;
  at.S = 1;
  for (k = 0; k < search->segments; ++k) {
    const trum_lap_sums* part = &search->part[k];
    trum_boundary* begins = &search->at[k];
    trum_pass_segment(search, k, &at);
    begins->growth = part->growth, begins->mean_S = part->S / search->segment_of[k].duration;
    if (k + 1 < search->segments) {
      begins[1].step = part->step, begins[1].speed += at.change, begins[1].S = at.S, begins[1].error = at.error;
    }
  }
}

#endif

/* A segment has been integrated, or the lap with all of them in turn.  Returns 1 if the lap has ended. */
static int trum_end_segment(const trum_lanes* lanes, int i, trum_search* search, int segment) {
  const int failed = mask_in_lane(lanes->status.failed, i);
  search->failed |= failed, search->out_of_steps |= failed && lane_value(&lanes->step.steps_left, i) < 0;
#if TRUM_SEGMENTS > 1
  if (search->side_by_side) {
    trum_read_lap(lanes, i, &search->part[segment]);
    if (search->failed) search->unended -= search->segments - search->segment, search->segment = search->segments;
    return --search->unended == 0;
  }
#endif
  (void)segment;
  trum_read_lap(lanes, i, &search->lap), search->jumps = 0;
  return 1;
}

/* Whether a lap is one: if one of segments side by side is stiff, it is to be repeated with all in turn. */
static int trum_may_join(const trum_search* search) {
#if TRUM_SEGMENTS > 1
  int k;
  for (k = 0; search->side_by_side && search->stage != STAGE_HELD && k < search->segments; ++k)
    if (search->part[k].stiffest > trum_stiff) return 0;
#endif
  (void)search;
  return 1;
}

/* A lap has ended: its sums, and where its segments begin. */
static void trum_join_lap(trum_search* search, int slopes) {
#if TRUM_SEGMENTS > 1
  if (search->side_by_side) {
    search->jumps = trum_join_segments(search, &search->lap, 1, slopes);
    trum_move_boundaries(search);
  }
#endif
  (void)slopes;
  search->steps_level = search->level, search->passed = 1;
  if (search->lap.stiffest > trum_stiff) trum_integrate_in_turn(search);
}

/* Prepares the next lap, whose start speed is set, and is `change` beside that of the lap before. */
static void trum_prepare_lap(trum_search* search, trum_real change) {
  /* a lap at the same level has the same errors again: then the segments begin where those before them end */
  const trum_real without = search->level < search->steps_level ? 1 - search->level / search->steps_level : 0;
  int k;
  search->v0 = trum_reference_speed(search), search->failed = search->out_of_steps = 0;
  search->side_by_side = TRUM_SEGMENTS > 1 && !search->in_turn &&
                         (search->stage == STAGE_HELD ||
                          (search->passed && trum_fabs(change) <= search->top * trum_side_by_side_change));
  search->at[0].S = 1, search->at[0].mean_S = 0;
  search->segment = search->side_by_side ? 0 : -1, search->unended = search->segments;
  for (k = 1; search->side_by_side && k < search->segments; ++k)
    search->at[k].speed += search->at[k].S * change - without * search->at[k].error;
}

#endif
