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
  X(w_A, "m") X(w_B, "m") X(zeta_x, "m") X(Q, "m^2/s") X(W_c, "m") X(theta, "rad") X(rotor_speed, "rad/s") \
  X(crest, "m") X(level, "m")
/* One picture of the moving motor: the surface's height at BROWSER_COLUMNS equal places over BROWSER_WAVES wavelengths
 * from place 0, and the path of the point that is the crest now over the drive period before. */
#define BROWSER_COLUMNS 193
#define BROWSER_WAVES 2
#define BROWSER_PATH 49
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
static double heights[BROWSER_COLUMNS], path_along[BROWSER_PATH], path_up[BROWSER_PATH];
static double lap_speed[BROWSER_MOST_SAMPLES], lap_way[BROWSER_MOST_SAMPLES];
/* What solve leaves for film and lap. */
static struct {
  struct trum_motor motor;
  struct trum_drive drive;
  struct trum_point point;
  trum_orbit_in in;
  trum_orbit_out out;
  double rim; /* speed at the end of the last lap */
  int count;  /* of samples; 0: there is no motion */
  int follows; /* whether the rotor's can be followed */
} solved;

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
BROWSER_EXPORT(heights) double* browser_heights(void) { return heights; }
BROWSER_EXPORT(path_along) double* browser_path_along(void) { return path_along; }
BROWSER_EXPORT(path_up) double* browser_path_up(void) { return path_up; }
BROWSER_EXPORT(lap_speed) double* browser_lap_speed(void) { return lap_speed; }
BROWSER_EXPORT(lap_way) double* browser_lap_way(void) { return lap_way; }
BROWSER_EXPORT(length) double browser_length(void) { return BROWSER_WAVES * 6.283185307179586 / solved.in.k_c; }
BROWSER_EXPORT(columns) int browser_columns(void) { return BROWSER_COLUMNS; }
BROWSER_EXPORT(path_points) int browser_path_points(void) { return BROWSER_PATH; }
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

/* Where the crest is, tau after a region's begin. */
static void browser_crest(const trum_orbit_in* in, const trum_cycle* c, double tau, trum_real* v) {
  v[trum_at_psi] = in->psi, v[trum_at_tau] = tau, v[trum_at_x] = 0;
  v[trum_at_a_A] = c->state.a_A, v[trum_at_b_A] = c->state.b_A;
  v[trum_at_a_B] = c->state.a_B, v[trum_at_b_B] = c->state.b_B;
  v[trum_at_g_A] = c->gates.g_A, v[trum_at_g_B] = c->gates.g_B;
  trum_call_particle(v);
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
    browser_crest(in, &c, time - since, v);
    histories[browser_history_crest][i] = v[trum_at_x_max];
    v[trum_at_x] = v[trum_at_x_max] + v[trum_at_theta] / v[trum_at_k_c];
    v[trum_at_w_A] = c.at.w_A, v[trum_at_w_B] = c.at.w_B;
    trum_call_displacement(v);
    histories[browser_history_level][i] = v[trum_at_zeta_z];
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
  double* speed = histories[browser_history_rotor_speed];
  enum trum_status status;
  int i, k;
  if (count < 1 || count > BROWSER_MOST_SAMPLES) return -1;
  browser_take(&solved.motor, &solved.drive);
  solved.count = solved.follows = 0, solved.rim = 0;
  status = trum_solve_point(&solved.motor, &solved.drive, &solved.point, &solved.in, &solved.out, 0);
  for (i = 0; i < BROWSER_HISTORY_COUNT; ++i)
    for (k = 0; k <= count; ++k) histories[i][k] = NAN;
#define TRUM_STORE(name, unit) figures[browser_figure_##name] = solved.point.name;
  TRUM_FIGURES(TRUM_STORE)
#undef TRUM_STORE
  figures[browser_figure_status] = status, figures[browser_figure_field] = solved.point.field;
  figures[browser_figure_converged] = solved.point.converged;
  figures[browser_figure_full_contact] = solved.point.full_contact;
  figures[browser_figure_outside_fit] = solved.point.outside_fit;
  figures[browser_figure_region_1] = figures[browser_figure_region_2] = NAN;
  if (status != TRUM_OK && status != TRUM_RUNAWAY && status != TRUM_NOT_CONVERGED && status != TRUM_NO_BRUSH)
    return status;
  browser_vibrate(&solved.in, count);
  solved.count = count;
  if (status == TRUM_RUNAWAY || status == TRUM_NO_BRUSH) return status;
  solved.follows = 1;
  trum_ride(&solved.drive, &solved.point, &solved.in, &solved.out, speed + 1, distance, count, 0);
  for (i = 1; i <= count; ++i) speed[i] /= (double)solved.motor.contact_radius;
  speed[0] = speed[count]; /* the orbit repeats itself */
  return status;
}

