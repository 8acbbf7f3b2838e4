/* Lowest and highest speed of a lap, on the polynomial of each step. */
#ifndef TRUM_ORBIT_EXTREMES_H
#define TRUM_ORBIT_EXTREMES_H

/* Lowest and highest x in a step: at its end, or where its rate, a cubic in the step's parameter, is zero. */
static void trum_extremes(const real* G, const real* x, const real* S, real (*d)[NODES], int slopes, mask accepted,
                          trum_lap* lap) {
  static const double P[NODES][NODES] = TRUM_COLLOCATION_POWERS;
  real p[NODES], top = most(x[0], x[1]), bottom = least(x[0], x[1]), steepest = size_of(G[0]);
  mask turns = is(0), needed;
  int k, j, way;
  for (j = 1; j < NODES; ++j) {
    top = most(top, x[j]), bottom = least(bottom, x[j]), steepest = most(steepest, size_of(G[j]));
    turns = turns | (at_most(G[j] * G[j - 1], N_(0)));
  }
  /* no interior value is further than this from a node's */
  needed = accepted & turns;
  needed = needed & (less_than(lap->high, top + N_(0.5) * steepest) | less_than(bottom - N_(0.5) * steepest, lap->low));
  if (any(needed)) {
    for (k = 0; k < NODES; ++k) {
      p[k] = N_(P[k][0]) * G[0];
      for (j = 1; j < NODES; ++j) p[k] = p[k] + N_(P[k][j]) * G[j];
    }
    for (k = 0; k < 3; ++k) { /* the rate's zeros by Newton from the middles of the thirds */
      real at = N_((2.0 * k + 1.0) / 6.0), value, S_there, weight[NODES];
      mask lower, higher;
      for (j = 0; j < 4; ++j) {
        const real slope = p[1] + at * (N_(2) * p[2] + at * N_(3) * p[3]);
        const real rate = p[0] + at * (p[1] + at * (p[2] + at * p[3]));
        const mask steep = less_than(N_(1e-200), size_of(slope));
        at = most(N_(0), least(N_(1), sel(steep, at - rate * inverse_of(sel(steep, slope, N_(1))), at)));
      }
      value = x[0] + at * (p[0] + at * (N_(1.0 / 2) * p[1] + at * (N_(1.0 / 3) * p[2] + at * N_(1.0 / 4) * p[3])));
      for (j = 0; j < NODES; ++j) weight[j] = N_(P[0][j]) + at * (N_(P[1][j]) + at * (N_(P[2][j]) + at * N_(P[3][j])));
      for (S_there = weight[0] * S[0], j = 1; j < NODES; ++j) S_there = S_there + weight[j] * S[j];
      lower = needed & less_than(value, lap->low), higher = needed & less_than(lap->high, value);
      lap->low = sel(lower, value, lap->low), lap->S_low = sel(lower, S_there, lap->S_low);
      lap->high = sel(higher, value, lap->high), lap->S_high = sel(higher, S_there, lap->S_high);
      for (way = 0; slopes && way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) {
        real there = weight[0] * d[way][0];
        for (j = 1; j < NODES; ++j) there = there + weight[j] * d[way][j];
        lap->d_low[way] = sel(lower, there, lap->d_low[way]);
        lap->d_high[way] = sel(higher, there, lap->d_high[way]);
      }
    }
  }
  {
    const mask lower = accepted & less_than(x[EDGE], lap->low), higher = accepted & less_than(lap->high, x[EDGE]);
    lap->low = sel(lower, x[EDGE], lap->low), lap->S_low = sel(lower, S[EDGE], lap->S_low);
    lap->high = sel(higher, x[EDGE], lap->high), lap->S_high = sel(higher, S[EDGE], lap->S_high);
    for (k = 0; slopes && k < TRUM_SLOPE_PARAMETERS_COUNT; ++k) {
      lap->d_low[k] = sel(lower, d[k][EDGE], lap->d_low[k]), lap->d_high[k] = sel(higher, d[k][EDGE], lap->d_high[k]);
    }
  }
}

#endif
