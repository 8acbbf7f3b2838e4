/* What the report's interactive part calls, compiled to WebAssembly by `python -m derivations wasm`: settings in, the
 * figures of an operating point and one cycle's histories out, through arrays that the page reads. */
#include "trum_kernels.h"

#define TRUM_IMPLEMENTATION
#include "trum.h"
#include "trum60.h"

#define BROWSER_MOST_SAMPLES 8192
#define BROWSER_EXPORT(name) __attribute__((export_name(#name)))

/* name, unit */
#define BROWSER_HISTORIES(X) \
  X(w_A, "m") X(w_B, "m") X(zeta_x, "m") X(Q, "m^2/s") X(W_c, "m") X(theta, "rad") X(rotor_speed, "rad/s")
/* What is no number of the operating point itself; times are those of the first two regions' ends. */
#define BROWSER_NOTES(X) X(status, "1") X(converged, "1") X(full_contact, "1") X(outside_fit, "1") X(field, "1") \
  X(region_1, "s") X(region_2, "s")

#define TRUM_PLACE(name, unit) browser_figure_##name,
enum { TRUM_FIGURES(TRUM_PLACE) BROWSER_NOTES(TRUM_PLACE) BROWSER_FIGURE_COUNT };
#undef TRUM_PLACE
#define TRUM_PLACE(name, unit) browser_history_##name,
enum { BROWSER_HISTORIES(TRUM_PLACE) BROWSER_HISTORY_COUNT };
#undef TRUM_PLACE

static double settings[TRUM_FIELD_COUNT];
static double figures[BROWSER_FIGURE_COUNT];
static double histories[BROWSER_HISTORY_COUNT][BROWSER_MOST_SAMPLES + 1];
static double distance[BROWSER_MOST_SAMPLES];

/* One line for each place of the three arrays: which array, name, unit or words. */
BROWSER_EXPORT(places) const char* browser_places(void) {
#define TRUM_LINE(name, symbol, unit, low, high, low_open, high_open, integer, required) "number " #name " " unit "\n"
#define TRUM_CHOICE(name, count, words) "choice " #name " " words "\n"
#define TRUM_FIGURE(name, unit) "figure " #name " " unit "\n"
#define TRUM_HISTORY(name, unit) "history " #name " " unit "\n"
  return TRUM_MOTOR_FIELDS(TRUM_LINE) TRUM_DRIVE_FIELDS(TRUM_LINE) TRUM_CHOICES(TRUM_CHOICE) "number tolerance 1\n"
      TRUM_FIGURES(TRUM_FIGURE) BROWSER_NOTES(TRUM_FIGURE) BROWSER_HISTORIES(TRUM_HISTORY);
#undef TRUM_LINE
#undef TRUM_CHOICE
#undef TRUM_FIGURE
#undef TRUM_HISTORY
}

BROWSER_EXPORT(settings) double* browser_settings(void) { return settings; }
BROWSER_EXPORT(figures) double* browser_figures(void) { return figures; }
BROWSER_EXPORT(histories) double* browser_histories(void) { return histories[0]; }
BROWSER_EXPORT(most_samples) int browser_most_samples(void) { return BROWSER_MOST_SAMPLES; }
BROWSER_EXPORT(status_text) const char* browser_status_text(int status) { return trum_status_text(status); }

/* TRUM-60 at the paper's Table 3. */
BROWSER_EXPORT(reset) void browser_reset(void) {
#define TRUM_STORE_MOTOR(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  settings[trum_motor_##name] = (double)trum60.name;
#define TRUM_STORE_DRIVE(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  settings[trum_drive_##name] = (double)trum_table3.name;
#define TRUM_STORE_CHOICE(name, count, words) settings[trum_drive_##name] = trum_table3.name;
  TRUM_MOTOR_FIELDS(TRUM_STORE_MOTOR)
  TRUM_DRIVE_FIELDS(TRUM_STORE_DRIVE)
  TRUM_CHOICES(TRUM_STORE_CHOICE)
#undef TRUM_STORE_MOTOR
#undef TRUM_STORE_DRIVE
#undef TRUM_STORE_CHOICE
  settings[trum_drive_tolerance] = (double)trum_table3.tolerance;
}

