/* Points shared out over the lanes.
 *
 * A point has two tasks that do not depend on each other: the held rotor, if it is wanted, and the orbit.  There are as many
 * at once as there are lanes, each a search with laps to do.  A lane works at the search of its own number, which takes the
 * next task when it is done; where no task is left, at the segments of others' laps. */
#ifndef TRUM_ORBIT_RUN_H
#define TRUM_ORBIT_RUN_H

/* What a lane is doing: the search that it works for, or -1, and the segment of its lap. */
typedef struct {
  int search, segment;
} trum_work;

/* One attempt at a step on all lanes, then the next segment or lap for those that need one.  A lane that has nothing to do
 * any more is marked as idle. */
static void trum_advance_lanes(trum_lanes* lanes, trum_search* searches, trum_work* work) {
  mask ended;
  int i;
  if (any_lane(lanes->status.at_lap_start)) trum_evaluate_lap_start(lanes);
  lanes->status.failed =
      lanes->status.failed | (lanes->status.active & less_than(lanes->step.steps_left, TRUM_NUMBER(0)));
  ended = lanes->status.active &
          ((trum_advance_step(lanes) & at_most(lanes->step.time_left, TRUM_NUMBER(0))) | lanes->status.failed);
  if (!any_lane(ended)) return;
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_search* search = &searches[work[i].search < 0 ? 0 : work[i].search];
    if (!mask_in_lane(ended, i)) continue;
    if (!search->side_by_side && !mask_in_lane(lanes->status.failed, i) && trum_enter_next_segment(lanes, i, search)) continue;
    if (trum_end_segment(lanes, i, search, work[i].segment)) search->done = !trum_finish_lap(lanes, search);
    work[i].search = -1;
    set_lane_mask(&lanes->status.active, i, 0);
  }
}

/* Whether a search has a lap, or a segment of one, that no lane has begun. */
static int trum_has_work(const trum_search* search) {
  return !search->done && (search->side_by_side ? search->segment < search->segments : search->segment < 0);
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

/* Points whose orbits are looked for at once: what coarse laps have found of them is kept meanwhile. */
enum { TRUM_AT_ONCE = TRUM_LANES > 1 ? 64 : 1 };

/* A batch of points of one contact law, and the tasks of these that have not begun. */
typedef struct {
  const trum_orbit_in* in;
  trum_orbit_out* out;
  const trum_slopes_in* slopes_in; /* or none; then the orbits in `out` are known */
  trum_slopes_out* slopes_out;
  long count, next;
} trum_batch;

/* What a batch is worked through with. */
typedef struct {
  trum_lanes lanes;
  trum_search searches[TRUM_LANES];
  trum_work work[TRUM_LANES];
  trum_orbit_out own[TRUM_LANES];
  trum_coarse_orbit about[TRUM_AT_ONCE];
} trum_workspace;

/* Gives an idle lane what a search has to do. */
static void trum_take_work(trum_workspace* w, int i, int of) {
  trum_search* search = &w->searches[of];
  w->work[i].search = of, w->work[i].segment = ++search->segment - search->side_by_side;
  trum_start_segment(&w->lanes, i, search, w->work[i].segment);
}

/* Has a search take up tasks until there is one with something to do; 0 if none is left. */
static int trum_take_task(trum_workspace* w, int i, trum_batch* batch) {
  trum_search* search = &w->searches[i];
  while ((batch->next = trum_next_task(batch->in, batch->next, batch->count)) < 2 * batch->count) {
    const long point = batch->next / 2;
    const int held = batch->next++ % 2 == 0;
    search->slopes_in = batch->slopes_in ? &batch->slopes_in[point] : 0;
    search->slopes_out = batch->slopes_out ? &batch->slopes_out[point] : 0;
    if (batch->slopes_in) trum_set_unknown(&w->own[i], 0);
    search->done = !trum_load_task(&w->lanes, i, search, &batch->in[point], batch->slopes_in ? &w->own[i] : &batch->out[point],
                                   held, batch->slopes_in ? batch->out[point].start : TRUM_NAN, held ? 0 : &w->about[point]);
    if (!search->done) return 1;
  }
  return 0;
}

/* Numbers for lanes that have nothing to do: those of the first point's held rotor. */
static void trum_fill_lanes(trum_workspace* w, const trum_batch* batch) {
  trum_slopes_out unused;
  int i;
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_set_unknown(&w->own[i], 0);
    w->searches[i].slopes_in = batch->slopes_in, w->searches[i].slopes_out = &unused;
    trum_load_task(&w->lanes, i, &w->searches[i], batch->in, &w->own[i], 1, TRUM_NAN, 0);
    trum_start_segment(&w->lanes, i, &w->searches[i], 0);
    set_lane_mask(&w->lanes.status.active, i, 0);
    w->searches[i].done = 1, w->work[i].search = -1, w->work[i].segment = 0;
  }
}

