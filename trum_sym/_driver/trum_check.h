/* What motor and drive may be: the fields' names and numbers, and the first one that is outside its domain. */
#ifndef TRUM_CHECK_H
#define TRUM_CHECK_H

#include "trum_values.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TRUM_FIELD_NAME(name, symbol, unit, low, high, low_open, high_open, integer, required) #name,
#define TRUM_CHOICE_NAME(name, count, words) #name,
static const char* const trum_field_names[] = {TRUM_MOTOR_FIELDS(TRUM_FIELD_NAME) TRUM_DRIVE_FIELDS(TRUM_FIELD_NAME)
                                                   TRUM_CHOICES(TRUM_CHOICE_NAME) "tolerance", "max_steps"};
#undef TRUM_FIELD_NAME
#undef TRUM_CHOICE_NAME

/* The numbers of the fields, in the order of trum_field_names. */
#define TRUM_FIELD_NUMBER(name, symbol, unit, low, high, low_open, high_open, integer, required) trum_motor_##name,
enum { TRUM_MOTOR_FIELDS(TRUM_FIELD_NUMBER) TRUM_MOTOR_COUNT };
#undef TRUM_FIELD_NUMBER
#define TRUM_FIELD_NUMBER(name, symbol, unit, low, high, low_open, high_open, integer, required) trum_drive_##name,
#define TRUM_CHOICE_NUMBER(name, count, words) trum_drive_##name,
enum {
  trum_before_drive = TRUM_MOTOR_COUNT - 1,
  TRUM_DRIVE_FIELDS(TRUM_FIELD_NUMBER) TRUM_CHOICES(TRUM_CHOICE_NUMBER) trum_drive_tolerance,
  trum_drive_max_steps,
  TRUM_FIELD_COUNT
};
#undef TRUM_FIELD_NUMBER
#undef TRUM_CHOICE_NUMBER

const char* trum_field_name(int field) { return field < 0 || field >= TRUM_FIELD_COUNT ? 0 : trum_field_names[field]; }

const char* trum_status_text(int status) {
  static const char* const texts[TRUM_STATUSES] = {
      "ok",
      "bad input",
      "the motor's values give no finite size",
      "without damping this drive has no steady or no repeated state",
      "forced amplitude and resonance do not settle",
      "no speed balances the load: it exceeds what friction can transmit",
      "the bounds of the errors miss the tolerance",
      "the steps that were allowed are taken before the orbit was found",
      "the whole wave touches: no bristle of the layer leaves the contact"};
  return status < 0 || status >= TRUM_STATUSES ? 0 : texts[status];
}

static inline int trum_inside(trum_real x, trum_real low, trum_real high, int low_open, int high_open, int integer) {
  if (!(x - x == 0)) return 0; /* NaN or infinite */
  if (low_open ? x <= low : x < low) return 0;
  if (high_open ? x >= high : x > high) return 0;
  return !integer || trum_floor(x) == x;
}

/* A level that does not go with another, the motor or the drive; -1 if all is well. */
static inline int trum_unlike_levels(const struct trum_motor* motor, const struct trum_drive* drive) {
  const int hertz = TRUM_LEVEL_contact(drive) == TRUM_CONTACT_HERTZ;
  if (TRUM_LEVEL_compliance(drive) == TRUM_COMPLIANCE_FLANGE) {
    if (hertz) return trum_drive_compliance;
    if (!(motor->contact_stiffness > 0)) {
      if (!(motor->flange_thickness > 0)) return trum_motor_flange_thickness;
      if (!(motor->flange_length > 0)) return trum_motor_flange_length;
      if (!(motor->flange_young_modulus > 0)) return trum_motor_flange_young_modulus;
      if (!(motor->flange_poisson_ratio > 0)) return trum_motor_flange_poisson_ratio;
    }
  }
  if (TRUM_LEVEL_tangential(drive) == TRUM_TANGENTIAL_BRUSH) {
    if (hertz || TRUM_LEVEL_start(drive) == TRUM_START_REST) return trum_drive_tangential;
    if (drive->on_periods < drive->periods) return trum_drive_tangential;
    if (!(motor->friction_coefficient > 0)) return trum_motor_friction_coefficient;
  }
  return -1;
}

/* The first field outside its domain, or one that does not fit another; -1 if all is well. */
static inline int trum_wrong_field(const struct trum_motor* motor, const struct trum_drive* drive) {
  int field = 0;
#define TRUM_CHECK(of, x, low, high, low_open, high_open, integer, required)                                      \
  if ((required || of->x != 0) && !trum_inside(of->x, low, high, low_open, high_open, integer)) \
    return field;                                                                                                 \
  ++field;
#define TRUM_CHECK_MOTOR(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  TRUM_CHECK(motor, name, low, high, low_open, high_open, integer, required)
#define TRUM_CHECK_DRIVE(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  TRUM_CHECK(drive, name, low, high, low_open, high_open, integer, required)
#define TRUM_CHECK_CHOICE(name, count, words)                 \
  if (drive->name < 0 || drive->name >= (count) || drive->name != TRUM_LEVEL_##name(drive)) return field; \
  ++field;
  TRUM_MOTOR_FIELDS(TRUM_CHECK_MOTOR)
  TRUM_DRIVE_FIELDS(TRUM_CHECK_DRIVE)
  TRUM_CHOICES(TRUM_CHECK_CHOICE)
#undef TRUM_CHECK
#undef TRUM_CHECK_MOTOR
#undef TRUM_CHECK_DRIVE
#undef TRUM_CHECK_CHOICE
  if (!trum_inside(drive->tolerance, TRUM_FINEST_TOLERANCE * (1 - TRUM_C(1e-7)),
                   TRUM_COARSEST_TOLERANCE * (1 + TRUM_C(1e-7)), 0, 0, 0))
    return field;
  if (drive->max_steps < 0) return trum_drive_max_steps;
  if (motor->tooth_height >= motor->beam_thickness) return trum_motor_tooth_height;
  if (motor->flange_thickness >= motor->beam_thickness) return trum_motor_flange_thickness;
  if (motor->flange_length >= motor->radius) return trum_motor_flange_length;
  if (motor->fit_prepressure_min >= motor->fit_prepressure_max) return trum_motor_fit_prepressure_min;
  if (motor->tooth_count * motor->slot_width >= motor->perimeter) return trum_motor_slot_width;
  if (2 * drive->on_periods < drive->periods || drive->on_periods > drive->periods) return trum_drive_on_periods;
  if ((TRUM_LEVEL_load(drive) == TRUM_LOAD_WEIGHT) != (drive->load_radius > 0)) return trum_drive_load_radius;
  if (!(drive->phase_lead * drive->phase_lead > 0)) return trum_drive_phase_lead;
  return trum_unlike_levels(motor, drive);
}

#ifdef __cplusplus
}
#endif
#endif
