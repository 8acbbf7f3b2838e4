/* Long schedules: of a region's drive periods those that repeat the one before are counted, not integrated.
 *
 * In a region the phases' free motion dies away and leaves a surface that repeats itself every drive period; on that, the
 * rotor's speed draws near to one that repeats itself, too.  A long region is integrated in pieces of whole periods: until
 * what is left of the free motion cannot move the lap by more than a share of what its steps may, then period by period until
 * what one changes the speed by cannot add up to more.  The periods that are left have the integrals of that one, and the
 * same defects, and what they differ by is bounded (repetition, surface and pressure in derivations/error_bound.py).
 *
 * The paper's Hertz width is not that of a layer, whose pressure the bounds rest on: there all periods are integrated. */
#ifndef TRUM_ORBIT_REPEAT_H
#define TRUM_ORBIT_REPEAT_H

/* Whether a schedule is so long. */
static int trum_is_long(const trum_orbit_in* in) { return in->m > TRUM_C(0.5) + TRUM_REPEATS_BEYOND && !(in->hertz > TRUM_C(0.5)); }

/* A lap's sums over time; those that are in proportion to S where a period begins; and of its square. */
#define TRUM_PERIOD_SUMS(X) \
  X(x) X(xx) X(friction) X(angle) X(error_sum) X(error_square) X(inside) X(friction_error) X(angle_error)
#define TRUM_PERIOD_BOUNDS(X) X(remainder_sum) X(remainder_square) X(friction_remainder) X(angle_remainder)
#define TRUM_PERIOD_SHARES(X) X(S) X(xS) X(error_S)

/* The sums at an instant, and the state there; or what a period adds to the sums. */
typedef struct {
#define TRUM_MEMBER(name) trum_real name;
  TRUM_PERIOD_SUMS(TRUM_MEMBER) TRUM_PERIOD_BOUNDS(TRUM_MEMBER) TRUM_PERIOD_SHARES(TRUM_MEMBER)
#undef TRUM_MEMBER
  trum_real SS, low, high, speed, S_there, error, remainder, travelled;
  trum_real d_x[PARAMETERS], d_xx[PARAMETERS], d_friction[PARAMETERS], d_angle[PARAMETERS], slopes[PARAMETERS];
} trum_period;

/* Where a lane is in a long region. */
typedef struct {
  int is_long;            /* the schedule is */
  int watched;            /* the piece under way is a period that may be repeated */
  trum_real left;         /* periods of the region after that piece */
  trum_real waiting;      /* of these, what the free motion takes to die away */
  trum_real since;        /* periods since the phasors below */
  trum_real free[4], drive[4]; /* the phases' free motion, and the drive's; real and imaginary parts */
  trum_real fading, turn; /* of the free motion in a period: exponent, and angle beside the drive's */
  trum_real allowed;      /* by which a lap may be off for the repetition: m/s, of a held rotor 1 */
  trum_period before;     /* where the watched period begins */
} trum_repetition;

static trum_real trum_hypotenuse(const trum_real* z) {
  return trum_sqrt(z[0] * z[0] + z[1] * z[1] + (z[2] * z[2] + z[3] * z[3]));
}

/* What a free motion of amplitude a, which is left out, moves the rotor's speed by at most (m/s): the surface's speed may be
 * off, or the pressure push harder on one side.  Twice, as the repeated period has more of it than those it stands for. */
static trum_real trum_left_out_speed(const trum_lanes* lanes, int i, const trum_orbit_in* in, const trum_repetition* r,
                                     trum_real a) {
  const trum_real lost = -trum_expm1(-r->fading);
  const trum_real push = lane_value(&lanes->equation.push, i) * lane_value(&lanes->equation.period, i) * (2 * a / in->W_full);
  return 2 * (in->D * in->k_c * in->omega_n * a + push / (lost + trum_tiny));
}

/* And the friction of a held rotor, and the contact over a whole wave, on average over a period. */
static trum_real trum_left_out_friction(const trum_orbit_in* in, trum_real a) {
  const trum_real share = a * in->omega_n / (in->W * (in->omega_n + in->Delta_omega)) + trum_tiny;
  const trum_real reversal = share < 1 ? share * (1 - trum_log(share)) : 1;
  return 4 * (a / in->W_full + (1 + in->W / in->W_full) * reversal);
}
static trum_real trum_left_out_contact(const trum_orbit_in* in, trum_real a) {
  return TRUM_C(3.4) * trum_sqrt(2 * a / in->W);
}

