/* A collocation step: Newton on the nodes after the first, and the estimate of its quadrature error. */
#ifndef TRUM_ORBIT_STEP_H
#define TRUM_ORBIT_STEP_H

/* The error of a step's integral, from how fast its integrand's Legendre coefficients fall. */
static real trum_quadrature_error(const real* G) {
  static const double L[NODES][NODES] = TRUM_COLLOCATION_LEGENDRE;
  real l[NODES], whole, second, third;
  int k, j;
  for (k = 0; k < NODES; ++k) {
    l[k] = N_(L[k][0]) * G[0];
    for (j = 1; j < NODES; ++j) l[k] = l[k] + N_(L[k][j]) * G[j];
    l[k] = size_of(l[k]);
  }
  whole = l[0] + l[1] + N_(1e-37);
  second = l[2] / whole, third = cube_root_of(l[3] / whole + N_(1e-37));
  return N_(trum_estimate) * most(l[2] * second * root_of(second), l[3] * third * third);
}

/* A step that is tried: the nodes' places and rates of time, and what is there. */
typedef struct {
  trum_surface at[NODES]; /* not at the first node */
  real z[NODES], T[NODES], x[NODES], f[NODES], f_v[NODES], e[NODES][EVENTS];
  trum_changes by[NODES]; /* if slopes are wanted */
  mask open;              /* Newton has not closed */
} trum_attempt;

static mask trum_same(real a, real b) { return at_most(size_of(a - b), N_(0.25)); }

/* Collocation: x_i = x_0 + sum_j A_ij T_j (push f(x_j) - drag), by Newton on the three nodes after the first. */
static void trum_try(const trum_lanes* l, trum_attempt* t) {
  static const double A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS, c[NODES] = TRUM_COLLOCATION_POINTS;
  trum_eliminated equations;
  real G[NODES], right[NODES], y[NODES];
  int i, j, k, tries;
  for (j = 0; j < NODES; ++j) {
    const real sigma = N_(c[j]);
    t->z[j] = sigma * (N_(1) + l->bend * (N_(1) - sigma));
    t->T[j] = l->h * (N_(1) + l->bend * (N_(1) - N_(2) * sigma));
  }
  t->open = l->active;
  t->x[0] = l->x, t->f[0] = l->f, t->f_v[0] = l->f_v;
  for (k = 0; k < EVENTS; ++k) t->e[0][k] = l->event[k];
  G[0] = t->T[0] * (l->push * t->f[0] - l->drag);
  for (j = 1; j < NODES; ++j) {
    trum_look(l, l->tau + l->h * t->z[j], &t->at[j]);
    t->x[j] = l->x + l->h * t->z[j] * (l->push * l->f - l->drag);
    t->f[j] = l->f, t->f_v[j] = N_(0), t->e[j][LARGER] = N_(0), t->e[j][SMALLER] = N_(0);
  }
  for (tries = 0; tries < 12 && any(t->open); ++tries) {
    real change = N_(0), slope[NODES];
    slope[0] = N_(0);
    for (j = 1; j < NODES; ++j) {
      real f, f_v, larger, smaller;
      trum_rub(&t->at[j], l->v0 + t->x[j], &f, &f_v, &larger, &smaller);
      t->f[j] = sel(t->open, f, t->f[j]), t->f_v[j] = sel(t->open, f_v, t->f_v[j]);
      t->e[j][LARGER] = sel(t->open, larger, t->e[j][LARGER]);
      t->e[j][SMALLER] = sel(t->open, smaller, t->e[j][SMALLER]);
      G[j] = t->T[j] * (l->push * t->f[j] - l->drag);
      slope[j] = t->T[j] * (l->push * t->f_v[j]);
    }
    for (i = 1; i < NODES; ++i) {
      right[i] = l->x - t->x[i];
      for (j = 0; j < NODES; ++j) right[i] = right[i] + N_(A[i][j]) * G[j];
    }
    equations = trum_eliminate(slope);
    trum_solve(&equations, right, y);
    for (j = 1; j < NODES; ++j) { /* friction bounds how far the speed can get */
      const real drift = l->x - l->h * t->z[j] * l->drag, reach = l->h * t->z[j] * l->push;
      const real next = most(drift - reach, least(drift + reach, t->x[j] + y[j]));
      change = most(change, size_of(next - t->x[j]));
      t->f[j] = sel(t->open, t->f[j] + t->f_v[j] * (next - t->x[j]), t->f[j]);
      t->x[j] = sel(t->open, next, t->x[j]);
    }
    t->open = t->open & no(at_most(change, l->newton_error));
  }
  for (j = 1; j < NODES; ++j) {
    const real v = l->v0 + t->x[j];
    t->e[j][SPEED] = t->at[j].R_v * t->at[j].R_v - v * v;
    t->e[j][FULL] = t->at[j].W_c * t->at[j].W_c - l->constants.W_full * l->constants.W_full;
    if (l->slopes) trum_change(l, l->tau + l->h * t->z[j], &t->at[j], v, &t->by[j]);
  }
  if (l->slopes) t->by[0] = l->changes;
}

#endif
