/* Lowest and highest speed of a lap: at a step's end, or where the rate, a cubic in the step's parameter, is zero. */
#ifndef TRUM_ORBIT_EXTREMES_H
#define TRUM_ORBIT_EXTREMES_H

/* The magnitude of the error, and the remainder, at the extremes so far. */
static void trum_mark_extremes(trum_lap* lap, mask lower, mask higher, real error, real remainder) {
  lap->low_error = where(lower, error, lap->low_error);
  lap->low_remainder = where(lower, remainder, lap->low_remainder);
  lap->high_error = where(higher, error, lap->high_error);
  lap->high_remainder = where(higher, remainder, lap->high_remainder);
}

/* Widens the bounds of all extremes by a speed and what it may be off by. */
static void trum_widen(trum_lap* lap, mask relevant, real value, real off) {
  lap->lowest = where(relevant, minimum(lap->lowest, value - off), lap->lowest);
  lap->highest = where(relevant, maximum(lap->highest, value + off), lap->highest);
}

/* Takes an accepted step into the lap's extremes of x, with S and the sensitivities at them. */
static void trum_update_extremes(const real* G, const real* x, const real* S, real (*d)[NODES], int slopes,
                                 mask accepted, mask damped, const trum_defect* defect, trum_lap* lap) {
  static const trum_real P[NODES][NODES] = TRUM_COLLOCATION_POWERS;
  real p[NODES], top = maximum(x[0], x[1]), bottom = minimum(x[0], x[1]), steepest = absolute(G[0]);
  real end_error, end_remainder, error, remainder;
  mask has_extremum = mask_all(0), relevant, closer;
  int k, j, parameter;
  trum_end_errors(lap, defect, &end_error, &end_remainder);
  end_error = absolute(end_error), end_remainder = end_remainder + where(damped, defect->inside, REAL(0));
  error = maximum(absolute(lap->error), end_error), remainder = maximum(lap->remainder, end_remainder) + defect->inside;
  closer = less_than(defect->most_end, end_error + end_remainder);
  end_error = where(closer, REAL(0), end_error), end_remainder = where(closer, defect->most_end, end_remainder);
  closer = less_than(defect->most_inside, error + remainder);
  error = where(closer, REAL(0), error), remainder = where(closer, defect->most_inside, remainder);
  for (j = 1; j < NODES; ++j) {
    top = maximum(top, x[j]), bottom = minimum(bottom, x[j]), steepest = maximum(steepest, absolute(G[j]));
    has_extremum = has_extremum | (at_most(G[j] * G[j - 1], REAL(0)));
  }
  /* no interior value is further than half the steepest rate from a node's: skip what cannot matter */
  relevant = accepted & has_extremum;
  relevant = relevant &
             (less_than(lap->high, top + REAL(0.5) * steepest) | less_than(bottom - REAL(0.5) * steepest, lap->low));
  if (any_lane(relevant)) {
    for (k = 0; k < NODES; ++k) {
      p[k] = REAL(P[k][0]) * G[0];
      for (j = 1; j < NODES; ++j) p[k] = p[k] + REAL(P[k][j]) * G[j];
    }
    for (k = 0; k < 3; ++k) { /* zeros of the rate, by Newton from the middles of three thirds */
      real at = REAL((TRUM_C(2.0) * (trum_real)k + 1) / 6), value, S_there, weight[NODES];
      mask lower, higher;
      for (j = 0; j < 4; ++j) {
        const real slope = p[1] + at * (REAL(2) * p[2] + at * REAL(3) * p[3]);
        const real rate = p[0] + at * (p[1] + at * (p[2] + at * p[3]));
        const mask usable = less_than(REAL(trum_no_slope), absolute(slope));
        at = maximum(REAL(0),
                     minimum(REAL(1), where(usable, at - rate * reciprocal(where(usable, slope, REAL(1))), at)));
      }
      value =
          x[0] + at * (p[0] + at * (REAL(1.0 / 2) * p[1] + at * (REAL(1.0 / 3) * p[2] + at * REAL(1.0 / 4) * p[3])));
      for (j = 0; j < NODES; ++j)
        weight[j] = REAL(P[0][j]) + at * (REAL(P[1][j]) + at * (REAL(P[2][j]) + at * REAL(P[3][j])));
      for (S_there = weight[0] * S[0], j = 1; j < NODES; ++j) S_there = S_there + weight[j] * S[j];
      lower = relevant & less_than(value, lap->low), higher = relevant & less_than(lap->high, value);
      lap->low = where(lower, value, lap->low), lap->S_low = where(lower, S_there, lap->S_low);
      lap->high = where(higher, value, lap->high), lap->S_high = where(higher, S_there, lap->S_high);
      trum_mark_extremes(lap, lower, higher, error, remainder);
      trum_widen(lap, relevant, value, error + remainder);
      for (parameter = 0; slopes && parameter < PARAMETERS; ++parameter) {
        real slope_there = weight[0] * d[parameter][0];
        for (j = 1; j < NODES; ++j) slope_there = slope_there + weight[j] * d[parameter][j];
        lap->d_low[parameter] = where(lower, slope_there, lap->d_low[parameter]);
        lap->d_high[parameter] = where(higher, slope_there, lap->d_high[parameter]);
      }
    }
  }
  {
    const mask lower = accepted & less_than(x[LAST_NODE], lap->low);
    const mask higher = accepted & less_than(lap->high, x[LAST_NODE]);
    lap->low = where(lower, x[LAST_NODE], lap->low), lap->S_low = where(lower, S[LAST_NODE], lap->S_low);
    lap->high = where(higher, x[LAST_NODE], lap->high), lap->S_high = where(higher, S[LAST_NODE], lap->S_high);
    trum_mark_extremes(lap, lower, higher, end_error, end_remainder);
    trum_widen(lap, accepted, x[LAST_NODE], end_error + end_remainder);
    for (k = 0; slopes && k < PARAMETERS; ++k) {
      lap->d_low[k] = where(lower, d[k][LAST_NODE], lap->d_low[k]);
      lap->d_high[k] = where(higher, d[k][LAST_NODE], lap->d_high[k]);
    }
  }
}

#endif