/* All of them that matter to the lap, over what is allowed. */
static trum_real trum_left_out(const trum_lanes* lanes, int i, const trum_orbit_in* in, const trum_repetition* r, trum_real a) {
  trum_real friction, contact;
  if (lane_value(&lanes->equation.push, i) > 0) return trum_left_out_speed(lanes, i, in, r, a) / r->allowed;
  friction = trum_left_out_friction(in, a), contact = trum_left_out_contact(in, a);
  return (friction > contact ? friction : contact) / r->allowed;
}

/* The sums so far; with a period's begin, what it has added, S and its square counted from 1 there. */
static void trum_read_period(const trum_lanes* lanes, int i, trum_period* at) {
  const trum_lap* lap = &lanes->lap;
  int k;
#define TRUM_READ(name) at->name = lane_value(&lap->name, i);
  TRUM_PERIOD_SUMS(TRUM_READ) TRUM_PERIOD_BOUNDS(TRUM_READ) TRUM_PERIOD_SHARES(TRUM_READ)
  TRUM_READ(SS) TRUM_READ(low) TRUM_READ(high) TRUM_READ(error) TRUM_READ(remainder)
#undef TRUM_READ
  at->speed = lane_value(&lanes->start.x, i), at->S_there = lane_value(&lanes->start.S, i);
  at->travelled = lanes->record ? lanes->record->travelled : 0;
  for (k = 0; with_slopes(lanes) && k < PARAMETERS; ++k) {
    at->d_x[k] = lane_value(&lap->d_x[k], i), at->d_xx[k] = lane_value(&lap->d_xx[k], i);
    at->d_friction[k] = lane_value(&lap->d_friction[k], i), at->d_angle[k] = lane_value(&lap->d_angle[k], i);
    at->slopes[k] = lane_value(&lanes->sensitivity.x[k], i);
  }
}

/* Begins the next piece of a region, of which `left` periods are to do. */
static void trum_begin_piece(trum_lanes* lanes, int i, trum_repetition* r) {
  const trum_real most = 1000; /* periods in which a time since the phasors keeps its digits */
  trum_real length = r->waiting < most ? r->waiting : most;
  r->watched = length < TRUM_C(0.5) && r->left > TRUM_C(1.5);
  if (r->watched) {
    trum_read_period(lanes, i, &r->before);
    set_lane(&lanes->start.S, i, 1), set_lane(&lanes->lap.kept, i, 1);
    length = 1;
  }
  if (length < 1) length = 1;
  if (length > r->left) length = r->left;
  r->left -= length, r->waiting = r->waiting > length ? r->waiting - length : 0, r->since += length;
  set_lane(&lanes->step.time_left, i, length * lane_value(&lanes->equation.period, i));
  set_lane(&lanes->step.h, i, lane_value(&lanes->step.free_h, i));
  set_lane(&lanes->step.curvature, i, 0), set_lane(&lanes->step.target_event, i, -1);
  set_lane(&lanes->step.retries, i, 0);
}

/* Begins a region of a long schedule, which has `pulses` periods; its phasors are in the lane. */
static void trum_begin_long_region(trum_lanes* lanes, int i, trum_repetition* r, const trum_orbit_in* in, trum_real pulses,
                                   trum_real allowed) {
  const trum_region* region = &lanes->region;
  const trum_real period = lane_value(&lanes->equation.period, i);
  const trum_real re = in->W * lane_value(&lanes->constants.p_re, i), im = in->W * lane_value(&lanes->constants.p_im, i);
  const trum_real g_A = lane_value(&region->g_A, i), g_B = lane_value(&region->g_B, i), root = trum_sqrt(1 - in->xi * in->xi);
  trum_real a, low = trum_tiny, high;
  int k;
  r->drive[0] = g_A * re, r->drive[1] = g_A * im, r->drive[2] = -g_B * in->s * im, r->drive[3] = g_B * in->s * re;
  r->free[0] = lane_value(&region->f_A_re, i) - r->drive[0], r->free[1] = lane_value(&region->f_A_im, i) - r->drive[1];
  r->free[2] = lane_value(&region->f_B_re, i) - r->drive[2], r->free[3] = lane_value(&region->f_B_im, i) - r->drive[3];
  r->fading = in->xi * in->omega_n * period, r->turn = -(in->Delta_omega + in->omega_n * in->xi * in->xi / (1 + root)) * period;
  r->allowed = allowed, r->left = pulses, r->since = 0;
  a = high = trum_hypotenuse(r->free);
  for (k = 0; k < 60 && high > 2 * low; ++k) { /* the largest amplitude, within a factor of 2, that may be left out */
    const trum_real middle = trum_sqrt(low) * trum_sqrt(high);
    if (trum_left_out(lanes, i, in, r, middle) > 1) high = middle;
    else low = middle;
  }
  if (with_slopes(lanes)) low *= TRUM_C(1e-4); /* their share of it falls more slowly */
  r->waiting = !(a > low) ? 0 : r->fading > 0 ? trum_ceil(trum_log(a / low) / r->fading) : pulses;
  trum_begin_piece(lanes, i, r);
}

