/* Laps: one drive cycle from a start speed, region by region (eqs. 9, 10: the phases' gates change between regions). */
#ifndef TRUM_ORBIT_LAP_H
#define TRUM_ORBIT_LAP_H

/* The error that a fine lap's steps may have, over the speed's scale. */
static trum_real trum_fine_level(trum_real tolerance) {
  return trum_step_share * (tolerance < trum_coarsest ? tolerance : trum_coarsest);
}

/* That of the held rotor's lap: finer tolerances have more steps, whose errors add up. */
static trum_real trum_held_level(trum_real tolerance) {
  const trum_real share = tolerance < TRUM_C(1e-6) ? trum_pow(tolerance / TRUM_C(1e-6), TRUM_C(0.2)) : 1;
  return share * trum_fine_level(tolerance);
}

/* A drive cycle: its regions' start phasors and lengths in drive periods, and the phasors' derivatives by resonance and
 * frequency difference. */
typedef struct {
  trum_real start[TRUM_REGIONS][4], pulses[TRUM_REGIONS], slopes[2][TRUM_REGIONS][4];
} trum_cycle_phasors;

/* Start speeds that are too low and too high, and the gain of speed of the laps from there; those of fine laps. */
typedef struct {
  trum_real low, high, gain_low, gain_high, sure_low, sure_high;
  int bisect_next, coarse; /* it is of coarse laps */
} trum_bracket;

/* The lap before: its change of the start speed, start, decay, gain without its errors and what that is uncertain by;
 * how far around it laps draw speeds together alike, and by what share their slope is off. */
typedef struct {
  trum_real last_step, start, decay, exact_gain, uncertainty, trusted, slope_error;
  trum_real last_bound;  /* the last fine lap's own, of those whose steps were too long */
  int probes;            /* laps beside a start whose gain has no certain sign */
  int in_vain;           /* laps in a row whose own bound shorter steps left as it was */
} trum_newton_record;

/* What errors are measured by: a speed; with slopes the sums of the lap before. */
typedef struct {
  trum_real speed, growth, friction[PARAMETERS], angle[PARAMETERS];
} trum_scales;

/* A lap of the held rotor; laps far from the orbit; laps whose steps meet the tolerance. */
enum { STAGE_HELD, STAGE_ROUGH, STAGE_FINE };

/* A segment of a lap: the region it is of, where it begins there, and how long it lasts, s. */
typedef struct {
  int region;
  trum_real since, duration;
} trum_segment;

/* Where a segment begins: the speed, S and the error there in the lap before, and the length of steps that errors allow;
 * and S at the segment's end and on average, counted from 1 where it begins. */
typedef struct {
  trum_real speed, S, error, step, growth, mean_S;
} trum_boundary;

/* About where a point's orbit is (coarse.h); and the speeds at which its segments begin, once it is found. */
typedef struct {
  int found, stiff;
  trum_real start_speed, top;
  trum_newton_record newton;
  trum_bracket bracket;
  trum_boundary at[TRUM_MOST_SEGMENTS];
} trum_coarse_orbit;

/* The search for a point's orbit: shooting, in laps from a start speed. */
typedef struct {
  const trum_orbit_in* in;
  trum_orbit_out* out;
  const trum_slopes_in* slopes_in; /* or none */
  trum_slopes_out* slopes_out;
  trum_cycle_phasors cycle;
  trum_bracket bracket;
  trum_newton_record newton;
  trum_scales scales;
  trum_repetition repetition;
  trum_real period, cycle_time; /* s */
  trum_real start_speed, v0; /* of the lap; what its speeds are differences to */
  trum_real top;             /* the largest speed of the lap before */
  trum_real level;          /* the error that its steps may have, per drive period, over the speed's scale */
  int stage;             /* of the lap */
  int laps, refinements; /* so far; those that were repeated with shorter steps */
  int held_laps;         /* with slopes, of the held rotor */
  int done;              /* nothing is left to do */
  int segments;               /* of a lap */
  int segment;                /* the one under way; side by side the next one to begin */
  int side_by_side, unended;  /* the lap's segments are integrated so, of which so many have not ended */
  int passed;                 /* it is known about where they begin */
  int in_turn;                /* no lap's are side by side from now on */
  int failed, out_of_steps;   /* the lap could not be followed; for want of steps */
  trum_real steps_level;      /* the level that the boundaries' steps are of */
  trum_segment segment_of[TRUM_MOST_SEGMENTS];
  trum_boundary at[TRUM_MOST_SEGMENTS];
  trum_coarse_orbit* about; /* or none */
  trum_lap_sums lap;     /* the last lap's */
  trum_real jumps;       /* what its remainder owes to segments that do not begin where those before them end */
#if TRUM_SEGMENTS > 1
  trum_lap_sums part[TRUM_MOST_SEGMENTS]; /* its segments', if they were side by side */
#endif
} trum_search;

