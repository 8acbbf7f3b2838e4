/* What the first step of a lap needs to know of its start. */
#ifndef TRUM_ORBIT_LAP_START_H
#define TRUM_ORBIT_LAP_START_H

static void trum_keep(trum_changes* kept, const trum_changes* by, mask here) {
  int way;
  for (way = 0; way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) {
    kept->f[way] = sel(here, by->f[way], kept->f[way]);
    kept->ln_E[way] = sel(here, by->ln_E[way], kept->ln_E[way]);
    kept->ln_R_v[way] = sel(here, by->ln_R_v[way], kept->ln_R_v[way]);
  }
  kept->theta_E = sel(here, by->theta_E, kept->theta_E);
  kept->R_v_rate = sel(here, by->R_v_rate, kept->R_v_rate), kept->W_c_rate = sel(here, by->W_c_rate, kept->W_c_rate);
}

/* What the first step of a lap needs to know of its start. */
static void trum_begin(trum_lanes* l) {
  trum_surface at;
  real f, f_v, e[EVENTS];
  int k;
  trum_look(l, l->tau, &at);
  trum_rub(&at, l->v0 + l->x, &f, &f_v, &e[LARGER], &e[SMALLER]);
  e[SPEED] = at.R_v * at.R_v - (l->v0 + l->x) * (l->v0 + l->x);
  e[FULL] = at.W_c * at.W_c - l->constants.W_full * l->constants.W_full;
  l->f = sel(l->cold, f, l->f), l->f_v = sel(l->cold, f_v, l->f_v);
  l->theta = sel(l->cold, at.theta, l->theta);
  l->cos_phi = sel(l->cold, at.cos_phi, l->cos_phi), l->sin_phi = sel(l->cold, at.sin_phi, l->sin_phi);
  if (l->slopes) {
    trum_changes by;
    trum_change(l, l->tau, &at, l->v0 + l->x, &by);
    trum_keep(&l->changes, &by, l->cold);
  }
  for (k = 0; k < EVENTS; ++k) {
    l->event[k] = sel(l->cold, e[k], l->event[k]);
    l->fresh[k] = l->fresh[k] & no(l->cold);
  }
  l->cold = is(0);
}

#endif
