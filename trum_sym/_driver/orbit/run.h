/* Points shared out over the lanes.
 *
 * A point has two tasks that do not depend on each other: the held rotor, if it is wanted, and the orbit.  A lane that
 * has finished one takes the next, so that all lanes stay busy. */
#ifndef TRUM_ORBIT_RUN_H
#define TRUM_ORBIT_RUN_H

/* One attempt at a step on all lanes, then the next region or lap for those that need one.  busy[i] becomes 0 when
 * lane i has finished its task. */
static void trum_advance_lanes(trum_lanes* lanes, trum_search* searches, int* busy) {
  mask ended;
  int i;
  if (any_lane(lanes->status.at_lap_start)) trum_evaluate_lap_start(lanes);
  lanes->status.failed =
      lanes->status.failed | (lanes->status.active & less_than(lanes->step.steps_left, TRUM_NUMBER(0)));
  ended = lanes->status.active &
          ((trum_advance_step(lanes) & at_most(lanes->step.time_left, TRUM_NUMBER(0))) | lanes->status.failed);
  if (!any_lane(ended)) return;
  for (i = 0; i < TRUM_LANES; ++i) {
    if (!mask_in_lane(ended, i)) continue;
    if (!mask_in_lane(lanes->status.failed, i) && trum_enter_next_region(lanes, i, &searches[i])) continue;
    busy[i] = trum_finish_lap(lanes, i, &searches[i]);
    if (!busy[i]) set_lane_mask(&lanes->status.active, i, 0);
  }
}

/* Sets all results to NaN, and the flags to none. */
static void trum_set_unknown(trum_orbit_out* out, trum_slopes_out* slopes) {
  int of, parameter;
  out->mean = out->low = out->high = out->variance = out->start = out->level = out->error = TRUM_NAN;
  out->mean_error = out->low_error = out->high_error = out->deviation_error = TRUM_NAN;
  out->contact = out->held = out->contact_error = out->held_error = TRUM_NAN, out->flags = 0;
  for (of = 0; slopes && of < FIGURES; ++of)
    for (parameter = 0; parameter < PARAMETERS; ++parameter) slopes->of[of][parameter] = TRUM_NAN;
}

/* The first task from `task` on that is wanted: even ones are the held rotors, odd ones the orbits. */
static long trum_next_task(const trum_orbit_in* in, long task, long count) {
  return task < 2 * count && task % 2 == 0 && !(in[task / 2].held > TRUM_C(0.5)) ? task + 1 : task;
}

/* Counts an attempt at a step, of those that a call may still take (null: any number); 0 if there is none left. */
static int trum_may_attempt(int_least32_t* attempts) {
  if (!attempts) return 1;
  if (*attempts <= 0) return 0;
  --*attempts;
  return 1;
}

/* Works through the tasks of count points of one contact law.  With slopes_in the orbits in `out` must be known.  Returns
 * 0 if the attempts were used up before the end. */
static int trum_run_tasks(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                          trum_slopes_out* slopes_out, long count, int_least32_t* attempts) {
  trum_lanes lanes;
  trum_search searches[TRUM_LANES];
  trum_orbit_out own[TRUM_LANES];
  trum_slopes_out unused;
  int busy[TRUM_LANES], used[TRUM_LANES], i, remaining;
  long next = 0;
  trum_initialise_lanes(&lanes, in[0].hertz > TRUM_C(0.5), slopes_in != 0);
  for (i = 0; i < TRUM_LANES; ++i) busy[i] = used[i] = 0;
  do {
    for (i = remaining = 0; i < TRUM_LANES; ++i) {
      int has_task;
      while (!busy[i] && ((has_task = (next = trum_next_task(in, next, count)) < 2 * count) || !used[i])) {
        /* a lane without a task carries the last point's numbers and is not active */
        const long point = has_task ? next / 2 : count - 1;
        const int to_scratch = slopes_in || !has_task;
        searches[i].slopes_in = slopes_in ? &slopes_in[point] : 0;
        searches[i].slopes_out = slopes_out && has_task ? &slopes_out[point] : &unused;
        if (to_scratch) trum_set_unknown(&own[i], 0);
        busy[i] = trum_load_task(&lanes, i, &searches[i], &in[point], to_scratch ? &own[i] : &out[point],
                                 !has_task || next % 2 == 0, slopes_in ? out[point].start : TRUM_NAN);
        busy[i] = busy[i] && has_task, used[i] = 1, next += has_task;
        if (!busy[i]) set_lane_mask(&lanes.status.active, i, 0);
      }
      remaining += busy[i];
    }
    trum_share_lanes(&lanes, busy);
    if (remaining && !trum_may_attempt(attempts)) return 0;
    if (remaining) trum_advance_lanes(&lanes, searches, busy);
  } while (remaining);
  return 1;
}

