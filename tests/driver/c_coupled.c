/* Coupled laps of the C library for tests/driver/test_c_coupled.py.  Each line of standard input is a rotor's mass, a
 * coverage, and NAME=VALUE of motor and drive or lap.NAME=VALUE of the lap's own numbers; what the lap depends on is
 * printed, then what it comes to, then its slopes, in hexadecimal. */
#define TRUM_COUPLED
#define main example_main
#include "main.c"
#undef main

/* Changes a number of the lap's; 0 if there is no such name. */
static int put(trum_coupled_lap_in* in, const char* text) {
#define PUT(name, unit) \
  if (strncmp(text, "lap." #name "=", sizeof "lap." #name) == 0) \
    return in->name = (trum_real)strtod(text + sizeof "lap." #name, 0), 1;
  TRUM_COUPLED_LAP_IN(PUT)
  return 0;
}

int main(void) {
  static char line[4096];
  while (fgets(line, sizeof line, stdin)) {
    struct trum_motor motor = trum60;
    struct trum_drive drive = trum_table3;
    struct trum_point point;
    trum_coupled_lap_in in;
    trum_coupled_lap_out out;
    trum_real slopes[56], mass, coverage;
    char *words[64], *rest = line;
    const char* named;
    int count = 0, status, k;
    mass = (trum_real)strtod(rest, &rest), coverage = (trum_real)strtod(rest, &rest);
    for (rest = strtok(rest, " \n"); rest && count < 64; rest = strtok(0, " \n")) words[count++] = rest;
    for (k = 0; k < count; ++k) (void)set(&motor, &drive, words[k]);
    status = (int)trum_coupled_values(&motor, &drive, mass, coverage, &point, &in);
    named = status == TRUM_BAD_INPUT ? trum_field_name(point.field) : 0;
    printf("{\"status\": %d, \"field\": \"%s\"", status, named ? named : "");
    if (status == TRUM_OK) {
      for (k = 0; k < count; ++k) (void)put(&in, words[k]);
#define SHOW(name, unit) printf(", \"" #name "\": \"%a\"", (double)OF.name);
#define OF in
      printf(", \"in\": {\"of\": \"lap\"");
      TRUM_COUPLED_LAP_IN(SHOW)
#undef OF
#define OF out
      printf("}, \"done\": %d, \"out\": {\"of\": \"lap\"", trum_coupled_lap(&in, &out, slopes));
      TRUM_COUPLED_LAP_OUT(SHOW)
      printf("}, \"slopes\": [");
      for (k = 0; k < 56; ++k) printf("%s\"%a\"", k ? ", " : "", (double)slopes[k]);
      printf("], \"alone\": %d", trum_coupled_lap(&in, &out, 0));
    }
    printf("}\n");
  }
  return 0;
}
