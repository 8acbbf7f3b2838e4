/* The implementation of trum.h: which kernel follows which, and where to go on or to stop. */
#ifndef TRUM_POINT_H
#define TRUM_POINT_H

#include "trum_brush.h"
#include "trum_check.h"
#include "trum_cycle.h"
#include "trum_orbit.h"
#include "trum_values.h"

#ifdef __cplusplus
extern "C" {
#endif

static inline int trum_is_size(trum_real x) { return x - x == 0 && x > 0; }

/* Foundation, resonance and drive frequency at the amplitude in v. */
static inline void trum_resonate(const struct trum_motor* motor, const struct trum_drive* drive, trum_real* v) {
  static const int foundations[] = {trum_at_harmonic, trum_at_smeared, trum_at_printed};
  static const int resonances[] = {trum_at_quartic, trum_at_eq6, trum_at_printed, trum_at_euler};
  const trum_real pi = TRUM_C(3.14159265358979323846);
  v[trum_at_k_f] = 0;
  if (TRUM_LEVEL_foundation(drive) != TRUM_FOUNDATION_NONE) {
    if (TRUM_LEVEL_contact(drive) == TRUM_CONTACT_WINKLER) {
      v[trum_at_theta] = trum_half_angle(v[trum_at_F_c], v[trum_at_k_N], v[trum_at_W], v[trum_at_k_c], v[trum_at_n_j]);
    } else {
      trum_call_hertz_half_angle(v);
      if (v[trum_at_theta] > pi) v[trum_at_theta] = pi;
    }
    trum_call_foundation(v);
    v[trum_at_k_f] = v[foundations[TRUM_LEVEL_foundation(drive)]];
  }
  v[trum_at_k_dx] = v[trum_at_k_f]; /* "printed" takes the number as it stands */
  trum_call_resonance(v);
  v[trum_at_omega_n] = v[resonances[TRUM_LEVEL_resonance(drive)]];
  if (motor->resonance_frequency > 0) v[trum_at_omega_n] = 2 * pi * motor->resonance_frequency;
  v[trum_at_omega_q] = v[trum_at_omega_n] + v[trum_at_Delta_omega];
}

/* Let k_N be the stiffness of the whole contact, as measured or in series; 0 if it has no size. */
static inline int trum_contact_of(const struct trum_motor* motor, const struct trum_drive* drive, trum_real* v) {
  if (!(motor->contact_stiffness > 0)) {
    if (TRUM_LEVEL_compliance(drive) != TRUM_COMPLIANCE_FLANGE) return 1;
    trum_call_contact_stiffness(v);
  }
  v[trum_at_k_N] = v[trum_at_k_con];
  return trum_is_size(v[trum_at_k_con]);
}

/* Whether the wave has a size, and, where eq. 8 gives its height, is not higher than it is long. */
static inline enum trum_status trum_check_wave(int modelled, struct trum_point* point, const trum_real* v) {
  if (!trum_is_size(v[trum_at_W]) || !trum_is_size(v[trum_at_D]) || !trum_is_size(v[trum_at_k_c])) return TRUM_NO_SIZE;
  if (!modelled || v[trum_at_W] * v[trum_at_k_c] < 1) return TRUM_OK;
  point->field = trum_drive_prepressure;
  return TRUM_BAD_INPUT;
}

/* Section, resonance and amplitude under prepressure, which is the measured one or follows from the ceramic's force. */
static inline enum trum_status trum_stator(const struct trum_motor* motor, const struct trum_drive* drive, int measured,
                                           struct trum_point* point, trum_real* v) {
  const int modelled = !(motor->amplitude > 0);
  /* two amplitudes in turn that differ in the last digits only have settled */
  const trum_real settled = TRUM_EITHER(1e-13, 4 * FLT_EPSILON);
  int i;
  if (!(motor->neutral_axis > 0)) trum_call_neutral_axis(v);
  if (!(motor->wavenumber > 0)) trum_call_wavenumber(v);
  if (!(motor->layer_stiffness > 0)) trum_call_layer_stiffness(v);
  if (!trum_contact_of(motor, drive, v)) return TRUM_NO_SIZE;
  trum_call_section(v);
  point->outside_fit = modelled && (drive->prepressure < motor->fit_prepressure_min ||
                                    drive->prepressure > motor->fit_prepressure_max);
  if (modelled) trum_call_amplitude_measured(v);
  else v[trum_at_W] = motor->amplitude;
  for (i = 0; i < 200; ++i) {
    trum_real before = v[trum_at_W], change;
    trum_resonate(motor, drive, v);
    if (!trum_is_size(v[trum_at_omega_n])) return TRUM_NO_SIZE;
    if (!(v[trum_at_omega_q] >= TRUM_C(0.1) * v[trum_at_omega_n])) {
      point->field = trum_drive_frequency_difference;
      return TRUM_BAD_INPUT;
    }
    if (!modelled || measured) break;
    trum_call_amplitude_forced(v);
    change = v[trum_at_W] > before ? v[trum_at_W] - before : before - v[trum_at_W];
    if (change <= settled * v[trum_at_W]) {
      v[trum_at_W] = before; /* that of the resonance */
      break;
    }
  }
  if (i == 200) return TRUM_NOT_SETTLED;
  return trum_check_wave(modelled, point, v);
}

/* Free motion before t1 of phases of unit amplitude. */
static inline enum trum_status trum_begin_cycle(const struct trum_drive* drive, trum_real* v) {
  v[trum_at_W] = 1;
  v[trum_at_a_A] = v[trum_at_b_A] = v[trum_at_a_B] = v[trum_at_b_B] = 0;
  if (TRUM_LEVEL_start(drive) == TRUM_START_REST) trum_call_start_rest(v);
  if (TRUM_LEVEL_start(drive) == TRUM_START_PERIODIC) {
    trum_call_start_periodic(v);
    if (v[trum_at_repetition] < TRUM_EITHER(1e-9, 1e-6)) return TRUM_UNDAMPED;
  }
  return TRUM_OK;
}

static inline void trum_determinants(trum_real* v) {
  trum_cycle c;
  trum_cycle_constants* k = &c.constants;
  trum_sums sums;
  memset(&c, 0, sizeof c);
  k->omega_n = v[trum_at_omega_n], k->Delta_omega = v[trum_at_Delta_omega], k->xi = v[trum_at_xi];
  k->psi = v[trum_at_psi], k->s = v[trum_at_s], k->m = v[trum_at_m], k->n = v[trum_at_n];
  k->W = k->D = k->k_c = 1;
  c.before.a_A = v[trum_at_a_A], c.before.b_A = v[trum_at_b_A];
  c.before.a_B = v[trum_at_a_B], c.before.b_B = v[trum_at_b_B];
  sums = trum_cycle_sums(&c, 2);
  v[trum_at_q_plus] = sums.q_plus, v[trum_at_q_minus] = sums.q_minus;
  v[trum_at_p_plus] = sums.p_plus, v[trum_at_p_minus] = sums.p_minus;
  trum_call_measures(v);
}

static inline void trum_orbit_of(const struct trum_drive* drive, trum_real* v, trum_orbit_in* in) {
  const int hertz = TRUM_LEVEL_contact(drive) == TRUM_CONTACT_HERTZ;
  const trum_real W = v[trum_at_W];
  trum_call_rotor_coefficients(v);
  memset(in, 0, sizeof *in);
  in->omega_n = v[trum_at_omega_n], in->Delta_omega = v[trum_at_Delta_omega];
  in->xi = v[trum_at_xi], in->psi = v[trum_at_psi], in->s = v[trum_at_s];
  in->m = v[trum_at_m], in->n = v[trum_at_n], in->W = W;
  in->a_A = v[trum_at_a_A] * W, in->b_A = v[trum_at_b_A] * W;
  in->a_B = v[trum_at_a_B] * W, in->b_B = v[trum_at_b_B] * W;
  in->D = v[trum_at_D], in->k_c = v[trum_at_k_c];
  in->engagement_per_height = v[trum_at_engagement_per_height];
  in->W_full = v[hertz ? trum_at_W_full_hertz : trum_at_W_full_winkler], in->hertz = (trum_real)hertz;
  in->push = v[trum_at_push], in->drag = v[trum_at_drag];
  in->tolerance = drive->tolerance, in->held = 1;
}

/* The steady speed over a brush: what trum_orbits finds of a rigid layer; theta pi leaves it NaN. */
static inline void trum_brush_orbit(const struct trum_motor* motor, const struct trum_drive* drive, trum_real* v,
                                    trum_orbit_out* out) {
  const trum_real side = drive->phase_lead;
  trum_real ratio, error, most, wanted;
  memset(out, 0, sizeof *out);
  v[trum_at_theta] = trum_half_angle(v[trum_at_F_c], v[trum_at_k_N], v[trum_at_W], v[trum_at_k_c], v[trum_at_n_j]);
  if (!(motor->tangential_stiffness > 0)) trum_call_tangential_stiffness(v);
  trum_call_brush_coefficient(v);
  v[trum_at_f] = 1;
  trum_call_stall_torque(v);
  most = v[trum_at_torque];
  wanted = drive->phase_lead * drive->load_torque / most;
  ratio = trum_brush_speed(v[trum_at_theta], v[trum_at_grip], wanted);
  error = trum_brush_speed_error(v[trum_at_theta], v[trum_at_grip], wanted, ratio);
  out->mean = out->low = out->high = out->start = side * ratio * v[trum_at_R_v];
  out->mean_error = out->low_error = out->high_error = error * v[trum_at_R_v];
  out->contact = v[trum_at_theta] / TRUM_C(3.14159265358979323846);
  out->held = side * trum_brush_friction(v[trum_at_theta], v[trum_at_grip], 0);
  out->error = error, out->contact_error = out->held_error = trum_brush_rounding(v[trum_at_grip]);
  if (!(out->mean - out->mean == 0)) {
    out->variance = out->deviation_error = TRUM_NAN;
    if (out->contact < 1) out->flags = trum_runaway; /* else no bristle leaves the contact */
  } else if (error <= drive->tolerance) {
    out->flags = trum_converged;
  }
}

/* Speed and way of the rim at count equal times of a cycle, the last at its end; 0 for want of attempts. */
static inline int trum_ride(const struct trum_drive* drive, const struct trum_point* point, const trum_orbit_in* in,
                             const trum_orbit_out* out, trum_real* speed, trum_real* distance, long count,
                             int_least32_t* attempts) {
  long i;
  if (TRUM_LEVEL_tangential(drive) != TRUM_TANGENTIAL_BRUSH)
    return trum_history(in, out, speed, distance, count, attempts);
  for (i = 0; i < count; ++i) {
    speed[i] = out->mean;
    distance[i] = out->mean * point->cycle_time * (trum_real)(i + 1) / (trum_real)count;
  }
  return 1;
}

/* Whether a lack of damping, not the motor, makes the figures: the drive is at an undamped resonance as far as a cycle can
 * tell, or a cycle repeats the free motion before t1, that of phases of unit amplitude, nearly in phase. */
static inline int trum_lacks_damping(const struct trum_motor* motor, const trum_real* v) {
  const trum_real omega_n = v[trum_at_omega_n], difference = trum_fabs(v[trum_at_Delta_omega]);
  const trum_real A = trum_sqrt(v[trum_at_a_A] * v[trum_at_a_A] + v[trum_at_b_A] / omega_n * (v[trum_at_b_A] / omega_n));
  const trum_real B = trum_sqrt(v[trum_at_a_B] * v[trum_at_a_B] + v[trum_at_b_B] / omega_n * (v[trum_at_b_B] / omega_n));
  if (!(motor->damping_ratio > 0) && difference * v[trum_at_m] < TRUM_C(0.01) * v[trum_at_omega_q]) return 1;
  return A > 10 || B > 10;
}

/* All symbols 0 but those of motor and drive. */
static inline void trum_load_values(const struct trum_motor* motor, const struct trum_drive* drive, trum_real* v) {
  memset(v, 0, TRUM_VALUES * sizeof *v);
#define TRUM_LOAD_MOTOR(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  v[trum_at_##symbol] = motor->name;
#define TRUM_LOAD_DRIVE(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  v[trum_at_##symbol] = drive->name;
  TRUM_MOTOR_FIELDS(TRUM_LOAD_MOTOR)
  TRUM_DRIVE_FIELDS(TRUM_LOAD_DRIVE)
#undef TRUM_LOAD_MOTOR
#undef TRUM_LOAD_DRIVE
  v[trum_at_Delta_omega] = TRUM_C(6.283185307179586) * drive->frequency_difference;
}

/* Everything but the orbit; the values of all symbols are left in v. */
static inline enum trum_status trum_solve_determinants(const struct trum_motor* motor, const struct trum_drive* drive,
                                                       struct trum_point* point, trum_real* v) {
  const trum_real turn = TRUM_C(6.283185307179586);
  trum_real W;
  enum trum_status status;
#define TRUM_UNKNOWN(name, unit) point->name = TRUM_NAN;
  TRUM_FIGURES(TRUM_UNKNOWN)
#undef TRUM_UNKNOWN
  point->converged = point->full_contact = point->outside_fit = point->undamped = point->taut = 0;
  point->steps = 0;
  point->field = trum_wrong_field(motor, drive);
  if (point->field >= 0) return TRUM_BAD_INPUT;
  trum_load_values(motor, drive, v);
  if (!(motor->damping_ratio > 0) && !(drive->frequency_difference < 0) && !(drive->frequency_difference > 0))
    return TRUM_UNDAMPED;
  status = trum_stator(motor, drive, TRUM_LEVEL_amplitude(drive) == TRUM_AMPLITUDE_MEASURED, point, v);
  if (status != TRUM_OK) return status;
  W = v[trum_at_W];
  status = trum_begin_cycle(drive, v);
  if (status != TRUM_OK) return status;
  trum_call_drive(v);
  point->undamped = trum_lacks_damping(motor, v);
  trum_determinants(v);
  point->resonance_frequency = v[trum_at_omega_n] / turn, point->drive_frequency = v[trum_at_omega_q] / turn;
  point->cycle_time = v[trum_at_T], point->amplitude = W;
  point->neutral_axis = v[trum_at_D], point->wavenumber = v[trum_at_k_c];
  point->q_ratio = v[trum_at_q_ratio], point->q_square_ratio = v[trum_at_q_square_ratio];
  point->q_average = v[trum_at_q_average], point->q_volatility = v[trum_at_q_volatility];

  v[trum_at_f] = -1; /* all friction lowers the weight */
  trum_call_string_tension(v);
  point->taut = TRUM_LEVEL_load(drive) == TRUM_LOAD_TORQUE || v[trum_at_tension] >= 0;
  v[trum_at_W] = W;
  return TRUM_OK;
}

static inline enum trum_status trum_solve_point(const struct trum_motor* motor, const struct trum_drive* drive,
                                                struct trum_point* point, trum_orbit_in* in, trum_orbit_out* out,
                                                int_least32_t* attempts) {
  trum_real v[TRUM_VALUES], least;
  const enum trum_status status = trum_solve_determinants(motor, drive, point, v);
  int flags, done = 1;
  if (status != TRUM_OK) return status;
  trum_orbit_of(drive, v, in);
  if (TRUM_LEVEL_tangential(drive) == TRUM_TANGENTIAL_BRUSH) {
    trum_brush_orbit(motor, drive, v, out);
  } else {
    done = trum_orbits(in, out, 0, 0, 1, attempts);
  }
  flags = (int)out->flags;
  v[trum_at_f] = out->held;
  trum_call_stall_torque(v);
  point->stall_torque = v[trum_at_torque], point->contact_fraction = out->contact;
  point->mean_speed = out->mean / motor->contact_radius;
  point->min_speed = out->low / motor->contact_radius;
  point->max_speed = out->high / motor->contact_radius;
  point->speed_volatility = trum_sqrt(out->variance) / trum_fabs(out->mean);
  v[trum_at_f] = out->held_error;
  trum_call_stall_torque(v);
  point->stall_torque_error = v[trum_at_torque];
  point->mean_speed_error = out->mean_error / motor->contact_radius;
  point->min_speed_error = out->low_error / motor->contact_radius;
  point->max_speed_error = out->high_error / motor->contact_radius;
  least = trum_fabs(out->mean) - out->mean_error;
  point->speed_volatility_error = (trum_real)(
      least <= 0 ? TRUM_HUGE
                 : (out->deviation_error + trum_sqrt(out->variance) / trum_fabs(out->mean) * out->mean_error) / least);
  point->converged = (flags & trum_converged) > 0, point->full_contact = (flags & trum_full_contact) > 0;
  if (TRUM_LEVEL_tangential(drive) == TRUM_TANGENTIAL_BRUSH && !(out->contact < 1)) return TRUM_NO_BRUSH;
  if (!done) return TRUM_OUT_OF_STEPS;
  return flags & trum_runaway ? TRUM_RUNAWAY : point->converged ? TRUM_OK : TRUM_NOT_CONVERGED;
}

enum trum_status trum_evaluate_determinants(const struct trum_motor* motor, const struct trum_drive* drive,
                                            struct trum_point* point) {
  trum_real v[TRUM_VALUES];
  return trum_solve_determinants(motor, drive, point, v);
}

static inline int_least32_t trum_allowed_steps(const struct trum_drive* drive) {
  return drive->max_steps > 0 ? drive->max_steps : INT_LEAST32_MAX;
}

enum trum_status trum_evaluate(const struct trum_motor* motor, const struct trum_drive* drive,
                               struct trum_point* point) {
  trum_orbit_in in;
  trum_orbit_out out;
  const int_least32_t allowed = trum_allowed_steps(drive);
  int_least32_t attempts = allowed;
  const enum trum_status status = trum_solve_point(motor, drive, point, &in, &out, &attempts);
  point->steps = allowed - attempts;
  return status;
}

enum trum_status trum_simulate(const struct trum_motor* motor, const struct trum_drive* drive, struct trum_point* point,
                               trum_real* speed, trum_real* angle, long count) {
  trum_orbit_in in;
  trum_orbit_out out;
  const int_least32_t allowed = trum_allowed_steps(drive);
  int_least32_t attempts = allowed;
  enum trum_status status = trum_solve_point(motor, drive, point, &in, &out, &attempts);
  long i;
  if (status == TRUM_OK && count > 0 && !trum_ride(drive, point, &in, &out, speed, angle, count, &attempts))
    status = TRUM_OUT_OF_STEPS;
  point->steps = allowed - attempts;
  for (i = 0; i < count; ++i) {
    speed[i] = status == TRUM_OK ? speed[i] / motor->contact_radius : TRUM_NAN;
    angle[i] = status == TRUM_OK ? angle[i] / motor->contact_radius : TRUM_NAN;
  }
  return status;
}

#ifdef __cplusplus
}
#endif
#ifdef TRUM_COUPLED
#include "trum_coupled_point.h"
#endif
#endif