/* Works through the tasks of a batch.  Returns 0 if the attempts were used up before the end. */
static int trum_run_tasks(trum_workspace* w, trum_batch* batch, int_least32_t* attempts) {
  int busy[TRUM_LANES], i, k, remaining;
  long first;
  trum_initialise_lanes(&w->lanes, batch->in[0].hertz > TRUM_C(0.5), batch->slopes_in != 0);
  for (first = 0; !batch->slopes_in && first < batch->count; first += TRUM_LANES)
    if (!trum_coarse_orbits(&w->lanes, w->searches, batch->in + first, w->about + first,
                            batch->count - first < TRUM_LANES ? (int)(batch->count - first) : TRUM_LANES, attempts))
      return 0;
  trum_fill_lanes(w, batch);
  do {
    for (i = remaining = 0; i < TRUM_LANES; ++i) {
      if (w->work[i].search < 0 && w->searches[i].done) trum_take_task(w, i, batch);
      for (k = i; w->work[i].search < 0 && k < i + TRUM_LANES; ++k)
        if (trum_has_work(&w->searches[k % TRUM_LANES])) trum_take_work(w, i, k % TRUM_LANES);
      busy[i] = w->work[i].search >= 0, remaining += busy[i];
    }
    trum_share_lanes(&w->lanes, busy);
    if (remaining && !trum_may_attempt(attempts)) return 0;
    if (remaining) trum_advance_lanes(&w->lanes, w->searches, w->work);
  } while (remaining);
  return 1;
}

/* Orbits of count points of one contact law; their slopes too unless slopes_in is null.  Returns 0 if the attempts at steps
 * were used up (null: any number): figures are then the best found. */
static int trum_find_orbits(trum_workspace* w, const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                            trum_slopes_out* slopes_out, long count, int_least32_t* attempts) {
  int done = 1;
  long k, first;
  for (k = 0; k < count; ++k) trum_set_unknown(&out[k], slopes_out ? &slopes_out[k] : 0);
  for (first = 0; done && first < count; first += TRUM_AT_ONCE) {
    const long end = count - first < TRUM_AT_ONCE ? count : first + TRUM_AT_ONCE;
    trum_batch batch;
    batch.in = in + first, batch.out = out + first, batch.slopes_in = 0, batch.slopes_out = 0;
    batch.count = end - first, batch.next = 0;
    done = trum_run_tasks(w, &batch, attempts);
    for (k = first; k < end; ++k) {
      const int flags = (int)out[k].flags;
      const int known = out[k].held_error <= in[k].tolerance && out[k].contact_error <= in[k].tolerance;
      if (in[k].held > TRUM_C(0.5) && !known && flags & trum_converged) out[k].flags = (trum_real)(flags - trum_converged);
    }
    if (!slopes_in) continue;
    batch.slopes_in = slopes_in + first, batch.slopes_out = slopes_out + first, batch.next = 0;
    done = trum_run_tasks(w, &batch, attempts);
  }
  return done;
}

/* The same with what it takes on the stack. */
static int trum_orbits(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                       trum_slopes_out* slopes_out, long count, int_least32_t* attempts) {
  trum_workspace workspace;
  return trum_find_orbits(&workspace, in, out, slopes_in, slopes_out, count, attempts);
}

/* One cycle of a point's orbit: rim speed, and distance since t1, at count equal times after t1; NaN where the motion could
 * not be followed.  Returns 0 if that is for want of attempts. */
static int trum_follow_orbit(trum_workspace* w, const trum_orbit_in* in, const trum_orbit_out* orbit, trum_real* speed,
                             trum_real* distance, long count, int_least32_t* attempts) {
  trum_lanes* lanes = &w->lanes;
  trum_search* search = &w->searches[0];
  trum_orbit_out unused;
  trum_record record;
  int busy[TRUM_LANES], i, allowed = 1;
  trum_initialise_lanes(lanes, in->hertz > TRUM_C(0.5), 0);
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_load_task(lanes, i, &w->searches[i], in, &unused, 1, TRUM_NAN, 0);
    trum_start_segment(lanes, i, &w->searches[i], 0);
    if (i > 0) set_lane_mask(&lanes->status.active, i, 0);
    busy[i] = i == 0;
  }
  trum_share_lanes(lanes, busy);
  search->stage = STAGE_FINE, search->level = orbit->level, search->start_speed = orbit->start;
  search->scales.speed = trum_fabs(orbit->low) > trum_fabs(orbit->high) ? trum_fabs(orbit->low) : trum_fabs(orbit->high);
  search->repetition.is_long &= count == 1; /* times in between are not counted over */
  trum_integrate_in_turn(search), trum_prepare_lap(search, 0), search->segment = 0;
  trum_start_segment(lanes, 0, search, 0);
  record.speed = speed, record.distance = distance, record.count = count, record.written = 0;
  record.spacing = lane_value(&lanes->equation.cycle_time, 0) / (trum_real)count, record.since = record.travelled = 0;
  lanes->record = &record;
  while (trum_has_cycle(search)) {
    mask accepted;
    allowed = trum_may_attempt(attempts);
    if (!allowed) break;
    if (any_lane(lanes->status.at_lap_start)) trum_evaluate_lap_start(lanes);
    accepted = trum_advance_step(lanes);
    if (mask_in_lane(lanes->status.failed, 0) || lane_value(&lanes->step.steps_left, 0) < 0) break;
    if (mask_in_lane(accepted, 0) && lane_value(&lanes->step.time_left, 0) <= 0 &&
        !trum_enter_next_segment(lanes, 0, search)) {
      if (search->repetition.is_long && record.written < count) { /* the end may have been counted and not stepped to */
        speed[0] = lane_value(&lanes->equation.v0, 0) + lane_value(&lanes->start.x, 0), distance[0] = record.travelled;
        record.written = 1;
      }
      break;
    }
  }
  for (; record.written < count; ++record.written) speed[record.written] = distance[record.written] = TRUM_NAN;
  return allowed;
}

/* The same with what it takes on the stack. */
static int trum_history(const trum_orbit_in* in, const trum_orbit_out* orbit, trum_real* speed, trum_real* distance, long count,
                        int_least32_t* attempts) {
  trum_workspace workspace;
  return trum_follow_orbit(&workspace, in, orbit, speed, distance, count, attempts);
}

#endif