/* Orbits of count points of one contact law; their slopes too unless slopes_in is null.  Returns 0 if the attempts at steps
 * were used up (null: any number): figures are then the best found. */
static int trum_orbits(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                              trum_slopes_out* slopes_out, long count, int_least32_t* attempts) {
  int done;
  long k;
  if (count <= 0) return 1;
  for (k = 0; k < count; ++k) trum_set_unknown(&out[k], slopes_out ? &slopes_out[k] : 0);
  done = trum_run_tasks(in, out, 0, 0, count, attempts);
  for (k = 0; k < count; ++k) {
    const int flags = (int)out[k].flags;
    const int known = out[k].held_error <= in[k].tolerance && out[k].contact_error <= in[k].tolerance;
    if (in[k].held > TRUM_C(0.5) && !known && flags & trum_converged) out[k].flags = (trum_real)(flags - trum_converged);
  }
  if (slopes_in) done = trum_run_tasks(in, out, slopes_in, slopes_out, count, attempts);
  return done;
}

/* One cycle of a point's orbit: rim speed, and distance since t1, at count equal times after t1; NaN where the motion could
 * not be followed.  Returns 0 if that is for want of attempts. */
static int trum_history(const trum_orbit_in* in, const trum_orbit_out* orbit, trum_real* speed,
                               trum_real* distance, long count, int_least32_t* attempts) {
  trum_lanes lanes;
  trum_search searches[TRUM_LANES];
  trum_orbit_out unused;
  trum_record record;
  int busy[TRUM_LANES], i, allowed = 1;
  trum_initialise_lanes(&lanes, in->hertz > TRUM_C(0.5), 0);
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_load_task(&lanes, i, &searches[i], in, &unused, 1, TRUM_NAN);
    if (i > 0) set_lane_mask(&lanes.status.active, i, 0);
    busy[i] = i == 0;
  }
  trum_share_lanes(&lanes, busy);
  searches[0].stage = STAGE_FINE, searches[0].level = orbit->level, searches[0].start_speed = orbit->start;
  searches[0].scales.speed = trum_fabs(orbit->low) > trum_fabs(orbit->high) ? trum_fabs(orbit->low) : trum_fabs(orbit->high);
  searches[0].repetition.is_long &= count == 1; /* times in between are not counted over */
  trum_start_lap(&lanes, 0, &searches[0]);
  record.speed = speed, record.distance = distance, record.count = count, record.written = 0;
  record.spacing = lane_value(&lanes.equation.cycle_time, 0) / (trum_real)count, record.since = record.travelled = 0;
  lanes.record = &record;
  for (;;) {
    mask accepted;
    allowed = trum_may_attempt(attempts);
    if (!allowed) break;
    if (any_lane(lanes.status.at_lap_start)) trum_evaluate_lap_start(&lanes);
    accepted = trum_advance_step(&lanes);
    if (mask_in_lane(lanes.status.failed, 0) || lane_value(&lanes.step.steps_left, 0) < 0) break;
    if (mask_in_lane(accepted, 0) && lane_value(&lanes.step.time_left, 0) <= 0 &&
        !trum_enter_next_region(&lanes, 0, &searches[0])) {
      if (searches[0].repetition.is_long && record.written < count) { /* the end may have been counted and not stepped to */
        speed[0] = lane_value(&lanes.equation.v0, 0) + lane_value(&lanes.start.x, 0), distance[0] = record.travelled;
        record.written = 1;
      }
      break;
    }
  }
  for (; record.written < count; ++record.written) speed[record.written] = distance[record.written] = TRUM_NAN;
  return allowed;
}

#endif
