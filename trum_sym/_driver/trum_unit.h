/* The motor as a unit of co-simulation, whatever the version of the standard: `trum-sym fmu` puts trum.c and the motor's
 * numbers beside it.
 *
 * Inputs count from the next drive cycle on.  Over a cycle the rotor moves as it does from the speed that it has, on the
 * wave that repeats from cycle to cycle; the stator is taken to be in its repeated state, which it reaches by itself. */
#ifndef TRUM_UNIT_H
#define TRUM_UNIT_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "trum.c"
#include "motor.h"

#if defined(_WIN32)
#define FMI_EXPORT __declspec(dllexport)
#else
#define FMI_EXPORT __attribute__((visibility("default")))
#endif

#define SAMPLES_PER_PERIOD 64

/* Value references, in the order of modelDescription.xml */
enum {
  VR_time,
  VR_prepressure, VR_frequency_difference, VR_load_torque, VR_periods, VR_on_periods,
  VR_speed, VR_angle, VR_encoder, VR_contact_fraction, VR_envelope_A, VR_envelope_B, VR_mean_speed,
  VR_start_speed, VR_settled, VR_encoder_counts
};

typedef struct {
  void (*log)(void);   /* of the version's own type, and what it is called with */
  void *environment, *name;
  struct trum_drive wanted, drive; /* as the inputs are; of the present cycle */
  struct trum_point point;
  trum_orbit_in in;
  trum_orbit_out orbit;
  trum_cycle cycle;
  trum_real *speed, *distance; /* of the present cycle, at equal times */
  long count, room;
  double time, begun, angle, rim, start_speed; /* now; the cycle's begin; angle and rim's speed there */
  int64_t encoder_counts;
  bool settled, known, first;
} trum_fmu;

/* Passes a message on; false. */
static bool complain(const trum_fmu* u, const char* what, const char* more);

/* Follows the rotor over a cycle that begins now. */
static bool begin_cycle(trum_fmu* u) {
  const size_t needed = (size_t)(SAMPLES_PER_PERIOD * u->wanted.periods);
  int_least32_t attempts = INT_LEAST32_MAX;
  trum_orbit_out lap;
  if (u->wanted.periods > TRUM_REPEATS_BEYOND) return complain(u, "a unit keeps a whole cycle: its periods are too many", "");
  if (!u->known || memcmp(&u->drive, &u->wanted, sizeof u->drive) != 0) {
    enum trum_status status;
    u->drive = u->wanted, u->known = false;
    status = trum_solve_point(&my_motor, &u->drive, &u->point, &u->in, &u->orbit, &attempts);
    if (status == TRUM_BAD_INPUT) return complain(u, "an input is outside its domain: ", trum_field_name(u->point.field));
    if (status != TRUM_OK && status != TRUM_NOT_CONVERGED) return complain(u, trum_status_text((int)status), "");
    u->known = true;
    memset(&u->cycle, 0, sizeof u->cycle);
    trum_load_cycle(&u->in, &u->cycle.constants, &u->cycle.before);
    trum_cycle_regions(&u->cycle);
    if (u->room < (long)needed) {
      trum_real* const more = (trum_real*)realloc(u->speed, 2 * needed * sizeof *u->speed);
      if (!more) return complain(u, "not enough memory", "");
      u->speed = more, u->room = (long)needed;
    }
    u->distance = u->speed + u->room;
  }
  u->count = (long)needed;
  if (u->first) u->rim = u->settled ? (double)u->orbit.start : u->start_speed * (double)my_motor.contact_radius;
  u->first = false;
  lap = u->orbit, lap.start = (trum_real)u->rim;
  lap.high = trum_larger(lap.high, lap.start); /* the steps' errors are measured by the largest speed */
  if (u->drive.tangential == TRUM_TANGENTIAL_BRUSH) {
    (void)trum_ride(&u->drive, &u->point, &u->in, &u->orbit, u->speed, u->distance, u->count, &attempts);
  } else if (!trum_history(&u->in, &lap, u->speed, u->distance, u->count, &attempts)) {
    return complain(u, "the rotor's motion takes too many steps", "");
  }
  return u->speed[u->count - 1] == u->speed[u->count - 1] ? true : complain(u, "the rotor's motion cannot be followed", "");
}

/* Rim speed and way since the cycle's begin, between samples on the line through them. */
static void interpolate(const trum_fmu* u, double since, double* speed, double* way) {
  const double place = since / (double)u->point.cycle_time * (double)u->count;
  const long below = place < 0 ? 0 : place >= (double)u->count ? u->count - 1 : (long)place;
  const double share = place - (double)below;
  const double v0 = below > 0 ? (double)u->speed[below - 1] : u->rim, s0 = below > 0 ? (double)u->distance[below - 1] : 0;
  *speed = v0 + share * ((double)u->speed[below] - v0), *way = s0 + share * ((double)u->distance[below] - s0);
}

