/* A co-simulation unit of FMI 3.0 around the C library: `trum-sym fmu` puts trum.c and the motor's numbers beside it.
 *
 * Inputs count from the next drive cycle on.  Over a cycle the rotor moves as it does from the speed that it has, on the
 * wave that repeats from cycle to cycle; the stator is taken to be in its repeated state, which it reaches by itself. */
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

/* As the standard declares them */
typedef void* fmi3Instance;
typedef void* fmi3InstanceEnvironment;
typedef void* fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef double fmi3Float64;
typedef int32_t fmi3Int32;
typedef int64_t fmi3Int64;
typedef bool fmi3Boolean;
typedef char fmi3Char;
typedef const fmi3Char* fmi3String;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);

#define SAMPLES_PER_PERIOD 64

/* Value references, in the order of modelDescription.xml */
enum {
  VR_time,
  VR_prepressure, VR_frequency_difference, VR_load_torque, VR_periods, VR_on_periods,
  VR_speed, VR_angle, VR_encoder, VR_contact_fraction, VR_envelope_A, VR_envelope_B, VR_mean_speed,
  VR_start_speed, VR_settled, VR_encoder_counts
};

typedef struct {
  fmi3LogMessageCallback log;
  fmi3InstanceEnvironment environment;
  struct trum_drive wanted, drive; /* as the inputs are; of the present cycle */
  struct trum_point point;
  trum_orbit_in in;
  trum_orbit_out orbit;
  trum_cycle cycle;
  trum_real *speed, *distance; /* of the present cycle, at equal times */
  long count, room;
  double time, begun, angle, rim, start_speed; /* now; the cycle's begin; angle and rim's speed there */
  fmi3Int64 encoder_counts;
  bool settled, known, first;
} trum_fmu;

static fmi3Status complain(trum_fmu* u, const char* what, const char* more) {
  char text[256];
  (void)snprintf(text, sizeof text, "%s%s", what, more);
  if (u->log) u->log(u->environment, fmi3Error, "logStatusError", text);
  return fmi3Error;
}

/* Follows the rotor over a cycle that begins now. */
static fmi3Status begin_cycle(trum_fmu* u) {
  const size_t needed = (size_t)(SAMPLES_PER_PERIOD * u->wanted.periods);
  int_least32_t attempts = INT_LEAST32_MAX;
  trum_orbit_out lap;
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
  return u->speed[u->count - 1] == u->speed[u->count - 1] ? fmi3OK : complain(u, "the rotor's motion cannot be followed", "");
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

FMI_EXPORT const char* fmi3GetVersion(void) { return "3.0"; }

FMI_EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance i, fmi3Boolean on, size_t n, const fmi3String* categories) {
  return (void)i, (void)on, (void)n, (void)categories, fmi3OK;
}

static void reset(trum_fmu* u) {
  u->wanted = my_drive;
  u->time = u->begun = u->angle = u->rim = u->start_speed = 0;
  u->encoder_counts = 2097152, u->settled = true, u->known = false, u->first = true;
}

FMI_EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
    fmi3Boolean early, const fmi3ValueReference* intermediate, size_t n, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, void (*update)(void)) {
  trum_fmu* u;
  (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)intermediate, (void)n;
  (void)update;
  if (!token || strcmp(token, TRUM_TOKEN) != 0) {
    if (log) log(environment, fmi3Error, "logStatusError", "the token is of another unit");
    return 0;
  }
  u = (trum_fmu*)calloc(1, sizeof *u);
  if (!u) return 0;
  u->log = log, u->environment = environment;
  reset(u);
  return u;
}

FMI_EXPORT void fmi3FreeInstance(fmi3Instance instance) {
  if (!instance) return;
  free(((trum_fmu*)instance)->speed);
  free(instance);
}

FMI_EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                                  fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
  trum_fmu* u = (trum_fmu*)instance;
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  u->time = u->begun = start;
  return fmi3OK;
}
FMI_EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) { return begin_cycle((trum_fmu*)instance); }
FMI_EXPORT fmi3Status fmi3Terminate(fmi3Instance instance) { return (void)instance, fmi3OK; }
FMI_EXPORT fmi3Status fmi3Reset(fmi3Instance instance) { return reset((trum_fmu*)instance), fmi3OK; }

