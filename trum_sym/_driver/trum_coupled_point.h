/* The coupled lap of the C library: what it depends on, by motor and drive, and the lap with one state after another. */
#ifndef TRUM_COUPLED_POINT_H
#define TRUM_COUPLED_POINT_H

#include "trum_runge_kutta.h"

#include "trum_coupled.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the coupled system does not know: a field, or -1. */
static inline int trum_uncoupled_field(const struct trum_motor* motor, const struct trum_drive* drive,
                                       trum_real rotor_mass, trum_real phase_coverage) {
  const int field = trum_wrong_field(motor, drive);
  if (field >= 0) return field;
  if (TRUM_LEVEL_start(drive) != TRUM_START_PERIODIC) return trum_drive_start;
  if (TRUM_LEVEL_contact(drive) != TRUM_CONTACT_WINKLER) return trum_drive_contact;
  if (TRUM_LEVEL_tangential(drive) != TRUM_TANGENTIAL_RIGID) return trum_drive_tangential;
  if (motor->amplitude > 0) return trum_motor_amplitude;
  if (!(motor->friction_coefficient > 0)) return trum_motor_friction_coefficient;
  if (!(motor->damping_ratio > 0)) return trum_motor_damping_ratio;
  return trum_inside(rotor_mass, 0, 10, 0, 1, 0) && trum_inside(phase_coverage, 0, 1, 1, 0, 0) ? -1 : TRUM_FIELD_COUNT;
}

/* The own frequency without a rotor; where the one under prepressure was measured, less what the contact adds to it. */
static inline int trum_free_resonance(const struct trum_motor* motor, const struct trum_drive* drive, trum_real* v) {
  static const int resonances[] = {trum_at_quartic, trum_at_eq6, trum_at_printed, trum_at_euler};
  v[trum_at_k_f] = v[trum_at_k_dx] = 0;
  trum_call_resonance(v);
  v[trum_at_omega_n0] = v[resonances[TRUM_LEVEL_resonance(drive)]];
  if (!(motor->resonance_frequency > 0)) return trum_is_size(v[trum_at_omega_n0]);
  trum_call_modal(v);
  trum_call_engagement(v);
  v[trum_at_W_c] = v[trum_at_W];
  trum_call_filling(v);
  v[trum_at_fullness_root] = trum_cbrt(v[trum_at_fullness]);
  trum_call_contact_winkler(v);
  trum_call_plain_reaction(v); /* its central part does not depend on where the surface is faster */
  v[trum_at_across] = 0;
  trum_call_without_contact(v);
  return trum_is_size(v[trum_at_omega_n0]);
}

/* Height of a wave that nothing drives and that friction holds still, under a rotor at rest with its load; 0 if none. */
static inline trum_real trum_held_height(trum_real* v) {
  const trum_real pi = TRUM_C(3.14159265358979323846);
  trum_real loaded;
  v[trum_at_f] = 1;
  trum_call_stall_torque(v);
  loaded = trum_fabs(v[trum_at_T_load] / v[trum_at_torque]);
  if (!(loaded < 1)) return 0;
  v[trum_at_engagement] = 0, v[trum_at_share] = 1 / pi, v[trum_at_theta] = pi;
  v[trum_at_alpha] = pi * (1 + loaded) / 2;
  trum_call_plain_reaction(v);
  trum_call_held_wave(v);
  return v[trum_at_W_held];
}

enum trum_status trum_coupled_values(const struct trum_motor* motor, const struct trum_drive* drive, trum_real rotor_mass,
                                     trum_real phase_coverage, struct trum_point* point, trum_coupled_lap_in* in) {
  const trum_real pi = TRUM_C(3.14159265358979323846), off = drive->periods - drive->on_periods;
  trum_real v[TRUM_VALUES];
  enum trum_status status;
  memset(in, 0, sizeof *in);
  point->field = trum_uncoupled_field(motor, drive, rotor_mass, phase_coverage);
  if (point->field >= 0) return TRUM_BAD_INPUT;
  trum_load_values(motor, drive, v);
  status = trum_stator(motor, drive, 1, point, v); /* the drive's frequency is that of the measured amplitude */
  if (status != TRUM_OK) return status;
  if (!trum_free_resonance(motor, drive, v)) return TRUM_NO_SIZE;
  v[trum_at_c_p] = phase_coverage;
  trum_call_modal(v);
  v[trum_at_F_q] = v[TRUM_LEVEL_amplitude(drive) == TRUM_AMPLITUDE_MEASURED ? trum_at_F_measured : trum_at_F_ceramic];
  trum_call_total_inertia(v);
  trum_call_engagement(v);
  in->M_q = v[trum_at_M_q], in->omega_n0 = v[trum_at_omega_n0], in->xi = v[trum_at_xi], in->F_q = v[trum_at_F_q];
  in->omega_q = v[trum_at_omega_q], in->D = v[trum_at_D], in->k_c = v[trum_at_k_c], in->k_N = v[trum_at_k_N];
  in->n_j = v[trum_at_n_j], in->mu = v[trum_at_mu], in->F_c = v[trum_at_F_c], in->r_c = v[trum_at_r_c];
  in->T_load = v[trum_at_T_load], in->J_total = v[trum_at_J_total];
  in->m = drive->periods, in->on_A = in->off_B = off, in->on_B = 2 * off;
  in->force_A = 1, in->force_B_ahead = drive->phase_lead;
  in->driven_A = 1, in->driven_B = off > 0 && !(in->on_B < in->m) ? TRUM_C(0) : TRUM_C(1);
  /* A's force is ahead of the switching by as much as of A's steady swing if the rotor did nothing */
  v[trum_at_omega_n0] = v[trum_at_omega_n];
  trum_call_mode_swing(v);
  v[trum_at_omega_n0] = in->omega_n0;
  in->force_phase = drive->switching_phase + v[trum_at_lead], in->size = v[trum_at_swing];
  in->tolerance = TRUM_EITHER(1e-2, 1) * drive->tolerance;
  in->mass = rotor_mass, in->reaction = 1, in->height = -1 / (pi * v[trum_at_engagement_per_height]);
  in->held = trum_held_height(v);
  return TRUM_OK;
}

int trum_coupled_lap(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, trum_real slopes[56]) {
  trum_coupled_follow(in, out, slopes);
  return out->v - out->v == 0;
}

#ifdef __cplusplus
}
#endif
#endif
