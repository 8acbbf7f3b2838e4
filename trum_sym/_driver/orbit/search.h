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
static void trum_load_slopes(trum_job* job) {
  const trum_orbit_in* in = job->in;
  const trum_slopes_in* by_ = job->slopes_in;
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
        for (part = 0; part < 2; ++part) job->slopes[by][r][2 * phase + part] = res_[k++];
}

/* Slopes of the figures, when the orbit is found: d0 is that of the start speed which the lap reproduces. */
static void trum_figures_slopes(const trum_lanes* l, int i, trum_job* job) {
  const trum_lap* r = &l->lap;
  const double whole = get(&l->whole, i), growth = get(&l->S, i), pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
  const double x = get(&r->x, i) / whole, S = get(&r->S, i) / whole, xS = get(&r->xS, i) / whole;
  int way;
  for (way = 0; way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) {
    double(*of)[TRUM_SLOPE_PARAMETERS_COUNT] = job->slopes_out->of;
    if (job->stage == HELD) {
      if (job->sized != 1) of[TRUM_OF_CONTACT][way] = get(&r->d_angle[way], i) / whole / 3.14159265358979323846;
      if (job->sized != 2) of[TRUM_OF_HELD][way] = get(&r->d_friction[way], i) / whole;
    } else {
      const double d0 = get(&l->d[way], i) / pull, d_x = get(&r->d_x[way], i) / whole;
      of[TRUM_OF_MEAN][way] = d_x + S * d0;
      of[TRUM_OF_LOW][way] = get(&r->d_low[way], i) + get(&r->S_low, i) * d0;
      of[TRUM_OF_HIGH][way] = get(&r->d_high[way], i) + get(&r->S_high, i) * d0;
      of[TRUM_OF_VARIANCE][way] = 2.0 * (get(&r->d_xx[way], i) / whole - x * d_x + (xS - x * S) * d0);
    }
  }
}

/* The next lap's slopes are not looked after: nothing is known of their size. */
static void trum_unsized(trum_job* job) {
  int k;
  job->growth = 1e300;
  for (k = 0; k < TRUM_SLOPE_PARAMETERS_COUNT; ++k) job->size_f[k] = job->size_angle[k] = 1e300;
}

/* The rough level that makes one fine lap enough: Newton's step from there leaves its square. */
static double trum_rough(double tolerance) { return trum_level * 0.1 * sqrt(tolerance); }

/* A point's search for its orbit begins from rest, or from where it is known to begin; 0 if no speed balances the load. */
static int trum_set_off(trum_lanes* l, int i, trum_job* job, double known) {
  const trum_orbit_in* in = job->in;
  if (!(in->push > fabs(in->drag))) {
    job->out->flags += trum_runaway;
    return 0;
  }
  job->stage = ROUGH, job->level = trum_level * trum_coarse;
  job->scale = 0.1 * in->D * in->k_c * in->W * (in->omega_n + in->Delta_omega);
  if (!isnan(known)) job->v0 = known, job->laps = 1;
  trum_start_lap(l, i, job);
  return 1;
}

/* Puts a piece of a point's work into a lane: its rotor held, or the search for its orbit, from where that begins if it
 * is known.  0 if there is nothing to do. */
static int trum_load(trum_lanes* l, int i, trum_job* job, const trum_orbit_in* in, trum_orbit_out* out, int held,
                     double known) {
  const double period = 6.283185307179586477 / (in->omega_n + in->Delta_omega);
  trum_cycle_constants cycle;
  trum_free_motion before;
  trum_real res_[trum_regions_n_res];
  int r, phase;
  put(&l->constants.omega_n, i, in->omega_n), put(&l->constants.Delta_omega, i, in->Delta_omega), put(&l->constants.xi, i, in->xi);
  put(&l->constants.s, i, in->s), put(&l->constants.W, i, in->W), put(&l->constants.D, i, in->D), put(&l->constants.k_c, i, in->k_c);
  put(&l->constants.engagement_per_height, i, in->engagement_per_height), put(&l->constants.W_full, i, in->W_full);
  put(&l->constants.p_re, i, cos(in->psi)), put(&l->constants.p_im, i, sin(in->psi));
  put(&l->period, i, period), put(&l->whole, i, period * in->m);
  trum_load_cycle(in, &cycle, &before);
  trum_plain_regions(&cycle, &before, res_);
  for (r = 0; r < TRUM_REGIONS; ++r) {
    job->pulses[r] = floor(res_[trum_regions_out_time_redu + r] / period + 0.5);
    for (phase = 0; phase < 2; ++phase) {
      trum_phasor_in at;
      trum_phasor_out z;
      at.a = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase];
      at.b = res_[trum_regions_out_a_A_redu + 4 * r + 2 * phase + 1];
      at.omega_n = (trum_real)in->omega_n, at.xi = (trum_real)in->xi;
      trum_plain_phasor(&at, &z);
      job->start[r][2 * phase] = z.re, job->start[r][2 * phase + 1] = z.im;
    }
  }
  job->in = in, job->out = out;
  job->laps = job->finer = job->halves = 0, job->last_away = job->last_noise = 0.0, job->keeps = 1.0;
  job->stage = HELD, job->v0 = 0.0, job->low = -HUGE_VAL, job->high = HUGE_VAL;
  job->scale = 0.0, job->level = trum_level * in->tolerance;
  job->sized = 0, trum_unsized(job);
  if (l->slopes) trum_load_slopes(job);
  if (!held) return trum_set_off(l, i, job, known);
  trum_start_lap(l, i, job);
  return 1;
}

