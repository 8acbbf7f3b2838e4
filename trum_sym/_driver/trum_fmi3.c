/* The unit of trum_unit.h under FMI 3.0. */
#include "trum_unit.h"

/* As the standard declares them */
typedef void* fmi3Instance;
typedef void* fmi3InstanceEnvironment;
typedef uint32_t fmi3ValueReference;
typedef double fmi3Float64;
typedef int64_t fmi3Int64;
typedef bool fmi3Boolean;
typedef const char* fmi3String;
typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String, fmi3String);

static bool complain(const trum_fmu* u, const char* what, const char* more) {
  char text[256];
  (void)snprintf(text, sizeof text, "%s%s", what, more);
  if (u->log) ((fmi3LogMessageCallback)u->log)(u->environment, fmi3Error, "logStatusError", text);
  return false;
}

static fmi3Status status(bool well) { return well ? fmi3OK : fmi3Error; }

FMI_EXPORT const char* fmi3GetVersion(void) { return "3.0"; }

FMI_EXPORT fmi3Status fmi3SetDebugLogging(fmi3Instance i, fmi3Boolean on, size_t n, const fmi3String* categories) {
  return (void)i, (void)on, (void)n, (void)categories, fmi3OK;
}

FMI_EXPORT fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible, fmi3Boolean logging, fmi3Boolean events,
    fmi3Boolean early, const fmi3ValueReference* intermediate, size_t n, fmi3InstanceEnvironment environment,
    fmi3LogMessageCallback log, void (*update)(void)) {
  trum_fmu* const u = new_unit(token);
  (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)intermediate, (void)n;
  (void)update;
  if (u) u->log = (void (*)(void))log, u->environment = environment;
  else if (log) log(environment, fmi3Error, "logStatusError", "the token is of another unit, or there is no memory");
  return u;
}

FMI_EXPORT void fmi3FreeInstance(fmi3Instance instance) { free_unit((trum_fmu*)instance); }

FMI_EXPORT fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean has_tolerance, fmi3Float64 tolerance,
                                                  fmi3Float64 start, fmi3Boolean has_stop, fmi3Float64 stop) {
  trum_fmu* const u = (trum_fmu*)instance;
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  u->time = u->begun = start;
  return fmi3OK;
}
FMI_EXPORT fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) { return status(begin_cycle((trum_fmu*)instance)); }
FMI_EXPORT fmi3Status fmi3Terminate(fmi3Instance instance) { return (void)instance, fmi3OK; }
FMI_EXPORT fmi3Status fmi3Reset(fmi3Instance instance) { return reset((trum_fmu*)instance), fmi3OK; }

FMI_EXPORT fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n, fmi3Float64 values[],
                                     size_t count) {
  trum_fmu* const u = (trum_fmu*)instance;
  const trum_outputs now = outputs(u);
  size_t k;
  bool well = count >= n || complain(u, "too few places for the values", "");
  for (k = 0; well && k < n; ++k) well = get_number(u, &now, refs[k], &values[k]);
  return status(well);
}

FMI_EXPORT fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                     const fmi3Float64 values[], size_t count) {
  trum_fmu* const u = (trum_fmu*)instance;
  size_t k;
  bool well = count >= n || complain(u, "too few values", "");
  for (k = 0; well && k < n; ++k) well = set_number(u, refs[k], values[k]);
  return status(well);
}

FMI_EXPORT fmi3Status fmi3GetInt64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n, fmi3Int64 values[],
                                   size_t count) {
  const trum_fmu* const u = (const trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] == VR_encoder_counts) values[k] = u->encoder_counts;
    else if (refs[k] == VR_encoder) values[k] = (fmi3Int64)encoder(u);
    else return status(complain(u, "no whole number has that value reference", ""));
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3SetInt64(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                   const fmi3Int64 values[], size_t count) {
  size_t k;
  bool well = true;
  for (k = 0; well && k < n && k < count; ++k) well = set_encoder_counts((trum_fmu*)instance, refs[k], values[k]);
  return status(well);
}

FMI_EXPORT fmi3Status fmi3GetBoolean(fmi3Instance instance, const fmi3ValueReference refs[], size_t n, fmi3Boolean values[],
                                     size_t count) {
  const trum_fmu* const u = (const trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] != VR_settled) return status(complain(u, "no truth value has that value reference", ""));
    values[k] = u->settled;
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3SetBoolean(fmi3Instance instance, const fmi3ValueReference refs[], size_t n,
                                     const fmi3Boolean values[], size_t count) {
  trum_fmu* const u = (trum_fmu*)instance;
  size_t k;
  for (k = 0; k < n && k < count; ++k) {
    if (refs[k] != VR_settled) return status(complain(u, "no truth value has that value reference", ""));
    u->settled = values[k];
  }
  return fmi3OK;
}

FMI_EXPORT fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 now, fmi3Float64 length, fmi3Boolean no_way_back,
                                 fmi3Boolean* events, fmi3Boolean* terminate, fmi3Boolean* early, fmi3Float64* reached) {
  (void)no_way_back;
  if (events) *events = false;
  if (terminate) *terminate = false;
  if (early) *early = false;
  if (!advance((trum_fmu*)instance, now, length)) return fmi3Error;
  if (reached) *reached = now + length;
  return fmi3OK;
}

/* What the unit has nothing of: it answers with an error, whatever it is asked. */
#define NOTHING(name) \
  FMI_EXPORT fmi3Status name(fmi3Instance instance) { return status(complain((const trum_fmu*)instance, #name, " is not there")); }
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
