/* Accepting a step: the sums of its lap, the sensitivities, the length of the next. */
#ifndef TRUM_ORBIT_ACCEPT_H
#define TRUM_ORBIT_ACCEPT_H

/* The step's slopes: the derivative of the collocation, with its Jacobian K, driven by how friction changes. */
static void trum_take_slopes(trum_lanes* l, const trum_attempt* t, const real* T_f_v, const real* K,
                             const trum_eliminated* equations, mask accepted, real (*d)[NODES]) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  const real per_frequency = N_(-1) / (l->constants.omega_n + l->constants.Delta_omega); /* d ln (drive period) */
  trum_lap* r = &l->lap;
  real source[NODES], T_theta_E[NODES], right[NODES];
  int i, j, way;
  trum_widening(l, t, T_theta_E);
  for (way = 0; way < TRUM_SLOPE_PARAMETERS_COUNT; ++way) {
    real sum_x = N_(0), sum_xx = N_(0), sum_f = N_(0), sum_theta = N_(0);
    trum_source(l, t, T_f_v, way, source);
    for (j = 0; j < NODES; ++j) {
      const real b = N_(A[EDGE][j]);
      sum_f = sum_f + b * source[j], sum_theta = sum_theta + b * (T_theta_E[j] * t->by[j].ln_E[way]);
      source[j] = l->push * source[j];
      if (way == TRUM_BY_PREPRESSURE || way == TRUM_BY_FRICTION) source[j] = source[j] + t->T[j] * (l->push * t->f[j]);
      if (way == TRUM_BY_DRAG) source[j] = source[j] - t->T[j];
      if (way == TRUM_BY_DIFFERENCE || way == TRUM_BY_RESONANCE)
        source[j] = source[j] + t->T[j] * ((l->push * t->f[j] - l->drag) * per_frequency);
    }
    d[way][0] = l->d[way];
    for (i = 1; i < NODES; ++i) {
      right[i] = l->d[way] * (N_(1) + N_(A[i][0]) * K[0]);
      for (j = 0; j < NODES; ++j) right[i] = right[i] + N_(A[i][j]) * source[j];
    }
    trum_solve(equations, right, d[way]);
    for (j = 0; j < NODES; ++j) {
      const real b = N_(A[EDGE][j]) * t->T[j];
      sum_x = sum_x + b * d[way][j], sum_xx = sum_xx + b * (t->x[j] * d[way][j]);
    }
    r->d_x[way] = sel(accepted, r->d_x[way] + sum_x, r->d_x[way]);
    r->d_xx[way] = sel(accepted, r->d_xx[way] + sum_xx, r->d_xx[way]);
    r->d_friction[way] = sel(accepted, r->d_friction[way] + sum_f, r->d_friction[way]);
    r->size_f[way] = sel(accepted, r->size_f[way] + size_of(sum_f), r->size_f[way]);
    r->size_angle[way] = sel(accepted, r->size_angle[way] + size_of(sum_theta), r->size_angle[way]);
    r->d_angle[way] = sel(accepted, r->d_angle[way] + sum_theta, r->d_angle[way]);
    l->d[way] = sel(accepted, d[way][EDGE], l->d[way]);
  }
  trum_keep(&l->changes, &t->by[EDGE], accepted);
}

/* Accepted lanes take their step. */
static void trum_take(trum_lanes* l, const trum_attempt* t, mask accepted, real error) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS;
  const mask held = at_most(l->push, N_(0));
  trum_lap* r = &l->lap;
  trum_eliminated equations;
  real S[NODES], T_f_v[NODES], K[NODES], rate[NODES], right[NODES], d[TRUM_SLOPE_PARAMETERS_COUNT][NODES];
  real sum_f = N_(0), sum_theta = N_(0), sum_x = N_(0), sum_xx = N_(0), sum_S = N_(0), sum_xS = N_(0);
  int i, j, k;
  for (j = 0; j < NODES; ++j) rate[j] = t->T[j] * (l->push * t->f[j] - l->drag);
  trum_stiffness(l, t, T_f_v);
  for (j = 0; j < NODES; ++j) K[j] = l->push * T_f_v[j];
  S[0] = l->S;
  for (i = 1; i < NODES; ++i) right[i] = l->S * (N_(1) + N_(A[i][0]) * K[0]);
  equations = trum_eliminate(K);
  trum_solve(&equations, right, S);
  for (j = 1; j < NODES; ++j) S[j] = most(N_(0), least(l->S, S[j])); /* friction never drives speeds apart */
  for (j = 0; j < NODES; ++j) {
    const real b = N_(A[EDGE][j]) * t->T[j];
    sum_f = sum_f + b * t->f[j], sum_theta = sum_theta + b * (j == 0 ? l->theta : t->at[j].theta);
    sum_x = sum_x + b * t->x[j], sum_xx = sum_xx + b * (t->x[j] * t->x[j]);
    sum_S = sum_S + b * S[j], sum_xS = sum_xS + b * (t->x[j] * S[j]);
  }
  if (l->slopes) trum_take_slopes(l, t, T_f_v, K, &equations, accepted, d);
  trum_extremes(rate, t->x, S, d, l->slopes, accepted & no(held), r);
  for (j = 1; j < NODES; ++j) {
    r->fastest = sel(accepted, most(r->fastest, t->at[j].R_v), r->fastest);
    r->full = sel(accepted & at_most(t->at[j].W_c, l->constants.W_full), N_(1), r->full);
  }
  r->friction = sel(accepted, r->friction + sum_f, r->friction);
  r->angle = sel(accepted, r->angle + sum_theta, r->angle);
  r->x = sel(accepted, r->x + sum_x, r->x), r->xx = sel(accepted, r->xx + sum_xx, r->xx);
  r->S = sel(accepted, r->S + sum_S, r->S), r->xS = sel(accepted, r->xS + sum_xS, r->xS);
  r->error = sel(accepted, r->error + error, r->error);
  if (l->record && in_lane(accepted, 0)) trum_write(l->record, l, rate);
  l->x = sel(accepted, t->x[EDGE], l->x), l->S = sel(accepted, S[EDGE], l->S);
  l->f = sel(accepted, t->f[EDGE], l->f), l->f_v = sel(accepted, t->f_v[EDGE], l->f_v);
  l->theta = sel(accepted, t->at[EDGE].theta, l->theta);
  l->cos_phi = sel(accepted, t->at[EDGE].cos_phi, l->cos_phi);
  l->sin_phi = sel(accepted, t->at[EDGE].sin_phi, l->sin_phi);
  for (k = 0; k < EVENTS; ++k) l->event[k] = sel(accepted, t->e[EDGE][k], l->event[k]);
}

