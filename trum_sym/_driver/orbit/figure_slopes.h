/* Slopes of the orbit's figures by its parameters, from the sensitivities that a lap has integrated. */
#ifndef TRUM_ORBIT_FIGURE_SLOPES_H
#define TRUM_ORBIT_FIGURE_SLOPES_H

/* Slopes of the figures once the orbit is found.  The start speed follows a parameter by the implicit function theorem:
 * d0 = dx(end) / (1 - growth). */
static void trum_store_slopes(trum_search* search) {
  const trum_lap_sums* lap = &search->lap;
  const trum_real whole = search->cycle_time, growth = lap->growth;
  const trum_real decay = trum_larger(1 - growth, trum_least_decay);
  const trum_real x = lap->x / whole, S = lap->S / whole;
  const trum_real xS = lap->xS / whole;
  int parameter;
  for (parameter = 0; parameter < PARAMETERS; ++parameter) {
    trum_real(*of)[TRUM_SLOPE_PARAMETERS_COUNT] = search->slopes_out->of;
    if (search->stage == STAGE_HELD) {
      if (search->held_laps != 1)
        of[TRUM_OF_CONTACT][parameter] = lap->d_angle[parameter] / whole / TRUM_C(3.14159265358979323846);
      if (search->held_laps != 2) of[TRUM_OF_HELD][parameter] = lap->d_friction[parameter] / whole;
    } else {
      const trum_real d0 = lap->d_end[parameter] / decay;
      const trum_real d_x = lap->d_x[parameter] / whole;
      of[TRUM_OF_MEAN][parameter] = d_x + S * d0;
      of[TRUM_OF_LOW][parameter] = lap->d_low[parameter] + lap->S_low * d0;
      of[TRUM_OF_HIGH][parameter] = lap->d_high[parameter] + lap->S_high * d0;
      of[TRUM_OF_VARIANCE][parameter] =
          2 * (lap->d_xx[parameter] / whole - x * d_x + (xS - x * S) * d0);
    }
  }
}

/* Errors of the next lap's slopes are measured by what this one has summed up; slopes that are nothing but rounding, as
 * those of a plain wave's contact by the frequencies, are not to be resolved. */
static void trum_update_slope_scales(trum_search* search, trum_real growth) {
  int k;
  search->scales.growth = growth;
  for (k = 0; k < PARAMETERS; ++k) {
    const int by_frequency = k == TRUM_BY_RESONANCE || k == TRUM_BY_DIFFERENCE;
    const trum_real least =
        trum_least_slope * search->cycle_time / (by_frequency ? search->in->omega_n : 1);
    search->scales.friction[k] = trum_larger(search->lap.sum_abs_friction[k], least);
    search->scales.angle[k] = trum_larger(search->lap.sum_abs_angle[k], least);
  }
}

#endif