static trum_real trum_larger(trum_real a, trum_real b) { return a > b ? a : b; }

/* Divides a lap into segments: each region into equal ones, about so many in all. */
static void trum_divide_lap(trum_search* search, int segments) {
  trum_real pulses = 0;
  int r, k;
  for (r = 0; r < TRUM_REGIONS; ++r) pulses += trum_larger(0, search->cycle.pulses[r]);
  search->segments = 0, search->segment_of[0].region = 0, search->segment_of[0].since = search->segment_of[0].duration = 0;
  for (r = 0; r < TRUM_REGIONS; ++r) {
    const trum_real of_region = search->cycle.pulses[r], whole = of_region * search->period;
    const trum_real share = search->repetition.is_long ? 1 : of_region / pulses * (trum_real)segments;
    const int count = !(of_region > TRUM_C(0.5)) ? 0 : share > 1 ? (int)(share + TRUM_C(0.5)) : 1;
    for (k = 0; k < count; ++k) {
      trum_segment* segment = &search->segment_of[search->segments++];
      segment->region = r, segment->since = whole * (trum_real)k / (trum_real)count;
      segment->duration = whole * (trum_real)(k + 1) / (trum_real)count - segment->since;
    }
  }
}

/* Whether the numbers that were given make a drive cycle. */
static int trum_has_cycle(const trum_search* search) {
  const trum_orbit_in* in = search->in;
  trum_real motion = 0;
  int r, k;
  for (r = 0; r < TRUM_REGIONS; ++r)
    for (k = 0; k < 4; ++k) motion += trum_fabs(search->cycle.start[r][k]);
  return search->segments > 0 && search->period > 0 && search->cycle_time < TRUM_HUGE && motion < TRUM_HUGE && in->n >= 0 &&
         in->n <= in->m && in->m < TRUM_C(1e9);
}

/* Has the laps from now on integrated in turn, region by region. */
static void trum_integrate_in_turn(trum_search* search) {
  search->in_turn = 1;
  trum_divide_lap(search, 1);
}

/* Puts a segment of the lap into the lane. */
static void trum_enter_segment(trum_lanes* lanes, int i, trum_search* search, int segment) {
  static const trum_real gates_A[] = TRUM_GATES_A, gates_B[] = TRUM_GATES_B;
  const int region = search->segment_of[segment].region;
  const trum_real free_h = lane_value(&lanes->step.free_h, i), duration = search->segment_of[segment].duration;
  const trum_real* start = search->cycle.start[region];
  set_lane(&lanes->region.f_A_re, i, start[0]), set_lane(&lanes->region.f_A_im, i, start[1]);
  set_lane(&lanes->region.f_B_re, i, start[2]), set_lane(&lanes->region.f_B_im, i, start[3]);
  set_lane(&lanes->region.g_A, i, gates_A[region]), set_lane(&lanes->region.g_B, i, gates_B[region]);
  if (with_slopes(lanes)) {
    const trum_real* by_resonance = search->cycle.slopes[0][region];
    const trum_real* by_difference = search->cycle.slopes[1][region];
    trum_region_slopes* slopes = &lanes->region_slopes;
    set_lane(&slopes->f_A_re_omega_n, i, by_resonance[0]), set_lane(&slopes->f_A_im_omega_n, i, by_resonance[1]);
    set_lane(&slopes->f_B_re_omega_n, i, by_resonance[2]), set_lane(&slopes->f_B_im_omega_n, i, by_resonance[3]);
    set_lane(&slopes->f_A_re_Delta_omega, i, by_difference[0]);
    set_lane(&slopes->f_A_im_Delta_omega, i, by_difference[1]);
    set_lane(&slopes->f_B_re_Delta_omega, i, by_difference[2]);
    set_lane(&slopes->f_B_im_Delta_omega, i, by_difference[3]);
  }
  set_lane(&lanes->step.tau, i, search->segment_of[segment].since);
  set_lane(&lanes->step.time_left, i, duration);
  set_lane(&lanes->step.h, i, free_h < duration ? free_h : duration);
  set_lane(&lanes->step.curvature, i, 0), set_lane(&lanes->step.target_event, i, -1);
  set_lane(&lanes->step.retries, i, 0);
  if (search->repetition.is_long)
    trum_begin_long_region(lanes, i, &search->repetition, search->in, search->cycle.pulses[region],
                           trum_repetition_share * search->level * (search->stage == STAGE_HELD ? 1 : search->scales.speed));
}

