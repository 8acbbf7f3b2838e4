/* A step's error over the error that it may have. */
#ifndef TRUM_ORBIT_ERROR_H
#define TRUM_ORBIT_ERROR_H

/* A step's error over what it may be, and in integral f. */
static real trum_ratio(trum_lanes* l, const trum_attempt* t, mask tiny, real* error) {
  const mask held = at_most(l->push, N_(0));
  real G[NODES], ratio, cosine = l->cos_phi, sine = l->sin_phi;
  mask number, blind = is(0);
  int j;
  for (j = 0; j < NODES; ++j) G[j] = t->T[j] * t->f[j];
  *error = trum_quadrature_error(G);
  if (any(held & l->active)) { /* a held lap also measures the contact */
    G[0] = t->T[0] * l->theta;
    for (j = 1; j < NODES; ++j) G[j] = t->T[j] * t->at[j].theta;
    *error = sel(l->contact, N_(0), *error);
    *error = sel(held, most(*error, N_(0.31830988618379067154) * trum_quadrature_error(G)), *error);
  }
  ratio = *error * l->per_allowed;
  if (l->slopes) {
    const mask felt = less_than(N_(trum_feels) * l->period, l->h);
    const int contact = any(held & l->active); /* a moving lap's is not asked for */
    real T_f_v[NODES], T_theta_E[NODES], of;
    int way;
    trum_stiffness(l, t, T_f_v);
    if (contact) trum_widening(l, t, T_theta_E);
    of = l->push * l->per_growth * trum_quadrature_error(T_f_v);
    for (way = 0; way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) {
      if (way == TRUM_BY_DRAG || way == TRUM_BY_FRICTION) continue;
      trum_source(l, t, T_f_v, way, G);
      of = most(of, l->per_f[way] * trum_quadrature_error(G));
      if (!contact) continue;
      for (j = 0; j < NODES; ++j) G[j] = T_theta_E[j] * t->by[j].ln_E[way];
      of = sel(held, most(of, l->per_angle[way] * trum_quadrature_error(G)), of);
    }
    ratio = sel(felt & less_than(of, N_(1e30)), most(ratio, of), ratio);
  }
  number = less_than(ratio, N_(1e30));
  ratio = sel(number & no(t->open), least(ratio, N_(1e6)), N_(1e6));
  l->lost = l->lost | (l->active & no(number) & tiny);
  /* near a standing wave the surface's speed turns fast; the steps must see it turn, unless all of it touches */
  for (j = 1; j < NODES; ++j) {
    const real along = cosine * t->at[j].cos_phi + sine * t->at[j].sin_phi;
    blind = blind | (less_than(along, N_(trum_cosine)) & less_than(N_(0), most(t->e[j][FULL], t->e[j - 1][FULL])));
    cosine = t->at[j].cos_phi, sine = t->at[j].sin_phi;
  }
  blind = blind & less_than(N_(trum_sees) * l->period, l->h);
  return sel(blind, most(ratio, N_(40)), ratio);
}

#endif
