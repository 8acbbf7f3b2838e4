/* What drives the sensitivities in a step, with limits where the friction's slope is infinite. */
#ifndef TRUM_ORBIT_SENSITIVITIES_H
#define TRUM_ORBIT_SENSITIVITIES_H

/* At a square root T f_v and the like are 0 times infinity: their limit, from the other nodes. */
static void trum_limits(real bend, real* K) {
  static const double outward[NODES] = TRUM_COLLOCATION_OUTWARD;
  const real first = N_(outward[1]) * K[1] + N_(outward[2]) * K[2] + N_(outward[3]) * K[3];
  const real last = N_(outward[1]) * K[2] + N_(outward[2]) * K[1] + N_(outward[3]) * K[0];
  K[0] = sel(less_than(bend, N_(0)), first, K[0]), K[EDGE] = sel(less_than(N_(0), bend), last, K[EDGE]);
}

/* The limit of T f_v where the rotor is as fast as all of the surface. */
static real trum_at_root(const trum_lanes* l, const real* e, real R_v_rate, real v, real f) {
  trum_saturation at;
  real limit;
  at.R_v = size_of(v), at.R_v_rate = R_v_rate, at.v = v, at.v_rate = l->push * f - l->drag;
  at.p_larger = e[LARGER], at.p_smaller = e[SMALLER], at.step = l->h;
  trum_lanes_friction_limit(&at, &limit);
  return limit;
}

/* T f_v at the nodes; the limits where T is 0 are exact if slopes are wanted. */
static void trum_stiffness(const trum_lanes* l, const trum_attempt* t, real* K) {
  const mask from = less_than(l->bend, N_(0)), to = less_than(N_(0), l->bend);
  const real v0 = l->v0 + t->x[0], v1 = l->v0 + t->x[EDGE];
  mask sliding, there;
  real first, last;
  int j;
  for (j = 0; j < NODES; ++j) K[j] = t->T[j] * t->f_v[j];
  trum_limits(l->bend, K);
  K[0] = least(K[0], N_(0)), K[EDGE] = least(K[EDGE], N_(0));
  if (!l->slopes) return;
  first = trum_at_root(l, t->e[0], t->by[0].R_v_rate, v0, t->f[0]);
  last = trum_at_root(l, t->e[EDGE], t->by[EDGE].R_v_rate, v1, t->f[EDGE]);
  sliding = less_than(N_(0), t->e[1][SPEED]); /* some of the surface is faster than the rotor */
  there = less_than(size_of(t->e[EDGE][SPEED]), N_(1e-6) * size_of(t->e[1][SPEED]));
  K[0] = sel(from & l->fresh[SPEED], sel(sliding, first, N_(0)), K[0]);
  K[EDGE] = sel(to & there & trum_same(l->target, N_(SPEED)), sel(sliding, last, N_(0)), K[EDGE]);
}

/* What drives the slopes of f by one thing, times T. */
static void trum_source(const trum_lanes* l, const trum_attempt* t, const real* T_f_v, int way, real* source) {
  int j;
  for (j = 0; j < NODES; ++j)
    source[j] = t->T[j] * t->by[j].f[way] - T_f_v[j] * ((l->v0 + t->x[j]) * t->by[j].ln_R_v[way]);
}

/* T theta_E at the nodes, and its limit where all of the wave begins to touch the layer. */
static void trum_widening(const trum_lanes* l, const trum_attempt* t, real* T_theta_E) {
  const mask from = less_than(l->bend, N_(0)) & l->fresh[FULL];
  const mask to = less_than(N_(0), l->bend) & trum_same(l->target, N_(FULL));
  const mask partly = less_than(N_(0), t->e[1][FULL]) & is(!l->hertz);
  int j;
  for (j = 0; j < NODES; ++j) T_theta_E[j] = t->T[j] * t->by[j].theta_E;
  for (j = 0; j < NODES; j += EDGE) {
    trum_full_contact_state at;
    real limit;
    at.W_c_rate = t->by[j].W_c_rate, at.step = l->h;
    trum_lanes_contact_limit(&l->constants, &at, &limit);
    T_theta_E[j] = sel(j == 0 ? from : to, sel(partly, limit, N_(0)), T_theta_E[j]);
  }
}

#endif
