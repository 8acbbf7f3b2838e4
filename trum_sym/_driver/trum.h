/* The operating point of a travelling-wave motor: generated/ and this header are a C99 library (and C++).
 *
 * Define TRUM_IMPLEMENTATION before including it in exactly one C file, and compile generated/trum_*.c beside that.
 * No allocation, no globals, re-entrant.  SI units; trum_real is double, or float with -DTRUM_REAL_BITS=32
 * for all files.  -DTRUM_COUPLED adds laps of the coupled system.  docs/c-library.md says more. */
#ifndef TRUM_H
#define TRUM_H

#include <string.h>

#include "trum_fields.h"
#include "trum_kernels.h"
#include "trum_orbit_fields.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TRUM_NUMBER_FIELD(name, symbol, unit, low, high, low_open, high_open, integer, required) trum_real name;
#define TRUM_FIGURE_FIELD(name, unit) trum_real name;
#define TRUM_CHOICE_FIELD(name, count, words) int name;

/* Units, symbols and domains are in TRUM_MOTOR_FIELDS; where a number need not be given, 0 means not given. */
struct trum_motor {
  TRUM_MOTOR_FIELDS(TRUM_NUMBER_FIELD)
};

/* TRUM_DRIVE_FIELDS and TRUM_CHOICES; the tolerance is of the bounds of errors, of speeds relative to the largest, from
 * TRUM_FINEST_TOLERANCE to TRUM_COARSEST_TOLERANCE. */
struct trum_drive {
  TRUM_DRIVE_FIELDS(TRUM_NUMBER_FIELD)
  TRUM_CHOICES(TRUM_CHOICE_FIELD)
  trum_real tolerance;
  int_least32_t max_steps; /* attempts at steps of the rotor's motion that a call may take; 0: 2^31 - 1 */
};

/* TRUM_FIGURES; without meaning: NaN, and infinite ratios where the determinant never turns back. */
struct trum_point {
  TRUM_FIGURES(TRUM_FIGURE_FIELD)
  int converged;    /* do the bounds of the errors meet the tolerance? */
  int_least32_t steps; /* attempts at steps of the rotor's motion that the call has taken */
  int full_contact; /* is the whole wave in contact at times? */
  int taut;         /* no string, or one that friction cannot make slack whatever it does? */
  int outside_fit;  /* is the prepressure outside those at which the amplitude was measured? */
  int undamped;     /* does a lack of damping next to a resonance make the figures, and not the motor? */
  int field;        /* bad input: which, for trum_field_name; else -1 */
};

#undef TRUM_NUMBER_FIELD
#undef TRUM_FIGURE_FIELD
#undef TRUM_CHOICE_FIELD

enum trum_status {
  TRUM_OK,
  TRUM_BAD_INPUT,     /* a field outside its domain, or one that does not fit another; point->field */
  TRUM_NO_SIZE,       /* the motor's values give no finite, positive resonance, amplitude or length */
  TRUM_UNDAMPED,      /* an undamped resonant drive, or a periodic start that the cycle does not fix */
  TRUM_NOT_SETTLED,   /* forced amplitude and resonance do not settle */
  TRUM_RUNAWAY,       /* no speed balances the load: speeds are NaN, the rest is right */
  TRUM_NOT_CONVERGED, /* speeds are the best found, and miss the tolerance */
  TRUM_OUT_OF_STEPS,  /* max_steps are taken: speeds are the best found, or NaN; what needs no steps is right */
  TRUM_NO_BRUSH,      /* the whole wave touches a brush: speeds and stall torque are NaN, the rest is right */
  TRUM_STATUSES
};

/* Every figure of the operating point; those that do not follow are NaN. */
enum trum_status trum_evaluate(const struct trum_motor* motor, const struct trum_drive* drive, struct trum_point* point);

/* The same without the orbit, which takes most of the time and of the code: speeds, stall torque and contact are NaN. */
enum trum_status trum_evaluate_determinants(const struct trum_motor* motor, const struct trum_drive* drive,
                                            struct trum_point* point);

/* As trum_evaluate, with the rotor's speed (rad/s) and its angle since t1 (rad) at count equal times of a cycle, the last at
 * its end; both are NaN unless the status is TRUM_OK. */
enum trum_status trum_simulate(const struct trum_motor* motor, const struct trum_drive* drive, struct trum_point* point,
                               trum_real* speed, trum_real* angle, long count);

#ifdef TRUM_COUPLED
/* Phases, contact and rotor as one system: what a lap of superimposed pulses depends on, by motor and drive, for
 * trum_coupled_lap.  The rotor's mass goes up and down with it (kg; 0: it follows the wave), a phase's electrodes drive a share
 * of the ring (1: all of it; counts where the amplitude is forced).  The state is that of a motor at rest, terminals of a
 * phase that is off are short; point->field is where the status is TRUM_BAD_INPUT. */
enum trum_status trum_coupled_values(const struct trum_motor* motor, const struct trum_drive* drive, trum_real rotor_mass,
                                     trum_real phase_coverage, struct trum_point* point, trum_coupled_lap_in* in);

/* A lap from the state in `in`: the state after it, means and extremes; and, unless that is null, the slopes of the seven
 * numbers of the state and of the mean speed by those at the start, row by row.  0 where it cannot be stepped: NaN. */
int trum_coupled_lap(const trum_coupled_lap_in* in, trum_coupled_lap_out* out, trum_real slopes[56]);
#endif

/* The name of a field by its number in point->field: the motor's, then the drive's; 0 if it is none. */
const char* trum_field_name(int field);

/* What a status means, in words. */
const char* trum_status_text(int status);

#ifdef __cplusplus
}
#endif

#ifdef TRUM_IMPLEMENTATION
#include "trum_point.h"
#endif
#endif