/* Both phases' amplitudes now: those of the motions that displacement and velocity belong to. */
static void envelopes(trum_fmu* u, double since, double* A, double* B) {
  const double omega = (double)(u->in.omega_n + u->in.Delta_omega);
  int region = 0;
  double tau = since;
  for (; region < TRUM_REGIONS - 1 && tau >= (double)u->cycle.duration[region]; ++region)
    tau -= (double)u->cycle.duration[region];
  trum_cycle_enter(&u->cycle, region);
  trum_cycle_at(&u->cycle, (trum_real)tau);
  *A = hypot((double)u->cycle.at.w_A, (double)u->cycle.at.v_A / omega);
  *B = hypot((double)u->cycle.at.w_B, (double)u->cycle.at.v_B / omega);
}

static double angle_now(const trum_fmu* u, double* speed) {
  const double radius = (double)my_motor.contact_radius;
  double v, way;
  interpolate(u, u->time - u->begun, &v, &way);
  if (speed) *speed = v / radius;
  return u->angle + way / radius;
}

static void reset(trum_fmu* u) {
  u->wanted = my_drive;
  u->time = u->begun = u->angle = u->rim = u->start_speed = 0;
  u->encoder_counts = 2097152, u->settled = true, u->known = false, u->first = true;
}

/* A new unit; 0 for a token of another one, or without memory. */
static trum_fmu* new_unit(const char* token) {
  trum_fmu* const u = token && strcmp(token, TRUM_TOKEN) == 0 ? (trum_fmu*)calloc(1, sizeof(trum_fmu)) : 0;
  if (u) reset(u);
  return u;
}

static void free_unit(trum_fmu* u) {
  if (u) free(u->speed), free(u->name);
  free(u);
}

/* What the outputs are now. */
typedef struct {
  double speed, angle, envelope_A, envelope_B;
} trum_outputs;

static trum_outputs outputs(trum_fmu* u) {
  trum_outputs now = {u->start_speed, 0, 0, 0};
  if (!u->known) return now;
  now.angle = angle_now(u, &now.speed);
  envelopes(u, u->time - u->begun, &now.envelope_A, &now.envelope_B);
  return now;
}

static double encoder(const trum_fmu* u) {
  return floor((u->known ? angle_now(u, 0) / 6.283185307179586 : 0) * (double)u->encoder_counts);
}

static bool get_number(const trum_fmu* u, const trum_outputs* now, unsigned reference, double* value) {
  switch (reference) {
    case VR_time: return *value = u->time, true;
    case VR_prepressure: return *value = (double)u->wanted.prepressure, true;
    case VR_frequency_difference: return *value = (double)u->wanted.frequency_difference, true;
    case VR_load_torque: return *value = (double)u->wanted.load_torque, true;
    case VR_periods: return *value = (double)u->wanted.periods, true;
    case VR_on_periods: return *value = (double)u->wanted.on_periods, true;
    case VR_speed: return *value = now->speed, true;
    case VR_angle: return *value = now->angle, true;
    case VR_contact_fraction: return *value = u->known ? (double)u->point.contact_fraction : 0, true;
    case VR_mean_speed: return *value = u->known ? (double)u->point.mean_speed : 0, true;
    case VR_envelope_A: return *value = now->envelope_A, true;
    case VR_envelope_B: return *value = now->envelope_B, true;
    case VR_start_speed: return *value = u->start_speed, true;
    default: return complain(u, "no number has that value reference", "");
  }
}

static bool set_number(trum_fmu* u, unsigned reference, double value) {
  switch (reference) {
    case VR_prepressure: return u->wanted.prepressure = (trum_real)value, true;
    case VR_frequency_difference: return u->wanted.frequency_difference = (trum_real)value, true;
    case VR_load_torque: return u->wanted.load_torque = (trum_real)value, true;
    case VR_periods: return u->wanted.periods = (trum_real)value, true;
    case VR_on_periods: return u->wanted.on_periods = (trum_real)value, true;
    case VR_start_speed: return u->start_speed = value, true;
    default: return complain(u, "no number that can be set has that value reference", "");
  }
}

static bool set_encoder_counts(trum_fmu* u, unsigned reference, int64_t value) {
  if (reference != VR_encoder_counts || value < 1) return complain(u, "encoder_counts has to be 1 at least", "");
  return u->encoder_counts = value, true;
}

/* Goes on to a later time. */
static bool advance(trum_fmu* u, double now, double length) {
  const double radius = (double)my_motor.contact_radius, end = now + length;
  if (!(length >= 0)) return complain(u, "a step cannot go back", "");
  while (end - u->begun >= (double)u->point.cycle_time * (1 - 1e-12)) {
    u->begun += (double)u->point.cycle_time;
    u->angle += (double)u->distance[u->count - 1] / radius;
    u->rim = (double)u->speed[u->count - 1];
    if (!begin_cycle(u)) return false;
  }
  u->time = end;
  return true;
}

#endif
