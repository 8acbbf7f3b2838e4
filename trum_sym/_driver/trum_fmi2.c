/* The unit of trum_unit.h under FMI 2.0, whose whole numbers have 32 bits: encoder counts are a real number here. */
#include "trum_unit.h"

/* As the standard declares them */
typedef void* fmi2Component;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef const char* fmi2String;
typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef void (*fmi2CallbackLogger)(void*, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
typedef struct {
  fmi2CallbackLogger logger;
  void* (*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void*);
  void (*stepFinished)(void*, fmi2Status);
  void* componentEnvironment;
} fmi2CallbackFunctions;

static bool complain(const trum_fmu* u, const char* what, const char* more) {
  if (u->log)
    ((fmi2CallbackLogger)u->log)(u->environment, (const char*)u->name, fmi2Error, "logStatusError", "%s%s", what, more);
  return false;
}

static fmi2Status status(bool well) { return well ? fmi2OK : fmi2Error; }

FMI_EXPORT const char* fmi2GetVersion(void) { return "2.0"; }
FMI_EXPORT const char* fmi2GetTypesPlatform(void) { return "default"; }

FMI_EXPORT fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String* categories) {
  return (void)c, (void)on, (void)n, (void)categories, fmi2OK;
}

FMI_EXPORT fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                         const fmi2CallbackFunctions* functions, fmi2Boolean visible, fmi2Boolean logging) {
  trum_fmu* const u = type == fmi2CoSimulation ? new_unit(guid) : 0;
  (void)resources, (void)visible, (void)logging;
  if (!u) {
    if (functions && functions->logger)
      functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError",
                        "the identifier is of another unit, or there is no memory");
    return 0;
  }
  if (functions) u->log = (void (*)(void))functions->logger, u->environment = functions->componentEnvironment;
  u->name = malloc(strlen(name) + 1); /* messages carry it */
  if (u->name) memcpy(u->name, name, strlen(name) + 1);
  return u;
}

FMI_EXPORT void fmi2FreeInstance(fmi2Component c) { free_unit((trum_fmu*)c); }

FMI_EXPORT fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                                          fmi2Boolean has_stop, fmi2Real stop) {
  trum_fmu* const u = (trum_fmu*)c;
  (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
  u->time = u->begun = start;
  return fmi2OK;
}
FMI_EXPORT fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return (void)c, fmi2OK; }
FMI_EXPORT fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return status(begin_cycle((trum_fmu*)c)); }
FMI_EXPORT fmi2Status fmi2Terminate(fmi2Component c) { return (void)c, fmi2OK; }
FMI_EXPORT fmi2Status fmi2Reset(fmi2Component c) { return reset((trum_fmu*)c), fmi2OK; }

FMI_EXPORT fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference refs[], size_t n, fmi2Real values[]) {
  trum_fmu* const u = (trum_fmu*)c;
  const trum_outputs now = outputs(u);
  size_t k;
  bool well = true;
  for (k = 0; well && k < n; ++k) {
    if (refs[k] == VR_encoder) values[k] = encoder(u);
    else well = get_number(u, &now, refs[k], &values[k]);
  }
  return status(well);
}

FMI_EXPORT fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference refs[], size_t n, const fmi2Real values[]) {
  size_t k;
  bool well = true;
  for (k = 0; well && k < n; ++k) well = set_number((trum_fmu*)c, refs[k], values[k]);
  return status(well);
}

FMI_EXPORT fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference refs[], size_t n, fmi2Integer values[]) {
  const trum_fmu* const u = (const trum_fmu*)c;
  size_t k;
  for (k = 0; k < n; ++k) {
    if (refs[k] != VR_encoder_counts) return status(complain(u, "no whole number has that value reference", ""));
    values[k] = (fmi2Integer)u->encoder_counts;
  }
  return fmi2OK;
}

FMI_EXPORT fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference refs[], size_t n, const fmi2Integer values[]) {
  size_t k;
  bool well = true;
  for (k = 0; well && k < n; ++k) well = set_encoder_counts((trum_fmu*)c, refs[k], values[k]);
  return status(well);
}

FMI_EXPORT fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference refs[], size_t n, fmi2Boolean values[]) {
  const trum_fmu* const u = (const trum_fmu*)c;
  size_t k;
  for (k = 0; k < n; ++k) {
    if (refs[k] != VR_settled) return status(complain(u, "no truth value has that value reference", ""));
    values[k] = u->settled;
  }
  return fmi2OK;
}

FMI_EXPORT fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference refs[], size_t n, const fmi2Boolean values[]) {
  trum_fmu* const u = (trum_fmu*)c;
  size_t k;
  for (k = 0; k < n; ++k) {
    if (refs[k] != VR_settled) return status(complain(u, "no truth value has that value reference", ""));
    u->settled = values[k] != 0;
  }
  return fmi2OK;
}

FMI_EXPORT fmi2Status fmi2DoStep(fmi2Component c, fmi2Real now, fmi2Real length, fmi2Boolean no_way_back) {
  return (void)no_way_back, status(advance((trum_fmu*)c, now, length));
}

/* What the unit has nothing of: it answers with an error, whatever it is asked. */
#define NOTHING(name) \
  FMI_EXPORT fmi2Status name(fmi2Component c) { return status(complain((const trum_fmu*)c, #name, " is not there")); }
NOTHING(fmi2GetString) NOTHING(fmi2SetString)
NOTHING(fmi2GetFMUstate)
NOTHING(fmi2SetFMUstate)
NOTHING(fmi2FreeFMUstate)
NOTHING(fmi2SerializedFMUstateSize)
NOTHING(fmi2SerializeFMUstate)
NOTHING(fmi2DeSerializeFMUstate)
NOTHING(fmi2GetDirectionalDerivative)
NOTHING(fmi2SetRealInputDerivatives)
NOTHING(fmi2GetRealOutputDerivatives)
NOTHING(fmi2CancelStep)
NOTHING(fmi2GetStatus)
NOTHING(fmi2GetRealStatus)
NOTHING(fmi2GetIntegerStatus)
NOTHING(fmi2GetBooleanStatus)
NOTHING(fmi2GetStringStatus)
