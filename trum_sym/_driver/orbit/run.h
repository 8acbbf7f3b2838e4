/* Points and their laps shared out over the lanes. */
#ifndef TRUM_ORBIT_RUN_H
#define TRUM_ORBIT_RUN_H

/* One step of all lanes, and what follows for those whose lap is over; 0 in done[i] when lane i has no more work. */
static void trum_advance(trum_lanes* l, trum_job* jobs, int* busy) {
  mask ended;
  int i;
  if (any(l->cold)) trum_begin(l);
  l->lost = l->lost | (l->active & less_than(l->patience, TRUM_NUMBER(0)));
  ended = l->active & ((trum_step(l) & at_most(l->left, TRUM_NUMBER(0))) | l->lost);
  if (!any(ended)) return;
  for (i = 0; i < TRUM_LANES; ++i) {
    if (!in_lane(ended, i)) continue;
    if (!in_lane(l->lost, i) && trum_next_region(l, i, &jobs[i])) continue;
    busy[i] = trum_judge(l, i, &jobs[i]);
    if (!busy[i]) put_mask(&l->active, i, 0);
  }
}

/* Nothing is known yet. */
static void trum_blank(trum_orbit_out* out, trum_slopes_out* slopes) {
  int of, way;
  out->mean = out->low = out->high = out->variance = out->start = out->level = out->error = NAN;
  out->contact = out->held = NAN, out->flags = 0;
  for (of = 0; slopes && of < TRUM_SLOPE_FIGURES_COUNT; ++of)
    for (way = 0; way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) slopes->of[of][way] = NAN;
}

/* The piece of work from which on there is some: a point's rotor held, if that is wanted, then its orbit. */
static long trum_next_piece(const trum_orbit_in* in, long piece, long count) {
  return piece < 2 * count && piece % 2 == 0 && !(in[piece / 2].held > 0.5) ? piece + 1 : piece;
}

/* Works through count points of one contact law; lanes take the next piece of work when they are done with one.  Slopes
 * are of orbits that are known. */
static void trum_run(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                     trum_slopes_out* slopes_out, long count) {
  trum_lanes l;
  trum_job jobs[TRUM_LANES];
  trum_orbit_out own[TRUM_LANES];
  trum_slopes_out unused;
  int busy[TRUM_LANES], used[TRUM_LANES], i, left;
  long next = 0;
  trum_clear(&l, in[0].hertz > 0.5, slopes_in != 0);
  for (i = 0; i < TRUM_LANES; ++i) busy[i] = used[i] = 0;
  do {
    for (i = left = 0; i < TRUM_LANES; ++i) {
      int taken;
      while (!busy[i] && ((taken = (next = trum_next_piece(in, next, count)) < 2 * count) || !used[i])) {
        /* lanes that never had work carry the last point's numbers, and rest */
        const long point = taken ? next / 2 : count - 1;
        const int scratch = slopes_in || !taken;
        jobs[i].slopes_in = slopes_in ? &slopes_in[point] : 0;
        jobs[i].slopes_out = slopes_out && taken ? &slopes_out[point] : &unused;
        if (scratch) trum_blank(&own[i], 0);
        busy[i] = trum_load(&l, i, &jobs[i], &in[point], scratch ? &own[i] : &out[point], !taken || next % 2 == 0,
                            slopes_in ? out[point].start : NAN);
        busy[i] = busy[i] && taken, used[i] = 1, next += taken;
        if (!busy[i]) put_mask(&l.active, i, 0);
      }
      left += busy[i];
    }
    if (left) trum_advance(&l, jobs, busy);
  } while (left);
}

/* Orbits of count points of one contact law, and their slopes unless these are null. */
static void trum_orbits(const trum_orbit_in* in, trum_orbit_out* out, const trum_slopes_in* slopes_in,
                        trum_slopes_out* slopes_out, long count) {
  long k;
  if (count <= 0) return;
  for (k = 0; k < count; ++k) trum_blank(&out[k], slopes_out ? &slopes_out[k] : 0);
  trum_run(in, out, 0, 0, count);
  for (k = 0; k < count; ++k) {
    const int flags = (int)out[k].flags;
    if (in[k].held > 0.5 && isnan(out[k].held) && flags & trum_converged) out[k].flags = flags - trum_converged;
  }
  if (slopes_in) trum_run(in, out, slopes_in, slopes_out, count);
}

/* One cycle of a point's orbit: rim speed, and distance since t1, at count equal times after t1. */
static void trum_history(const trum_orbit_in* in, const trum_orbit_out* orbit, double* speed, double* distance,
                         long count) {
  trum_lanes l;
  trum_job jobs[TRUM_LANES];
  trum_orbit_out unused;
  trum_record record;
  int i;
  trum_clear(&l, in->hertz > 0.5, 0);
  for (i = 0; i < TRUM_LANES; ++i) {
    trum_load(&l, i, &jobs[i], in, &unused, 1, NAN);
    if (i > 0) put_mask(&l.active, i, 0);
  }
  jobs[0].stage = FINE, jobs[0].level = orbit->level, jobs[0].v0 = orbit->start;
  jobs[0].scale = fabs(orbit->low) > fabs(orbit->high) ? fabs(orbit->low) : fabs(orbit->high);
  trum_start_lap(&l, 0, &jobs[0]);
  record.speed = speed, record.distance = distance, record.count = count, record.written = 0;
  record.spacing = get(&l.whole, 0) / (double)count, record.since = record.travelled = 0.0;
  l.record = &record;
  for (;;) {
    mask accepted;
    if (any(l.cold)) trum_begin(&l);
    accepted = trum_step(&l);
    if (in_lane(l.lost, 0) || get(&l.patience, 0) < 0.0) break;
    if (in_lane(accepted, 0) && get(&l.left, 0) <= 0.0 && !trum_next_region(&l, 0, &jobs[0])) break;
  }
  for (; record.written < count; ++record.written) speed[record.written] = distance[record.written] = NAN;
}

#endif
