/* An operating point in MATLAB and Octave: every figure by its name, as the C library gives it.
 *
 *     mex trum_point.c trum.c                                   in a folder that `trum-sym c-library DIR --amalgamated` wrote
 *     point = trum_point(struct("prepressure", 177, "start", "rest"), struct("damping_ratio", 0.008));
 *
 * Both arguments may be left out: drive and motor are then those of motor.h.  Numbers in SI units. */
#include "mex.h"

#include "trum.h"
#include "motor.h"

/* The number of a word in a list of words between blanks, -1 if it is not in it. */
static int place_of(const char* word, const char* words) {
  const size_t length = strlen(word);
  int place = 0;
  for (; *words; ++place) {
    const size_t own = strcspn(words, " ");
    if (own == length && strncmp(word, words, own) == 0) return place;
    words += own + (words[own] == ' ');
  }
  return -1;
}

static trum_real number_of(const mxArray* value, const char* name) {
  if (!value || !mxIsDouble(value) || mxIsComplex(value) || mxGetNumberOfElements(value) != 1)
    mexErrMsgIdAndTxt("trum:number", "%s has to be one real number", name);
  return (trum_real)mxGetScalar(value);
}

/* Changes a number or, of the drive, a choice. */
static void change(struct trum_motor* motor, struct trum_drive* drive, const char* field, const mxArray* value) {
#define NAMED(name) (strcmp(field, #name) == 0)
#define MOTOR_NUMBER(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  if (motor && NAMED(name)) { motor->name = number_of(value, field); return; }
#define DRIVE_NUMBER(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  if (drive && NAMED(name)) { drive->name = number_of(value, field); return; }
#define CHOICE(name, count, words) \
  if (drive && NAMED(name)) { \
    char* const word = mxIsChar(value) ? mxArrayToString(value) : 0; \
    drive->name = word ? place_of(word, words) : -1; \
    mxFree(word); \
    if (drive->name < 0) mexErrMsgIdAndTxt("trum:word", "%s is one of: %s", field, words); \
    return; \
  }
  TRUM_MOTOR_FIELDS(MOTOR_NUMBER)
  TRUM_DRIVE_FIELDS(DRIVE_NUMBER)
  TRUM_CHOICES(CHOICE)
  if (drive && NAMED(tolerance)) { drive->tolerance = number_of(value, field); return; }
  mexErrMsgIdAndTxt("trum:name", "%s is no number of the %s", field, drive ? "drive" : "motor");
}

static void change_all(struct trum_motor* motor, struct trum_drive* drive, const mxArray* given) {
  int k;
  if (!mxIsStruct(given) || mxGetNumberOfElements(given) != 1)
    mexErrMsgIdAndTxt("trum:struct", "the %s has to be one struct of numbers by name", drive ? "drive" : "motor");
  for (k = 0; k < mxGetNumberOfFields(given); ++k)
    change(motor, drive, mxGetFieldNameByNumber(given, k), mxGetFieldByNumber(given, 0, k));
}

static void put(mxArray* point, const char* name, mxArray* value) { mxSetFieldByNumber(point, 0, mxAddField(point, name), value); }

void mexFunction(int out_count, mxArray* out[], int in_count, const mxArray* in[]) {
  struct trum_motor motor = my_motor;
  struct trum_drive drive = my_drive;
  struct trum_point point;
  enum trum_status status;
  (void)out_count;
  if (in_count > 2) mexErrMsgIdAndTxt("trum:count", "trum_point takes a drive and a motor");
  if (in_count > 0) change_all(0, &drive, in[0]);
  if (in_count > 1) change_all(&motor, 0, in[1]);
  status = trum_evaluate(&motor, &drive, &point);
  if (status == TRUM_BAD_INPUT && point.field >= 0)
    mexErrMsgIdAndTxt("trum:domain", "%s is outside its domain", trum_field_name(point.field));
  if (status == TRUM_NO_SIZE || status == TRUM_UNDAMPED || status == TRUM_NOT_SETTLED)
    mexErrMsgIdAndTxt("trum:point", "%s", trum_status_text((int)status));
  out[0] = mxCreateStructMatrix(1, 1, 0, 0);
#define PUT(name, unit) put(out[0], #name, mxCreateDoubleScalar((double)point.name));
  TRUM_FIGURES(PUT)
  put(out[0], "converged", mxCreateLogicalScalar(point.converged != 0));
  put(out[0], "reason", mxCreateString(point.converged ? "" : trum_status_text((int)status)));
}
