/* Laps of one point, for tests/driver/test_segments.py: with its segments in turn, and joined from segments that begin so much
 * beside where the lap passes, over the largest speed.
 *
 *     NAME=VALUE ...    the example's arguments; then on standard input lines of LEVEL BESIDE
 *
 * prints the number of laps that the point's search takes, all coarse ones counted as one, and the sums of both laps of each
 * line, a JSON object a line. */
#define TRUM_SLOPES 1
#define main example_main
#include "main.c"
#undef main

/* A lap from a start speed at a level, with its segments side by side or not. */
static void lap(trum_workspace* w, trum_search* search, int side_by_side) {
  int k;
  if (!side_by_side) search->in_turn = 1;
  trum_prepare_lap(search, 0);
  search->side_by_side = side_by_side, search->segment = side_by_side ? search->segments : 0, search->in_turn = 0;
  for (k = 0; k < (side_by_side ? search->segments : 1); ++k) {
    trum_start_segment(&w->lanes, 0, search, k);
    for (;;) {
      if (w->lanes.status.at_lap_start) trum_evaluate_lap_start(&w->lanes);
      if (!trum_advance_step(&w->lanes) || w->lanes.step.time_left > 0) continue;
      if (side_by_side || !trum_enter_next_segment(&w->lanes, 0, search)) break;
    }
    trum_end_segment(&w->lanes, 0, search, k);
  }
  trum_join_lap(search, 1);
}

static void print(const char* name, const trum_search* search, const trum_lap_sums* lap) {
  int k;
  printf("\"%s\": {\"speed\": %.17g", name, search->v0 + lap->end);
#define MEMBER(name) printf(", \"" #name "\": %.17g", lap->name);
  TRUM_LAP_INTEGRALS(MEMBER) TRUM_LAP_STATES(MEMBER) MEMBER(growth)
#undef MEMBER
#define MEMBER(name) for (k = 0; k < PARAMETERS; ++k) printf(", \"" #name "_%d\": %.17g", k, lap->name[k]);
  TRUM_LAP_SLOPES(MEMBER) MEMBER(d_end)
#undef MEMBER
  printf(", \"jumps\": %.17g}", search->jumps);
}

int main(int argc, char** argv) {
  struct trum_motor motor = trum60;
  struct trum_drive drive = trum_table3;
  struct trum_point point;
  trum_orbit_in in;
  trum_orbit_out out;
  trum_slopes_in slopes_in;
  trum_slopes_out slopes_out;
  static trum_workspace w;
  double level, beside;
  int k;
  for (k = 1; k < argc; ++k)
    if (!set(&motor, &drive, argv[k])) return 2;
  if (trum_solve_point(&motor, &drive, &point, &in, &out, 0) != TRUM_OK) return 1;
  in.held = 0;
  if (!trum_find_orbits(&w, &in, &out, 0, 0, 1, 0)) return 1;
  printf("{\"laps\": %d}\n", w.searches[0].laps);
  memset(&slopes_in, 0, sizeof slopes_in);
  while (scanf("%lf %lf", &level, &beside) == 2) {
    trum_search* search = &w.searches[0];
    trum_initialise_lanes(&w.lanes, in.hertz > 0.5, 1);
    search->slopes_in = &slopes_in, search->slopes_out = &slopes_out;
    trum_begin_task(&w.lanes, search, &in, &out);
    search->stage = STAGE_ROUGH, search->level = level, search->start_speed = out.start;
    search->scales.speed = search->top = trum_fabs(out.high);
    lap(&w, search, 0);
    printf("{"), print("in turn", search, &search->lap);
    for (k = 1; k < search->segments; ++k)
      search->at[k].error = 0, search->at[k].speed += (k % 2 ? beside : -beside) * search->top;
    lap(&w, search, 1);
    printf(", "), print("joined", search, &search->lap), printf("}\n");
  }
  return 0;
}
