/* Speed and distance at equal times, read off the polynomial of each step. */
#ifndef TRUM_ORBIT_HISTORY_H
#define TRUM_ORBIT_HISTORY_H

/* Writes the times that fall into lane 0's step; speed and distance are polynomials in the step's parameter. */
static void trum_record_step(trum_record* r, const trum_lanes* lanes, const real* rate) {
  static const trum_real P[NODES][NODES] = TRUM_COLLOCATION_POWERS;
  const trum_real h = lane_value(&lanes->step.h, 0), curvature = lane_value(&lanes->step.curvature, 0);
  const trum_real v0 = lane_value(&lanes->equation.v0, 0);
  trum_real q[NODES + 1], travelled = 0;
  int k, j;
  q[0] = v0 + lane_value(&lanes->start.x, 0);
  for (k = 0; k < NODES; ++k) {
    q[k + 1] = 0;
    for (j = 0; j < NODES; ++j) q[k + 1] += P[k][j] * lane_value(&rate[j], 0) / (trum_real)(k + 1);
  }
  for (;;) {
    const trum_real time = r->spacing * (trum_real)(r->written + 1);
    const int last = r->written + 1 == r->count;
    trum_real z = (time - r->since) / h, at = 1, power = 1, speed = 0, distance = 0;
    const int beyond = r->written == r->count || (z > 1 && !(last && time <= (r->since + h) * (1 + TRUM_EITHER(1e-9, 1e-5))));
    if (!beyond) {
      z = z < 0 ? 0 : z > 1 ? 1 : z;
      at = curvature > 0 ? 1 - trum_sqrt(1 - z) : curvature < 0 ? trum_sqrt(z) : z;
    }
    for (k = 0; k <= NODES; ++k) {
      speed += q[k] * power;
      distance += h * q[k] * power * at * ((1 + curvature) / (trum_real)(k + 1) - 2 * curvature * at / (trum_real)(k + 2));
      power *= at;
    }
    if (beyond) {
      travelled = distance;
      break;
    }
    r->speed[r->written] = speed, r->distance[r->written] = r->travelled + distance;
    ++r->written;
  }
  r->travelled += travelled, r->since += h;
}

#endif