FMI_EXPORT fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n, fmi3Float64 values[],
                                     size_t count) {
  trum_fmu* u = (trum_fmu*)instance;
  const bool ready = u->known;
  double envelope_A = 0, envelope_B = 0, speed = u->start_speed, angle = 0;
  size_t k;
  if (count < n) return complain(u, "too few places for the values", "");
  if (ready) angle = angle_now(u, &speed), envelopes(u, u->time - u->begun, &envelope_A, &envelope_B);
  for (k = 0; k < n; ++k) switch (refs[k]) {
      case VR_time: values[k] = u->time; break;
      case VR_prepressure: values[k] = (double)u->wanted.prepressure; break;
      case VR_frequency_difference: values[k] = (double)u->wanted.frequency_difference; break;
      case VR_load_torque: values[k] = (double)u->wanted.load_torque; break;
      case VR_periods: values[k] = (double)u->wanted.periods; break;
      case VR_on_periods: values[k] = (double)u->wanted.on_periods; break;
      case VR_speed: values[k] = speed; break;
      case VR_angle: values[k] = angle; break;
      case VR_contact_fraction: values[k] = ready ? (double)u->point.contact_fraction : 0; break;
      case VR_mean_speed: values[k] = ready ? (double)u->point.mean_speed : 0; break;
      case VR_envelope_A: values[k] = envelope_A; break;
      case VR_envelope_B: values[k] = envelope_B; break;
      case VR_start_speed: values[k] = u->start_speed; break;
      default: return complain(u, "no number has that value reference", "");
    }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                     const fmi3Float64 values[], size_t count) {
  trum_fmu* u = (trum_fmu*)instance;
  size_t k;
  if (count < n) return complain(u, "too few values", "");
  for (k = 0; k < n; ++k) switch (refs[k]) {
      case VR_prepressure: u->wanted.prepressure = (trum_real)values[k]; break;
      case VR_frequency_difference: u->wanted.frequency_difference = (trum_real)values[k]; break;
      case VR_load_torque: u->wanted.load_torque = (trum_real)values[k]; break;
      case VR_periods: u->wanted.periods = (trum_real)values[k]; break;
      case VR_on_periods: u->wanted.on_periods = (trum_real)values[k]; break;
      case VR_start_speed: u->start_speed = values[k]; break;
      default: return complain(u, "no number that can be set has that value reference", "");
    }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3GetInt64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n, fmi3Int64 values[],
                                   size_t count) {
  trum_fmu* u = (trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] == VR_encoder_counts) values[k] = u->encoder_counts;
    else if (refs[k] == VR_encoder) {
      const double turns = u->known ? angle_now(u, 0) / 6.283185307179586 : 0;
      values[k] = (fmi3Int64)floor(turns * (double)u->encoder_counts);
    } else return complain(u, "no whole number has that value reference", "");
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3SetInt64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                   const fmi3Int64 values[], size_t count) {
  trum_fmu* u = (trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] != VR_encoder_counts || values[k] < 1) return complain(u, "encoder_counts has to be 1 at least", "");
    u->encoder_counts = values[k];
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3GetBoolean(fmi3Instance instance, const fmi3ValueReference refs[], size_t n, fmi3Boolean values[],
                                     size_t count) {
  trum_fmu* u = (trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] != VR_settled) return complain(u, "no truth value has that value reference", "");
    values[k] = u->settled;
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3SetBoolean(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                     const fmi3Boolean values[], size_t count) {
  trum_fmu* u = (trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] != VR_settled) return complain(u, "no truth value has that value reference", "");
    u->settled = values[k];
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 now, fmi3Float64 length, fmi3Boolean no_way_back,
                                 fmi3Boolean* events, fmi3Boolean* terminate, fmi3Boolean* early, fmi3Float64* reached) {
  trum_fmu* u = (trum_fmu*)instance;
  const double radius = (double)my_motor.contact_radius;
  const double end = now + length;
  (void)no_way_back;
  if (events) *events = false;
  if (terminate) *terminate = false;
  if (early) *early = false;
  if (!(length >= 0)) return complain(u, "a step cannot go back", "");
  while (end - u->begun >= (double)u->point.cycle_time * (1 - 1e-12)) {
    u->begun += (double)u->point.cycle_time;
    u->angle += (double)u->distance[u->count - 1] / radius;
    u->rim = (double)u->speed[u->count - 1];
    if (begin_cycle(u) != fmi3OK) return fmi3Error;
  }
  u->time = end;
  if (reached) *reached = end;
  return fmi3OK;
}