/* Puts what follows in a lap whose segments are integrated in turn into the lane; returns 0 at the lap's end. */
static int trum_enter_next_segment(trum_lanes* lanes, int i, trum_search* search) {
  trum_boundary *ended = &search->at[search->segment], *begins = ended + 1;
  const trum_real S = lane_value(&lanes->start.S, i), sum = lane_value(&lanes->lap.S, i);
  if (search->repetition.is_long && trum_next_piece(lanes, i, &search->repetition, search->in)) return 1;
  ended->growth = S / trum_larger(ended->S, trum_tiny);
  ended->mean_S = (sum - ended->mean_S) / (search->segment_of[search->segment].duration * trum_larger(ended->S, trum_tiny));
  if (++search->segment == search->segments) return 0;
  begins->speed = search->v0 + lane_value(&lanes->start.x, i), begins->S = S, begins->mean_S = sum;
  begins->error = lane_value(&lanes->lap.error, i), begins->step = lane_value(&lanes->step.free_h, i);
  trum_enter_segment(lanes, i, search, search->segment);
  return 1;
}

/* The drive periods over which the errors of a lap's steps add up: all of them, or, where most are counted, those in which
 * friction could bring the rotor to `reach`, which is a time. */
static trum_real trum_counted_periods(const trum_search* search, trum_real reach, trum_real period) {
  if (!search->repetition.is_long || search->stage == STAGE_HELD) return search->in->m;
  return reach > trum_least_counted * period ? reach / period : trum_least_counted;
}

/* The tolerances of a lap's steps, from the level of its search. */
static void trum_set_tolerances(trum_lanes* lanes, int i, const trum_search* search) {
  const trum_orbit_in* in = search->in;
  const trum_real period = search->period, cycle_time = search->cycle_time;
  const int held = search->stage == STAGE_HELD, of_friction = held && search->held_laps == 1;
  const int of_contact = held && search->held_laps == 2;
  const int close = with_slopes(lanes) && (held ? search->held_laps > 0 : search->stage == STAGE_FINE);
  trum_tolerances* t = &lanes->tolerances;
  trum_real reach = held ? cycle_time : search->scales.speed / in->push, allowed, periods;
  int k;
  if (reach > cycle_time) reach = cycle_time;
  periods = trum_counted_periods(search, reach, period);
  allowed = search->level * reach / periods;
  set_lane(&t->inverse_step, i, 1 / allowed);
  set_lane(&t->inverse_growth, i, periods / (in->tolerance * search->scales.growth));
  for (k = 0; with_slopes(lanes) && k < PARAMETERS; ++k) {
    set_lane(&t->inverse_friction[k], i, of_contact ? 0 : periods / (in->tolerance * search->scales.friction[k]));
    set_lane(&t->inverse_angle[k], i, of_friction ? 0 : periods / (in->tolerance * search->scales.angle[k]));
  }
  set_lane(&t->root, i, trum_root_share * trum_cbrt(allowed * allowed * period));
  set_lane(&t->kink, i, trum_kink_share * allowed);
  set_lane(&t->newton, i, held ? 0 : allowed * in->push * trum_sqrt(trum_newton_share * periods / search->level));
  set_lane(&t->slope_start, i, close ? trum_slope_start_tolerance * period : TRUM_HUGE);
  set_lane(&t->slope_end, i, close ? trum_slope_end_tolerance * period : TRUM_HUGE);
  if (close) set_lane(&t->newton, i, trum_slope_newton_factor * lane_value(&t->newton, i));
}

/* Sets a lap's sums to those of no time. */
static void trum_clear_lap(trum_lap* lap, int i, trum_real x, int slopes) {
  int k;
#define TRUM_CLEAR(name) set_lane(&lap->name, i, 0);
  TRUM_LAP_INTEGRALS(TRUM_CLEAR) TRUM_LAP_STATES(TRUM_CLEAR)
#undef TRUM_CLEAR
  set_lane(&lap->low, i, x), set_lane(&lap->high, i, x), set_lane(&lap->lowest, i, x), set_lane(&lap->highest, i, x);
  set_lane(&lap->S_low, i, 1), set_lane(&lap->S_high, i, 1), set_lane(&lap->kept, i, 1);
#define TRUM_CLEAR(name) set_lane(&lap->name[k], i, 0);
  for (k = 0; slopes && k < PARAMETERS; ++k) { TRUM_LAP_SLOPES(TRUM_CLEAR) }
#undef TRUM_CLEAR
}

/* Reads the sums of a lap, or of a segment, that has ended. */
static void trum_read_lap(const trum_lanes* lanes, int i, trum_lap_sums* sums) {
  const trum_lap* lap = &lanes->lap;
  int k;
#define TRUM_READ(name) sums->name = lane_value(&lap->name, i);
  TRUM_LAP_INTEGRALS(TRUM_READ) TRUM_LAP_STATES(TRUM_READ)
#undef TRUM_READ
  sums->end = lane_value(&lanes->start.x, i), sums->growth = lane_value(&lanes->start.S, i);
  sums->step = lane_value(&lanes->step.free_h, i);
#define TRUM_READ(name) sums->name[k] = lane_value(&lap->name[k], i);
  for (k = 0; with_slopes(lanes) && k < PARAMETERS; ++k) {
    TRUM_LAP_SLOPES(TRUM_READ)
    sums->d_end[k] = lane_value(&lanes->sensitivity.x[k], i);
  }
#undef TRUM_READ
}

