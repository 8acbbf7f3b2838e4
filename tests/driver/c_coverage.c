/* Runs the C library for tests/driver/c_coverage.py and tests/driver/test_c_library.py.  Lines on standard input:
 *
 *     kernel NAME x_0 x_1 ...     prints the kernel's outputs in hexadecimal
 *     point NAME=VALUE ...        the example's main
 *     simulate COUNT NAME=VALUE ...
 *     edges                       what a well-behaved caller does not do
 */
#define TRUM_SLOPES 1
#define main example_main
#include "main.c"
#undef main

enum { MOST = 64 };
typedef int (*kernel_function)(const trum_real**, trum_real**, long long int*, trum_real*, int);
static void call(kernel_function kernel, int n_in, int n_out, char* numbers) {
  trum_real in[MOST], out[MOST];
  const trum_real* arg[MOST];
  trum_real* res[MOST];
  int i;
  for (i = 0; i < n_in; ++i) in[i] = (trum_real)strtod(numbers, &numbers), arg[i] = &in[i];
  for (i = 0; i < n_out; ++i) res[i] = &out[i];
  kernel(arg, res, 0, 0, 0);
  for (i = 0; i < n_out; ++i) printf("%a ", (double)out[i]);
  printf("\n");
}

static int wrong;

static void expect(int right, const char* what) {
  if (right) return;
  fprintf(stderr, "wrong: %s\n", what);
  ++wrong;
}

/* Null arguments stand for zeros, null results are not wanted. */
static void nothing(kernel_function kernel, int n_in, int n_out) {
  const trum_real* arg[MOST] = {0};
  trum_real *res[MOST] = {0}, zeros[MOST] = {0}, one[MOST], other[MOST];
  int i;
  expect(kernel(arg, res, 0, 0, 0) == 0, "kernel of nothing");
  for (i = 0; i < n_out; ++i) res[i] = &one[i];
  kernel(arg, res, 0, 0, 0);
  for (i = 0; i < n_in; ++i) arg[i] = &zeros[i];
  for (i = 0; i < n_out; ++i) res[i] = &other[i];
  kernel(arg, res, 0, 0, 0);
  for (i = 0; i < n_out; ++i) expect(one[i] == other[i] || (one[i] != one[i] && other[i] != other[i]), "null is zero");
}

/* Numbers that make no drive cycle: a search for its orbit ends at once. */
static void no_cycles(const trum_orbit_in* in) {
  int i;
  for (i = 0; i < 8; ++i) {
    trum_orbit_in none = *in;
    trum_orbit_out out;
    trum_slopes_in slopes_in;
    trum_slopes_out slopes_out;
    trum_real speed, distance;
    memset(&slopes_in, 0, sizeof slopes_in);
    if (i == 0) none.m = none.n = 0;
    if (i == 1) none.Delta_omega = -2 * in->omega_n;
    if (i == 2) none.omega_n = (trum_real)1e-300, none.Delta_omega = 0, none.m = (trum_real)1e8;
    if (i == 3) none.n = -1;
    if (i == 4) none.n = none.m + 1;
    if (i == 5) none.m = (trum_real)2e9;
    if (i == 6) none.omega_n = NAN;
    if (i == 7) none.a_A = NAN;
    trum_orbits(&none, &out, &slopes_in, &slopes_out, 1, 0);
    expect((int)out.flags & trum_failed_step && !((int)out.flags & trum_converged), "no drive cycle");
    trum_history(&none, &out, &speed, &distance, 1, 0);
    expect(speed != speed && distance != distance, "a history of no drive cycle");
  }
}