/* Errors of the next lap's slopes are measured by what this one has added up. */
static void trum_size(const trum_lanes* l, int i, trum_job* job, double growth) {
  int k;
  job->growth = growth;
  for (k = 0; k < TRUM_SLOPE_PARAMETERS_COUNT; ++k) {
    job->size_f[k] = get(&l->lap.size_f[k], i) + 1e-250, job->size_angle[k] = get(&l->lap.size_angle[k], i) + 1e-250;
  }
}

/* A lap is over: the next one, or 0 when the point is done.  Gain falls as the start rises: Newton in a bracket. */
static int trum_judge(trum_lanes* l, int i, trum_job* job) {
  const trum_orbit_in* in = job->in;
  trum_orbit_out* out = job->out;
  const trum_lap* r = &l->lap;
  const double whole = get(&l->whole, i);
  const int lost = in_lane(l->lost, i);
  if (job->stage == HELD) {
    out->contact = lost ? NAN : get(&r->angle, i) / whole / 3.14159265358979323846;
    out->held = lost ? NAN : get(&r->friction, i) / whole;
    if (l->slopes && !lost) trum_figures_slopes(l, i, job);
    if (l->slopes && !lost && job->sized < 2) { /* once more for the friction, and for the contact by itself */
      if (!job->sized) trum_size(l, i, job, 1e300);
      ++job->sized;
      trum_start_lap(l, i, job);
      return 1;
    }
    if (get(&r->full, i) > 0.0) out->flags += trum_full_contact;
    return 0;
  }
  if (lost) { /* steps that are too bold chatter where the rotor is as fast as a line of contact */
    const double fine = trum_level * in->tolerance;
    if (++job->finer > 3) return 0;
    job->level = job->level > fine ? fine : 0.1 * job->level, ++job->laps;
    trum_start_lap(l, i, job);
    return 1;
  }
  {
    const double gain = get(&l->x, i), growth = get(&l->S, i), pull = 1.0 - growth > 1e-14 ? 1.0 - growth : 1e-14;
    const double low = get(&r->low, i), high = get(&r->high, i), bound = 1.5 * get(&r->fastest, i);
    const double top = fabs(job->v0 + low) > fabs(job->v0 + high) ? fabs(job->v0 + low) : fabs(job->v0 + high);
    const double fine = trum_level * in->tolerance;
    const int accurate = job->level <= fine * 1.0001, last = ++job->laps >= trum_most_laps;
    /* a Newton step this small leaves an error of its square: the figures' derivatives take it along, slopes do not */
    const double nearly = top * (l->slopes && job->stage == FINE ? in->tolerance : sqrt(0.1 * in->tolerance));
    const int coarse = job->laps == 1 && !accurate;
    const double missed = get(&r->error, i) * in->push, noise = missed / pull, was = job->level * job->scale;
    double next = job->v0 + gain / pull, away, left;
    int inside, pinned, close;
    if (!coarse || fabs(gain) > 10.0 * missed) {
      if (gain > 0.0) job->low = job->v0, job->gain_low = gain;
      else job->high = job->v0, job->gain_high = gain;
    }
    next = next > bound ? bound : next < -bound ? -bound : next;
    /* Newton's step is not taken out of the bracket, nor if it is not getting shorter: it may go round in circles */
    inside = next > job->low && next < job->high && fabs(next - job->v0) <= 0.5 * job->last_away;
    if (!inside && job->low > -HUGE_VAL && job->high < HUGE_VAL) {
      const double share = job->halves ? 0.5 : job->gain_low / (job->gain_low - job->gain_high);
      next = job->low + share * (job->high - job->low), job->halves = !job->halves;
    }
    away = next - job->v0;
    pinned = !coarse && (fabs(away) <= noise || job->high - job->low <= 1e-15 * bound);
    /* what Newton's step leaves is its square, or what a lap keeps of it, and of the steps' errors a part: most cancel */
    left = fabs(away) * (growth < fabs(away) / top ? growth : fabs(away) / top) + 0.3 * noise;
    if (job->last_away > 10.0 * job->last_noise) job->keeps = fabs(away) < job->last_away ? fabs(away) / job->last_away : 1.0;
    job->last_away = fabs(away), job->last_noise = noise;
    close = accurate ? fabs(away) <= nearly && fabs(away) * job->keeps <= in->tolerance * top : left <= nearly;
    close = close || pinned;
    if (l->slopes) trum_size(l, i, job, pull);
    /* the less a lap pulls speeds together, the more an error of a step weighs */
    job->scale = top * (pull > 1e-3 ? pull : 1e-3 * (in->push * whole < top ? pull + in->push * whole / top : 1.0));
    if (l->slopes && job->stage == ROUGH) { /* the orbit is known, and now its slopes' size is */
      job->stage = FINE, job->level = fine, job->low = -HUGE_VAL, job->high = HUGE_VAL;
      trum_start_lap(l, i, job);
      return 1;
    }
    if (close && accurate && noise > in->tolerance * top && !last && ++job->finer <= 3) {
      const double excess = in->tolerance * top / noise;
      job->level *= 0.3 * (excess > 0.01 ? excess : 0.01);
    } else if (close && (accurate || last)) {
      const double mean = get(&r->x, i) / whole, mean_S = get(&r->S, i) / whole;
      const double square = get(&r->xx, i) / whole, mean_xS = get(&r->xS, i) / whole;
      const double variance = square - mean * mean + 2.0 * away * (mean_xS - mean * mean_S);
      if (l->slopes) trum_figures_slopes(l, i, job);
      out->mean = job->v0 + mean + away * mean_S;
      out->low = job->v0 + low + away * get(&r->S_low, i), out->high = job->v0 + high + away * get(&r->S_high, i);
      /* Newton's last change leaves the order of nearly equal speeds open */
      out->low = out->low < out->mean ? out->low : out->mean, out->high = out->high > out->mean ? out->high : out->mean;
      out->variance = variance > 0.0 ? variance : 0.0;
      out->start = next, out->level = job->level, out->error = noise / top;
      if (noise <= in->tolerance * top) out->flags += trum_converged;
      return 0;
    }
    if (last) { /* the best there is, and not flagged as converged */
      out->mean = job->v0 + get(&r->x, i) / whole, out->low = job->v0 + low, out->high = job->v0 + high;
      out->variance = get(&r->xx, i) / whole - (get(&r->x, i) / whole) * (get(&r->x, i) / whole);
      out->start = job->v0, out->level = job->level, out->error = fabs(away) / top;
      return 0;
    }
    if (close) {
      /* the steps' errors add up to what follows the level's power 3/4 */
      const double ratio = fine * job->scale / was, expected = noise * sqrt(ratio) * sqrt(sqrt(ratio));
      const double excess = in->tolerance * top / expected;
      job->level = excess < 1.0 ? fine * 0.5 * (excess > 0.01 ? excess : 0.01) : fine;
      job->stage = FINE, job->low = -HUGE_VAL, job->high = HUGE_VAL;
    } else if (coarse) {
      job->level = trum_rough(in->tolerance);
    }
    job->v0 = next;
  }
  trum_start_lap(l, i, job);
  return 1;
}

static void trum_clear(trum_lanes* l, int hertz, int slopes) {
  int k;
  l->active = l->cold = l->lost = l->contact = is(0), l->hertz = hertz, l->slopes = slopes, l->record = 0;
  for (k = 0; k < EVENTS; ++k) l->fresh[k] = is(0), l->event[k] = TRUM_NUMBER(0);
  l->tau = l->left = l->h = l->natural = l->bend = l->target = l->tries = l->patience = TRUM_NUMBER(0);
}

#endif