static void browser_take(struct trum_motor* motor, struct trum_drive* drive) {
#define TRUM_TAKE_MOTOR(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  motor->name = (trum_real)settings[trum_motor_##name];
#define TRUM_TAKE_DRIVE(name, symbol, unit, low, high, low_open, high_open, integer, required) \
  drive->name = (trum_real)settings[trum_drive_##name];
#define TRUM_TAKE_CHOICE(name, count, words) drive->name = (int)settings[trum_drive_##name];
  TRUM_MOTOR_FIELDS(TRUM_TAKE_MOTOR)
  TRUM_DRIVE_FIELDS(TRUM_TAKE_DRIVE)
  TRUM_CHOICES(TRUM_TAKE_CHOICE)
#undef TRUM_TAKE_MOTOR
#undef TRUM_TAKE_DRIVE
#undef TRUM_TAKE_CHOICE
  drive->tolerance = (trum_real)settings[trum_drive_tolerance];
  drive->max_steps = 0;
}

/* Wave height and contact half-angle where the phases are in c: the wave's kernel takes them as free motions, which
 * turn here by nothing. */
static void browser_touch(const trum_orbit_in* in, const trum_cycle* c, trum_real* v) {
  v[trum_at_omega_n] = in->omega_n, v[trum_at_Delta_omega] = in->Delta_omega, v[trum_at_xi] = in->xi;
  v[trum_at_s] = in->s, v[trum_at_W] = in->W, v[trum_at_D] = in->D, v[trum_at_k_c] = in->k_c;
  v[trum_at_engagement_per_height] = in->engagement_per_height;
  v[trum_at_a] = c->at.w_A, v[trum_at_b] = c->at.v_A;
  trum_call_phasor(v);
  v[trum_at_f_A_re] = v[trum_at_re], v[trum_at_f_A_im] = v[trum_at_im];
  v[trum_at_a] = c->at.w_B, v[trum_at_b] = c->at.v_B;
  trum_call_phasor(v);
  v[trum_at_f_B_re] = v[trum_at_re], v[trum_at_f_B_im] = v[trum_at_im];
  v[trum_at_e_re] = v[trum_at_d_re] = v[trum_at_p_re] = 1;
  v[trum_at_e_im] = v[trum_at_d_im] = v[trum_at_p_im] = v[trum_at_g_A] = v[trum_at_g_B] = 0;
  trum_call_wave(v);
  if (in->hertz > 0.5) {
    v[trum_at_W_full] = in->W_full;
    trum_call_contact_hertz(v);
  } else {
    trum_call_filling(v);
    v[trum_at_fullness_root] = trum_cbrt(v[trum_at_fullness]);
    trum_call_contact_winkler(v);
  }
}

/* Phases and contact at count + 1 equal times from t1 to the cycle's end. */
static void browser_vibrate(const trum_orbit_in* in, int count) {
  trum_cycle c;
  trum_real v[TRUM_VALUES];
  double since = 0;
  int i, region = 0;
  memset(v, 0, sizeof v);
  memset(&c, 0, sizeof c);
  trum_load_cycle(in, &c.constants, &c.before);
  trum_cycle_regions(&c);
  trum_cycle_enter(&c, 0);
  figures[browser_figure_region_1] = c.duration[0], figures[browser_figure_region_2] = c.duration[0] + c.duration[1];
  for (i = 0; i <= count; ++i) {
    const double time = figures[browser_figure_cycle_time] * i / count;
    for (; region < TRUM_REGIONS - 1 && time - since >= c.duration[region]; trum_cycle_enter(&c, ++region))
      since += c.duration[region];
    trum_cycle_at(&c, time - since);
    browser_touch(in, &c, v);
    v[trum_at_w_A] = c.at.w_A, v[trum_at_w_B] = c.at.w_B, v[trum_at_x] = 0;
    trum_call_displacement(v);
    histories[browser_history_w_A][i] = c.at.w_A, histories[browser_history_w_B][i] = c.at.w_B, histories[browser_history_Q][i] = c.at.Q;
    histories[browser_history_zeta_x][i] = v[trum_at_zeta_x];
    histories[browser_history_W_c][i] = v[trum_at_W_c], histories[browser_history_theta][i] = v[trum_at_theta];
  }
}

/* Figures of the settings, and histories of a cycle at count + 1 equal times, the first at t1; what does not follow is
 * NaN.  Returns the status. */
BROWSER_EXPORT(solve) int browser_solve(int count) {
  struct trum_motor motor;
  struct trum_drive drive;
  struct trum_point point;
  trum_orbit_in in;
  trum_orbit_out out;
  double* speed = histories[browser_history_rotor_speed];
  enum trum_status status;
  int i, k;
  if (count < 1 || count > BROWSER_MOST_SAMPLES) return -1;
  browser_take(&motor, &drive);
  status = trum_solve_point(&motor, &drive, &point, &in, &out, 0);
  for (i = 0; i < BROWSER_HISTORY_COUNT; ++i)
    for (k = 0; k <= count; ++k) histories[i][k] = NAN;
#define TRUM_STORE(name, unit) figures[browser_figure_##name] = point.name;
  TRUM_FIGURES(TRUM_STORE)
#undef TRUM_STORE
  figures[browser_figure_status] = status, figures[browser_figure_field] = point.field;
  figures[browser_figure_converged] = point.converged, figures[browser_figure_full_contact] = point.full_contact;
  figures[browser_figure_outside_fit] = point.outside_fit;
  figures[browser_figure_region_1] = figures[browser_figure_region_2] = NAN;
  if (status != TRUM_OK && status != TRUM_RUNAWAY && status != TRUM_NOT_CONVERGED && status != TRUM_NO_BRUSH)
    return status;
  browser_vibrate(&in, count);
  if (status == TRUM_RUNAWAY || status == TRUM_NO_BRUSH) return status;
  trum_ride(&drive, &point, &in, &out, speed + 1, distance, count, 0);
  for (i = 1; i <= count; ++i) speed[i] /= (double)motor.contact_radius;
  speed[0] = speed[count]; /* the orbit repeats itself */
  return status;
}