/* Sets the sensitivities to those of a lap's start: none. */
static void trum_clear_sensitivity(trum_sensitivity* sensitivity, int i, int slopes) {
  trum_derivatives* d = &sensitivity->derivatives;
  int k;
  for (k = 0; slopes && k < PARAMETERS; ++k) {
    set_lane(&sensitivity->x[k], i, 0);
    set_lane(&d->f[k], i, 0), set_lane(&d->ln_E[k], i, 0), set_lane(&d->ln_R_v[k], i, 0);
  }
  set_lane(&d->theta_E, i, 0), set_lane(&d->R_v_rate, i, 0), set_lane(&d->W_c_rate, i, 0);
}

/* The speed that a lap's are differences to: its start's, so that small changes keep their digits; 0 where friction can
 * turn the speed round many times in a drive period, so that small speeds do. */
static trum_real trum_reference_speed(const trum_search* search) {
  const trum_real reach = search->in->push * search->period;
  return search->stage != STAGE_HELD && reach > 10 * trum_fabs(search->start_speed) ? 0 : search->start_speed;
}

/* Puts a point's constants into a lane. */
static void trum_load_lane(trum_lanes* lanes, int i, const trum_search* search) {
  const trum_orbit_in* in = search->in;
  const int held = search->stage == STAGE_HELD;
  trum_constants* constants = &lanes->constants;
  set_lane(&constants->omega_n, i, in->omega_n), set_lane(&constants->Delta_omega, i, in->Delta_omega);
  set_lane(&constants->xi, i, in->xi), set_lane(&constants->s, i, in->s), set_lane(&constants->W, i, in->W);
  set_lane(&constants->D, i, in->D), set_lane(&constants->k_c, i, in->k_c);
  set_lane(&constants->engagement_per_height, i, in->engagement_per_height);
  set_lane(&constants->W_full, i, in->W_full);
  set_lane(&constants->p_re, i, trum_cos(in->psi)), set_lane(&constants->p_im, i, trum_sin(in->psi));
  set_lane(&lanes->equation.period, i, search->period), set_lane(&lanes->equation.cycle_time, i, search->cycle_time);
  set_lane(&lanes->equation.push, i, held ? 0 : in->push), set_lane(&lanes->equation.drag, i, held ? 0 : in->drag);
  set_lane(&lanes->equation.v0, i, search->v0);
}

/* Starts a lap at its start, or a segment of it where that begins, in a lane. */
static void trum_start_segment(trum_lanes* lanes, int i, trum_search* search, int segment) {
  const trum_orbit_in* in = search->in;
  const int held = search->stage == STAGE_HELD;
  const trum_real x = segment ? search->at[segment].speed - search->v0 : search->start_speed - search->v0;
  trum_real step = trum_first_step * search->period;
  trum_step_start* start = &lanes->start;
  if (segment && search->steps_level > 0) {
    step = search->at[segment].step;
    if (search->level < search->steps_level) step *= trum_pow(search->level / search->steps_level, TRUM_C(0.2));
  }
  trum_load_lane(lanes, i, search);
  trum_set_tolerances(lanes, i, search);
  set_lane(&lanes->step.stiffness, i, 0), set_lane(&lanes->step.growth, i, trum_step_growth);
  set_lane(&lanes->step.steps_left, i, trum_max_steps_per_period * in->m);
  set_lane(&lanes->step.free_h, i, step);
  set_lane(&start->x, i, x), set_lane(&start->S, i, 1);
  set_lane(&start->f, i, 0), set_lane(&start->f_v, i, 0), set_lane(&start->theta, i, 0);
  trum_clear_lap(&lanes->lap, i, x, with_slopes(lanes));
  trum_clear_sensitivity(&lanes->sensitivity, i, with_slopes(lanes));
  set_lane_mask(&lanes->status.at_lap_start, i, 1), set_lane_mask(&lanes->status.failed, i, 0);
  set_lane_mask(&lanes->status.active, i, 1);
  set_lane_mask(&lanes->status.rough, i,
                search->stage == STAGE_ROUGH && search->level > trum_fine_level(in->tolerance) * TRUM_C(1.0001));
  set_lane_mask(&lanes->status.contact_only, i, held && search->held_laps == 2);
  trum_enter_segment(lanes, i, search, segment);
}

#endif