/* Fills heights and path at a sample of the histories; 0 where there is none. */
BROWSER_EXPORT(picture) int browser_picture(int sample) {
  trum_real v[TRUM_VALUES];
  int i;
  if (sample < 0 || sample > solved.count || solved.count == 0) return 0;
  memset(v, 0, sizeof v);
  v[trum_at_D] = solved.in.D, v[trum_at_k_c] = solved.in.k_c;
  v[trum_at_w_A] = histories[browser_history_w_A][sample], v[trum_at_w_B] = histories[browser_history_w_B][sample];
  for (i = 0; i < BROWSER_COLUMNS; ++i) {
    v[trum_at_x] = browser_length() * i / (BROWSER_COLUMNS - 1);
    trum_call_displacement(v);
    heights[i] = v[trum_at_zeta_z];
  }
  v[trum_at_x] = histories[browser_history_crest][sample];
  for (i = 0; i < BROWSER_PATH; ++i) { /* samples are linear enough: 48 a period */
    const double period = solved.count / (double)solved.drive.periods;
    double at = sample - period * (BROWSER_PATH - 1 - i) / (BROWSER_PATH - 1);
    int from;
    if (at < 0) at = 0; /* before t1 nothing is known but for a cycle that repeats itself */
    from = at >= solved.count ? solved.count - 1 : (int)at;
    v[trum_at_w_A] = histories[browser_history_w_A][from] +
                     (at - from) * (histories[browser_history_w_A][from + 1] - histories[browser_history_w_A][from]);
    v[trum_at_w_B] = histories[browser_history_w_B][from] +
                     (at - from) * (histories[browser_history_w_B][from + 1] - histories[browser_history_w_B][from]);
    trum_call_displacement(v);
    path_along[i] = v[trum_at_zeta_x], path_up[i] = v[trum_at_zeta_z];
  }
  return 1;
}

/* Fills lap_speed and lap_way, the rotor's speed and its rim's way at solve's samples but the first, of the cycle after the last
 * one, and of the cycle that begins at rest after solve; 0 where the rotor cannot be followed. */
BROWSER_EXPORT(lap) int browser_lap(void) {
  trum_orbit_out from = solved.out;
  const double radius = (double)solved.motor.contact_radius;
  int i, done;
  if (!solved.follows) return 0;
  from.start = solved.rim, from.high = trum_larger(from.high, from.start);
  if (from.start < from.low) from.low = from.start;
  done = solved.drive.tangential == TRUM_TANGENTIAL_BRUSH
             ? trum_ride(&solved.drive, &solved.point, &solved.in, &solved.out, lap_speed, lap_way, solved.count, 0)
             : trum_history(&solved.in, &from, lap_speed, lap_way, solved.count, 0);
  if (!done) return 0;
  solved.rim = lap_speed[solved.count - 1];
  for (i = 0; i < solved.count; ++i) lap_speed[i] /= radius;
  return 1;
}