/* Has the phasors begin where a piece does, so that times since then keep their digits. */
static void trum_move_phasors(trum_lanes* lanes, int i, trum_repetition* r) {
  const trum_real kept = trum_exp(-r->fading * r->since), angle = r->turn * r->since;
  const trum_real re = kept * trum_cos(angle), im = kept * trum_sin(angle);
  int phase;
  for (phase = 0; phase < 4; phase += 2) {
    const trum_real a = r->free[phase], b = r->free[phase + 1];
    r->free[phase] = a * re - b * im, r->free[phase + 1] = a * im + b * re;
  }
  set_lane(&lanes->region.f_A_re, i, r->free[0] + r->drive[0]), set_lane(&lanes->region.f_A_im, i, r->free[1] + r->drive[1]);
  set_lane(&lanes->region.f_B_re, i, r->free[2] + r->drive[2]), set_lane(&lanes->region.f_B_im, i, r->free[3] + r->drive[3]);
  set_lane(&lanes->step.tau, i, 0), r->since = 0;
}

static void trum_add_to(real* sum, int i, trum_real more) { set_lane(sum, i, lane_value(sum, i) + more); }

/* Ends a watched period: `added` becomes what it has added, with S counted from 1 where it began; S becomes the lap's again. */
static void trum_end_watch(trum_lanes* lanes, int i, trum_repetition* r, trum_period* added) {
  const trum_period* before = &r->before;
  const trum_real S = before->S_there;
  trum_lap* lap = &lanes->lap;
  int k;
  trum_read_period(lanes, i, added);
  if (added->low < before->low) set_lane(&lap->S_low, i, S * lane_value(&lap->S_low, i));
  if (added->high > before->high) set_lane(&lap->S_high, i, S * lane_value(&lap->S_high, i));
#define TRUM_DIFFERENCE(name) added->name -= before->name;
  TRUM_PERIOD_SUMS(TRUM_DIFFERENCE) TRUM_PERIOD_BOUNDS(TRUM_DIFFERENCE) TRUM_PERIOD_SHARES(TRUM_DIFFERENCE)
  TRUM_DIFFERENCE(SS) TRUM_DIFFERENCE(travelled)
#undef TRUM_DIFFERENCE
  for (k = 0; with_slopes(lanes) && k < PARAMETERS; ++k) {
    added->d_x[k] -= before->d_x[k], added->d_xx[k] -= before->d_xx[k];
    added->d_friction[k] -= before->d_friction[k], added->d_angle[k] -= before->d_angle[k];
  }
#define TRUM_SCALE(name) set_lane(&lap->name, i, before->name + S * added->name);
  TRUM_PERIOD_SHARES(TRUM_SCALE)
#undef TRUM_SCALE
  set_lane(&lap->SS, i, before->SS + S * S * added->SS);
  set_lane(&lanes->start.S, i, S * added->S_there);
  r->watched = 0;
}

/* Adds the slopes of `count` periods after the watched one; over each a difference of slopes falls by S. */
static void trum_repeat_slopes(trum_lanes* lanes, int i, const trum_repetition* r, const trum_period* added, trum_real count,
                               trum_real in_all, trum_real kept) {
  const trum_real S = added->S_there, decay = 1 - S > trum_least_decay ? 1 - S : trum_least_decay;
  trum_lap* lap = &lanes->lap;
  int k;
  for (k = 0; with_slopes(lanes) && k < PARAMETERS; ++k) {
    const trum_real end = (added->slopes[k] - r->before.slopes[k]) / decay; /* beyond the watched period's begin */
    const trum_real sum = end * (count - in_all);
    trum_add_to(&lap->d_x[k], i, count * added->d_x[k] + sum * added->S);
    trum_add_to(&lap->d_xx[k], i, count * added->d_xx[k] + sum * added->xS);
    trum_add_to(&lap->d_friction[k], i, count * added->d_friction[k]);
    trum_add_to(&lap->d_angle[k], i, count * added->d_angle[k]);
    set_lane(&lanes->sensitivity.x[k], i, r->before.slopes[k] + end * (1 - kept * S));
  }
}