/* Where the square root of an event is that a plain step ends short of, in step lengths, or 2 if far. */
static real trum_near_root(const trum_lanes* l, const trum_attempt* t, int event) {
  const trum_places spaces = trum_space(t->z);
  const trum_cubic c = trum_through(&spaces, t->e[0][event], t->e[1][event], t->e[2][event], t->e[EDGE][event]);
  const mask plain = at_most(size_of(l->bend), N_(0)) & less_than(N_(0), c.e0);
  real root = N_(1);
  int j;
  for (j = 0; j < 3; ++j) {
    const real slope = trum_cubic_slope(&c, root);
    const mask falling = less_than(slope, N_(-1e-200));
    root = sel(falling, root - trum_cubic_at(&c, root) * inverse_of(sel(falling, slope, N_(1))), N_(2));
    root = most(N_(0), least(N_(2), root));
  }
  return sel(plain & less_than(N_(1), root) & less_than(root, N_(1.5)) & less_than(l->h * root, l->left), root, N_(2));
}

/* A step with slopes that ends short of a square root is better aimed at it than made shorter or taken: slopes feel it
 * from afar. */
static mask trum_feel(const trum_lanes* l, const trum_attempt* t, mask accepted, mask shrink, trum_plan* p) {
  const mask unseen = accepted & no(less_than(N_(trum_feels) * l->period, l->h));
  const mask held = at_most(l->push, N_(0)), missed = shrink & less_than(N_(0), l->bend);
  const real speed = sel(held, N_(2), trum_near_root(l, t, SPEED)), full = trum_near_root(l, t, FULL);
  const real root = least(speed, full);
  const mask near_root = (shrink | unseen) & less_than(root, N_(2));
  p->h = sel(near_root, l->h * root, sel(missed, least(p->h, N_(0.5) * l->h), p->h));
  p->target = sel(near_root, sel(less_than(full, speed), N_(FULL), N_(SPEED)), p->target);
  p->bend = sel(near_root, N_(1), p->bend);
  return near_root;
}

/* Tries a step on all lanes; returns those which took it. */
static mask trum_step(trum_lanes* l) {
  const mask tiny = at_most(l->h, N_(trum_shortest) * l->period);
  trum_attempt t;
  trum_plan p;
  real ratio, error, factor;
  mask wrong, accepted, shrink;
  int k;
  trum_try(l, &t);
  p = trum_aim(l, &t, tiny);
  ratio = trum_ratio(l, &t, tiny, &error);
  wrong = no(at_most(ratio, N_(1))) & no(tiny);
  factor = N_(trum_margin) * inverse_of(root_of(root_of(most(ratio, N_(1e-5)))));
  factor = least(N_(trum_grows), most(N_(0.15), factor));
  accepted = l->active & no(p.redo) & no(wrong), shrink = wrong & no(p.redo);
  p.h = sel(shrink, l->h * factor, p.h), l->natural = sel(shrink, p.h, l->natural);
  p.target = sel(shrink, N_(-1), p.target);
  p.bend = sel(shrink & less_than(N_(0), p.bend), N_(0), p.bend);
  if (l->slopes) accepted = accepted & no(trum_feel(l, &t, accepted, shrink, &p));
  l->tries = sel(p.redo, l->tries + N_(1), sel(accepted, N_(0), l->tries));
  if (any(accepted)) {
    const real longest = N_(trum_longest) * l->period, grown = least(longest, l->h * factor);
    const mask finished = accepted & at_most(l->left, l->h * N_(1.0000001)), cut = finished | at_most(N_(0), l->target);
    trum_take(l, &t, accepted, error);
    /* a step that an event or a region's end has cut short says nothing against the length before */
    l->natural = sel(accepted, sel(cut, least(longest, most(l->natural, grown)), grown), l->natural);
    l->tau = sel(accepted, l->tau + l->h, l->tau);
    l->left = sel(accepted, sel(finished, N_(0), l->left - l->h), l->left);
    p.h = sel(accepted, l->natural, p.h);
    p.bend = sel(accepted, N_(0), p.bend);
    for (k = 0; k < EVENTS; ++k) {
      const mask mine = p.hit & trum_same(l->target, N_(k));
      l->fresh[k] = sel_mask(accepted, mine, l->fresh[k]);
      if (k == SPEED || k == FULL) p.bend = sel(accepted & mine, N_(-1), p.bend);
    }
    p.target = sel(accepted, N_(-1), p.target);
  }
  l->h = least(p.h, l->left), l->bend = p.bend, l->target = p.target;
  l->patience = l->patience - N_(1);
  return accepted;
}

#endif
