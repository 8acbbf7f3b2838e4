/* Speed control of a travelling-wave motor: a table of drives, an encoder and a PI law, every 2 ms, in float. */
#ifndef CONTROL_H
#define CONTROL_H

#include <stdint.h>

#include "table.h"

#define CONTROL_PERIOD 0.002f /* s */

/* Gains and encoder, and what is remembered from tick to tick. */
typedef struct {
  float proportional, integral; /* of the speed's error: 1, 1/s */
  float count;                  /* angle of an encoder's count, rad */
  float sum;                    /* of the errors, rad/s */
  int32_t last;                 /* the encoder's count at the last tick */
} control_state;

/* One tick: the encoder's count and the speed that is wanted, rad/s; gives the drive, and returns 1, or 0 where the table
 * has none and the drive stays as it is. */
static inline int control_tick(control_state* state, float wanted, int32_t count, table_real drive[TABLE_COLUMNS]) {
  const float speed = (float)(int32_t)((uint32_t)count - (uint32_t)state->last) * (state->count / CONTROL_PERIOD);
  const float error = wanted - speed, sum = state->sum + error * CONTROL_PERIOD;
  const float asked = wanted + state->proportional * error + state->integral * sum;
  state->last = count;
  if (!table_drive(asked, drive)) return 0; /* the sum stays, too: no windup */
  state->sum = sum;
  return 1;
}

#endif