/* The watched period has ended: adds all that are left of the region, if they repeat it; else 0. */
static int trum_repeat_period(trum_lanes* lanes, int i, trum_repetition* r, const trum_orbit_in* in) {
  const trum_period* before = &r->before;
  const trum_real kept_error = lane_value(&lanes->lap.kept, i), period = lane_value(&lanes->equation.period, i);
  const trum_real a = trum_hypotenuse(r->free) * trum_exp(-r->fading * (r->since - 1));
  const int held = !(lane_value(&lanes->equation.push, i) > 0);
  const trum_real decay = held ? 1 : 1 - kept_error > trum_least_decay ? 1 - kept_error : trum_least_decay, count = r->left;
  trum_real drift, remainder, rise, S, in_all, square_in_all, kept;
  trum_period added;
  trum_lap* lap = &lanes->lap;
  trum_end_watch(lanes, i, r, &added);
  S = added.S_there;
  /* the exact motion's change of speed, and how far it may still go; what the remainder may rise to */
  drift = held ? 0 : trum_fabs((added.speed - before->speed) - (added.error - before->error)) / decay;
  remainder = held ? 0 : (added.remainder - kept_error * before->remainder) / decay;
  if (remainder < before->remainder) remainder = before->remainder;
  rise = remainder - before->remainder + drift + (held ? 0 : trum_left_out_speed(lanes, i, in, r, a));
  if (!(rise <= r->allowed)) return 0;
  kept = trum_pow(S, count);
  in_all = 1 - S > trum_least_decay ? S * (1 - kept) / (1 - S) : count;
  square_in_all = 1 - S > trum_least_decay ? S * S * (1 - kept * kept) / (1 - S * S) : count;
  trum_repeat_slopes(lanes, i, r, &added, count, in_all, kept);
#define TRUM_REPEAT(name) trum_add_to(&lap->name, i, count * added.name);
  TRUM_PERIOD_SUMS(TRUM_REPEAT)
#undef TRUM_REPEAT
#define TRUM_REPEAT(name) trum_add_to(&lap->name, i, before->S_there * in_all * added.name);
  TRUM_PERIOD_SHARES(TRUM_REPEAT)
#undef TRUM_REPEAT
  trum_add_to(&lap->SS, i, before->S_there * before->S_there * square_in_all * added.SS);
  set_lane(&lanes->start.S, i, before->S_there * S * kept);
  trum_add_to(&lap->remainder_sum, i, count * (added.remainder_sum + period * rise));
  {
    const trum_real root = trum_sqrt(added.remainder_square / period) + rise;
    trum_add_to(&lap->remainder_square, i, count * period * root * root);
  }
  trum_add_to(&lap->friction_remainder, i, count * (added.friction_remainder + period * trum_left_out_friction(in, a)));
  trum_add_to(&lap->angle_remainder, i,
              count * (added.angle_remainder + TRUM_C(3.2) * period * trum_left_out_contact(in, a)));
  set_lane(&lap->lowest, i, lane_value(&lap->lowest, i) - rise), set_lane(&lap->highest, i, lane_value(&lap->highest, i) + rise);
  set_lane(&lap->remainder, i, (added.remainder > remainder ? added.remainder : remainder) + rise);
  if (lanes->record) lanes->record->travelled += count * added.travelled, lanes->record->since += count * period;
  r->left = 0;
  return 1;
}

/* A piece of a long region has ended: begins the next one, or returns 0 at the region's end. */
static int trum_next_piece(trum_lanes* lanes, int i, trum_repetition* r, const trum_orbit_in* in) {
  if (r->watched && trum_repeat_period(lanes, i, r, in)) return 0;
  if (r->left < TRUM_C(0.5)) return 0;
  if (!with_slopes(lanes)) trum_move_phasors(lanes, i, r);
  trum_begin_piece(lanes, i, r);
  return 1;
}

#endif
