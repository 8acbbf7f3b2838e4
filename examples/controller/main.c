/* The controller on a simulated motor whose load is not the table's, so that the integral has something to find.
 *
 * The motor is the C library's: its mean speed at the drive of the tick, as a bare rotor settles within one.  Prints every
 * tick, then the most instructions that a tick of the controller took, and how far the last ten speeds are off. */
#include <math.h>
#include <stdio.h>

#include "trum.h"
#include "board.h"
#include "control.h"
#include "motor.h"

#define TICKS 40
#define WANTED 0.5f /* rad/s */

int main(void) {
  control_state state = {0.2f, 60.0f, 6.2831853f / 2097152.0f, 0.0f, 0};
  float drive[TABLE_COLUMNS] = {0.0f}, angle = 0.0f, off = 0.0f;
  uint32_t most = 0;
  int i, known = table_drive(WANTED, drive);
  board_start();
  for (i = 0; i < TICKS && known; ++i) {
    struct trum_drive motor_drive = my_drive;
    struct trum_point point;
    uint32_t before, taken;
    int32_t count;
    motor_drive.prepressure = drive[TABLE_PREPRESSURE];
    motor_drive.frequency_difference = drive[TABLE_FREQUENCY_DIFFERENCE];
    motor_drive.load_torque = 0.06f;
    if (trum_evaluate(&my_motor, &motor_drive, &point) != TRUM_OK) return 1;
    angle += point.mean_speed * CONTROL_PERIOD;
    count = (int32_t)floorf(angle / state.count);
    before = board_count();
    known = control_tick(&state, WANTED, count, drive);
    taken = board_count() - before;
    if (taken > most) most = taken;
    if (i >= TICKS - 10) off += fabsf(point.mean_speed / WANTED - 1.0f) / 10.0f;
    printf("%d %.6f rad/s, next %.3f Hz\n", i, (double)point.mean_speed, (double)drive[TABLE_FREQUENCY_DIFFERENCE]);
  }
  printf("instructions of a tick: at most %lu\n", (unsigned long)(most * BOARD_UNIT));
  printf("off by %.3f %%\n", (double)(100.0f * off));
  return known && off < 0.01f ? 0 : 1;
}