/* What the unit has nothing of: it answers with an error, whatever it is asked. */
#define NOTHING(name) \
  FMI_EXPORT fmi3Status name(fmi3Instance instance) { return complain((trum_fmu*)instance, #name, " is not there"); }
NOTHING(fmi3GetFloat32) NOTHING(fmi3SetFloat32)
NOTHING(fmi3GetInt8) NOTHING(fmi3SetInt8)
NOTHING(fmi3GetUInt8) NOTHING(fmi3SetUInt8)
NOTHING(fmi3GetInt16) NOTHING(fmi3SetInt16)
NOTHING(fmi3GetUInt16) NOTHING(fmi3SetUInt16)
NOTHING(fmi3GetInt32) NOTHING(fmi3SetInt32)
NOTHING(fmi3GetUInt32) NOTHING(fmi3SetUInt32)
NOTHING(fmi3GetUInt64) NOTHING(fmi3SetUInt64)
NOTHING(fmi3GetString) NOTHING(fmi3SetString)
NOTHING(fmi3GetBinary) NOTHING(fmi3SetBinary)
NOTHING(fmi3GetClock) NOTHING(fmi3SetClock)
NOTHING(fmi3GetNumberOfVariableDependencies)
NOTHING(fmi3GetVariableDependencies)
NOTHING(fmi3GetFMUState)
NOTHING(fmi3SetFMUState)
NOTHING(fmi3FreeFMUState)
NOTHING(fmi3SerializedFMUStateSize)
NOTHING(fmi3SerializeFMUState)
NOTHING(fmi3DeserializeFMUState)
NOTHING(fmi3GetDirectionalDerivative)
NOTHING(fmi3GetAdjointDerivative)
NOTHING(fmi3EnterConfigurationMode)
NOTHING(fmi3ExitConfigurationMode)
NOTHING(fmi3EnterEventMode)
NOTHING(fmi3EnterStepMode)
NOTHING(fmi3GetIntervalDecimal)
NOTHING(fmi3GetIntervalFraction)
NOTHING(fmi3GetShiftDecimal)
NOTHING(fmi3GetShiftFraction)
NOTHING(fmi3SetIntervalDecimal)
NOTHING(fmi3SetIntervalFraction)
NOTHING(fmi3SetShiftDecimal)
NOTHING(fmi3SetShiftFraction)
NOTHING(fmi3EvaluateDiscreteStates)
NOTHING(fmi3UpdateDiscreteStates)
NOTHING(fmi3GetOutputDerivatives)
NOTHING(fmi3EnterContinuousTimeMode)
NOTHING(fmi3CompletedIntegratorStep)
NOTHING(fmi3SetTime)
NOTHING(fmi3SetContinuousStates)
NOTHING(fmi3GetContinuousStateDerivatives)
NOTHING(fmi3GetEventIndicators)
NOTHING(fmi3GetContinuousStates)
NOTHING(fmi3GetNominalsOfContinuousStates)
NOTHING(fmi3GetNumberOfEventIndicators)
NOTHING(fmi3GetNumberOfContinuousStates)
NOTHING(fmi3ActivateModelPartition)
FMI_EXPORT fmi3Instance fmi3InstantiateModelExchange(void) { return 0; }
FMI_EXPORT fmi3Instance fmi3InstantiateScheduledExecution(void) { return 0; }
