/* The points of points.h evaluated one by one: figures as a table, with steps, instructions and stack of each.
 *
 * `python -m studies.metal` writes points.h, runs this on emulated machines and on the PC and compares; so can you on your own
 * target, with examples/metal/points.csv beside it. */
#include <stdio.h>

#include "trum.h"
#include "board.h"
#include "motor.h"
#include "points.h"

int main(void) {
  long i;
  board_start();
  for (i = 0; i < POINT_COUNT; ++i) {
    struct trum_drive drive = my_drive;
    struct trum_point point;
    uint32_t before, after, depth;
    int status;
    drive.prepressure = TRUM_C(points[i].prepressure);
    drive.frequency_difference = TRUM_C(points[i].frequency_difference);
    drive.load_torque = TRUM_C(points[i].load_torque);
    drive.switching_phase = TRUM_C(points[i].switching_phase);
    drive.on_periods = TRUM_C(points[i].on_periods);
    drive.phase_lead = TRUM_C(points[i].phase_lead);
    drive.start = points[i].start;
    drive.contact = points[i].contact;
#ifdef TOLERANCE
    drive.tolerance = TRUM_C(TOLERANCE);
#endif
    board_paint();
    before = board_count();
    status = (int)trum_evaluate(&my_motor, &drive, &point);
    after = board_count();
    depth = board_depth();
    printf("%ld,%d,%ld,%.0f,%lu", i, status, (long)point.steps, (double)(after - before) * BOARD_UNIT, (unsigned long)depth);
#define PRINT(name, unit) printf(",%.9g", (double)point.name);
    TRUM_FIGURES(PRINT)
    printf("\n");
  }
  return 0;
}
