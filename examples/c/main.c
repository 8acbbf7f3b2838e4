/* Prints an operating point as `trum-sym evaluate --json` does: the paper's Table 3, or what NAME=VALUE changes of it.
 *
 *     ./trum prepressure=170 start=rest damping_ratio=0.008
 */
#include <stdio.h>
#include <stdlib.h>

#define TRUM_IMPLEMENTATION
#include "trum.h"
#include "trum60.h"

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

/* Changes what NAME=VALUE says; 0 if there is no such name or value.  Words go to choices, numbers to numbers. */
static int set(struct trum_motor* motor, struct trum_drive* drive, const char* text) {
  const char* value = strchr(text, '=');
  const size_t length = value ? (size_t)(value - text) : 0;
  char* end;
  double number;
  if (!value || !value[1]) return 0;
  number = strtod(++value, &end);
#define NAMED(name) (strlen(#name) == length && strncmp(text, #name, length) == 0)
#define NUMBER(of, name) if (!*end && NAMED(name)) return of->name = (trum_real)number, 1;
#define MOTOR_NUMBER(name, symbol, unit, low, high, low_open, high_open, integer, required) NUMBER(motor, name)
#define DRIVE_NUMBER(name, symbol, unit, low, high, low_open, high_open, integer, required) NUMBER(drive, name)
#define CHOICE(name, count, words) \
  if (*end && NAMED(name)) return drive->name = place_of(value, words), drive->name >= 0;
  TRUM_MOTOR_FIELDS(MOTOR_NUMBER)
  TRUM_DRIVE_FIELDS(DRIVE_NUMBER)
  TRUM_CHOICES(CHOICE)
  NUMBER(drive, tolerance)
  if (!*end && NAMED(max_steps) && number >= -1 && number < 2147483647.0) return drive->max_steps = (int_least32_t)number, 1;
  return 0;
}

static void print_word(const char* name, const char* words, int place) {
  while (place-- > 0) words += strcspn(words, " ") + 1;
  printf("  \"%s\": \"%.*s\",\n", name, (int)strcspn(words, " "), words);
}

static void print_number(const char* name, trum_real value) {
  if (value - value == 0) printf("  \"%s\": %.*g,\n", name, sizeof value < sizeof(double) ? 9 : 17, (double)value);
  else printf("  \"%s\": null,\n", name);
}

int main(int count, char** arguments) {
  struct trum_motor motor = trum60;
  struct trum_drive drive = trum_table3;
  struct trum_point point;
  enum trum_status status;
  int i;
  for (i = 1; i < count; ++i) {
    if (set(&motor, &drive, arguments[i])) continue;
    fprintf(stderr, "trum: %s is no NAME=VALUE of motor or drive\n", arguments[i]);
    return 2;
  }
  status = trum_evaluate(&motor, &drive, &point);
  if (point.field >= 0 && strcmp(trum_field_name(point.field), "tolerance") == 0)
    fprintf(stderr, "trum: tolerance is outside its domain: this build keeps %g to %g\n", (double)TRUM_FINEST_TOLERANCE,
            (double)TRUM_COARSEST_TOLERANCE);
  else if (point.field >= 0) fprintf(stderr, "trum: %s is outside its domain\n", trum_field_name(point.field));
  else if (status != TRUM_OK) fprintf(stderr, "trum: %s\n", trum_status_text((int)status));
  if (status != TRUM_OK && status != TRUM_RUNAWAY && status != TRUM_NOT_CONVERGED && status != TRUM_OUT_OF_STEPS && status != TRUM_NO_BRUSH) return 2;

  printf("{\n  \"motor\": \"%s\",\n", TRUM60_NAME);
#define PRINT_WORD(name, count, words) if (strcmp(#name, "start") == 0 || strcmp(#name, "contact") == 0) \
    print_word(#name, words, drive.name);
  TRUM_CHOICES(PRINT_WORD)
  print_number("prepressure", drive.prepressure);
  print_number("frequency_difference", drive.frequency_difference);
#define PRINT(name, unit) print_number(#name, point.name);
  TRUM_FIGURES(PRINT)
  printf("  \"converged\": %s,\n", point.converged ? "true" : "false");
  printf("  \"reason\": \"%s\"\n}\n", !point.converged ? trum_status_text((int)status)
                                        : point.taut ? "" : "friction could make the string go slack");
  return 0;
}
