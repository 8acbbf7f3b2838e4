/* Instructions of single functions at the paper's Table 3. */
#include <stdio.h>
#include <string.h>

#include "trum.h"
#include "board.h"
#include "motor.h"

#define REPEATS 64

static void kernel(const char* name, int (*f)(const trum_real**, trum_real**, long long int*, trum_real*, int), int in,
                   int out) {
  trum_real numbers[40], results[64];
  const trum_real* arg[40];
  trum_real* res[64];
  uint32_t before, after;
  int k;
  for (k = 0; k < in; ++k) numbers[k] = TRUM_C(0.3) + TRUM_C(0.1) * (trum_real)k, arg[k] = &numbers[k];
  for (k = 0; k < out; ++k) res[k] = &results[k];
  before = board_count();
  for (k = 0; k < REPEATS; ++k) (void)f(arg, res, 0, 0, 0);
  after = board_count();
  printf("%s,%lu\n", name, (unsigned long)((after - before) * BOARD_UNIT / REPEATS));
}

int main(void) {
  struct trum_drive drive = my_drive;
  struct trum_point point;
  uint32_t before, after;
  board_start();
  kernel("trum_wave", trum_wave, trum_wave_n_arg, trum_wave_n_res);
  kernel("trum_friction", trum_friction, trum_friction_n_arg, trum_friction_n_res);
  before = board_count();
  (void)trum_evaluate_determinants(&my_motor, &drive, &point);
  after = board_count();
  printf("trum_evaluate_determinants,%lu\n", (unsigned long)((after - before) * BOARD_UNIT));
  before = board_count();
  (void)trum_evaluate(&my_motor, &drive, &point);
  after = board_count();
  printf("trum_evaluate,%.0f\n", (double)(after - before) * BOARD_UNIT);
  return 0;
}