static void edges(void) {
  struct trum_motor motor = trum60;
  struct trum_drive drive = trum_table3;
  struct trum_point point;
  trum_orbit_in in;
  trum_orbit_out out[3];
  trum_slopes_in slopes_in;
  trum_slopes_out slopes_out;
  int i, field = 0, contact;
#define KERNEL(name, inputs, outputs, ins, outs) nothing(name, inputs, outputs);
  TRUM_KERNELS(KERNEL)
  /* every field refuses NaN, infinity and words that there are none of, and says which it was */
#define REFUSED(of, name, value)                                                                        \
  of.name = value;                                                                                      \
  expect(trum_evaluate(&motor, &drive, &point) == TRUM_BAD_INPUT && point.field == field, #name);       \
  expect(field < 0 || strcmp(trum_field_name(field), #name) == 0, #name);
#define REFUSES_MOTOR(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  REFUSED(motor, name, TRUM_NAN) REFUSED(motor, name, (trum_real)-HUGE_VAL)            \
  motor = trum60, ++field;
#define REFUSES_DRIVE(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  REFUSED(drive, name, TRUM_NAN) REFUSED(drive, name, (trum_real)HUGE_VAL)             \
  drive = trum_table3, ++field;
#define REFUSES_CHOICE(name, count, words) REFUSED(drive, name, -1) REFUSED(drive, name, count) drive = trum_table3, ++field;
  TRUM_MOTOR_FIELDS(REFUSES_MOTOR)
  TRUM_DRIVE_FIELDS(REFUSES_DRIVE)
  TRUM_CHOICES(REFUSES_CHOICE)
  REFUSED(drive, tolerance, TRUM_NAN)
  drive = trum_table3;
  ++field;
  REFUSED(drive, max_steps, -1)
  drive = trum_table3;
  expect(trum_field_name(-1) == 0 && trum_field_name(field) != 0 && trum_field_name(field + 1) == 0, "field names");
  for (i = -1; i <= TRUM_STATUSES; ++i)
    expect((trum_status_text(i) != 0) == (i >= 0 && i < TRUM_STATUSES), "status texts");

  expect(!(trum_brush_friction(NAN, 1, 0) <= 1) && !(trum_brush_friction(0, 1, 0) <= 1), "brush without a contact");
  expect(!(trum_brush_friction(4, 1, 0) <= 1) && !(trum_brush_friction(1, 0, 0) <= 1), "brush all round, of no grip");
  expect(!(trum_brush_friction(1, 1, TRUM_NAN) <= 1) && !(trum_brush_speed(4, 1, 0) <= 2), "brush at no speed");
  expect(trum_brush_friction(1, 1, 2) == -1 && trum_brush_friction(1, 1, -2) == 1, "brush that slides all the way");
  expect(trum_brush_friction(3, (trum_real)0.1, (trum_real)-9.9) <= 1, "brush that slides at once");
  expect(trum_brush_speed_error(1, 1, (trum_real)(1e-16 - 1), -1) > 0, "brush at its most friction");
  expect(trum_half_angle(NAN, 1, 1, 1, 1) != trum_half_angle(NAN, 1, 1, 1, 1), "half-angle at no force");
  expect(trum_half_angle(1, 1, NAN, 1, 1) != trum_half_angle(1, 1, NAN, 1, 1), "half-angle at no amplitude");
  for (contact = 0; contact < 2; ++contact) { /* orbits of several points, of none, and with slopes */
    drive = trum_table3, drive.start = TRUM_START_STEADY, drive.contact = contact, drive.load_torque = (trum_real)0.05;
    expect(trum_solve_point(&motor, &drive, &point, &in, out, 0) == TRUM_OK, "a point that converges");
    memset(&slopes_in, 0, sizeof slopes_in), memset(&slopes_out, 0, sizeof slopes_out);
    trum_orbits(&in, out + 1, &slopes_in, &slopes_out, 1, 0);
    expect(out[1].mean == out[0].mean, "slopes change no figure");
    expect(slopes_out.of[TRUM_OF_MEAN][TRUM_BY_DRAG] < 0, "a load slows the rotor down");
  }
  {
    trum_orbit_in several[3];
    several[0] = several[1] = several[2] = in;
    several[1].drag = 2 * in.push; /* no speed balances that */
    trum_orbits(several, out, 0, 0, 3, 0);
    expect(out[2].mean == out[0].mean && ((int)out[1].flags & trum_runaway), "several points");
    several[2].held = 0.0;
    trum_orbits(several, out, 0, 0, 3, 0);
    expect(out[2].mean == out[0].mean && (int)out[2].flags & trum_converged, "an orbit does not need a held rotor");
    expect(out[2].held != out[2].held && out[0].held == out[0].held, "a held rotor is not computed unasked");
    several[2].held = 1.0;
    trum_orbits(several, out, 0, 0, 0, 0);
    {
      trum_slopes_in with[3];
      trum_slopes_out of[3];
      memset(with, 0, sizeof with);
      trum_orbits(several, out, with, of, 3, 0);
      expect(of[2].of[TRUM_OF_MEAN][TRUM_BY_DRAG] == slopes_out.of[TRUM_OF_MEAN][TRUM_BY_DRAG], "slopes of several points");
    }
    several[1].a_A = NAN;
    trum_orbits(several + 1, out, 0, 0, 1, 0);
    expect(!((int)out[0].flags & trum_converged), "an orbit of no number");
    several[0].m = 2, several[0].n = 1, several[0].D = NAN; /* the load can be balanced, the motion not be followed */
    trum_orbits(several, out, &slopes_in, &slopes_out, 1, 0);
    expect((int)out[0].flags & trum_failed_step && !((int)out[0].flags & trum_converged), "an orbit that cannot be followed");
    no_cycles(&in);
    {
      trum_real speed[2], distance[2];
      trum_history(several, out, speed, distance, 2, 0);
      expect(speed[1] != speed[1] && distance[0] != distance[0], "a history of no number");
    }
  }
  for (contact = 0; contact < 2; ++contact) { /* most of whose periods are counted: of pulses, and of a plain wave */
    trum_real speed, distance;
    motor.damping_ratio = (trum_real)0.3;
    drive = trum_table3, drive.periods = 20000, drive.on_periods = contact ? 20000 : 14000, drive.tolerance = (trum_real)1e-2;
    drive.start = contact ? TRUM_START_REST : TRUM_START_STEADY;
    expect(trum_solve_point(&motor, &drive, &point, &in, out, 0) == TRUM_OK, "a long schedule");
    expect(!point.undamped, "a motor's damping is none that lacks");
    trum_orbits(&in, out + 1, &slopes_in, &slopes_out, 1, 0);
    expect(out[1].mean == out[0].mean && slopes_out.of[TRUM_OF_MEAN][TRUM_BY_DRAG] < 0, "slopes of a long schedule");
    trum_history(&in, out, &speed, &distance, 1, 0);
    expect(trum_fabs(distance / point.cycle_time - out[0].mean) <= 2 * out[0].mean_error, "the end of a long schedule");
  }
  motor = trum60, drive = trum_table3, drive.start = TRUM_START_STEADY;
  motor.damping_ratio = 0, drive.frequency_difference = (trum_real)1e-2;
  (void)trum_evaluate_determinants(&motor, &drive, &point);
  expect(point.undamped, "an undamped resonance");
  motor = trum60, drive.prepressure = (trum_real)1e-10;
  expect(trum_evaluate(&motor, &drive, &point) == TRUM_BAD_INPUT && point.field == trum_drive_prepressure, "no wave");
}

int main(void) {
  static char line[4096];
  while (fgets(line, sizeof line, stdin)) {
    char *words[MOST], *word, *rest = line;
    int count = 0;
    line[strcspn(line, "\n")] = 0;
    if (strncmp(line, "kernel ", 7) == 0) {
      char* numbers = line + 7 + strcspn(line + 7, " ");
      const size_t length = (size_t)(numbers - line) - 7;
#define CALL(name, n_in, n_out, ins, outs) \
  if (strlen(#name) == length && strncmp(line + 7, #name, length) == 0) call(name, n_in, n_out, numbers);
      TRUM_KERNELS(CALL)
      continue;
    }
    while (count < MOST && (word = strtok(rest, " ")) != 0) words[count++] = word, rest = 0;
    if (count == 0) continue;
    if (strcmp(words[0], "edges") == 0) edges();
    if (strcmp(words[0], "point") == 0) printf("status %d\n", example_main(count, words));
    if (strcmp(words[0], "simulate") == 0) {
      struct trum_motor motor = trum60;
      struct trum_drive drive = trum_table3;
      struct trum_point point;
      static trum_real speed[4096], angle[4096];
      const long times = strtol(words[1], 0, 10);
      long k;
      int i;
      for (i = 2; i < count; ++i) expect(set(&motor, &drive, words[i]), words[i]);
      i = (int)trum_simulate(&motor, &drive, &point, speed, angle, times);
      printf("%d", i);
      for (k = 0; k < times; ++k) printf(" %.17g %.17g", (double)speed[k], (double)angle[k]);
      printf("\n");
    }
    fflush(stdout);
  }
  return wrong != 0;
}
