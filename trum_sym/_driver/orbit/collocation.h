/* Linear equations of a collocation step at Lobatto's four nodes.
 *
 * The first node is the step's start, so three unknowns are left: Gaussian elimination without pivoting, as K <= 0
 * (friction falls as the speed rises).  In a damped step K_0 y_0 is what the other nodes extrapolate to. */
#ifndef TRUM_ORBIT_COLLOCATION_H
#define TRUM_ORBIT_COLLOCATION_H

/* Factors of the matrix of y_i = right_i + sum_j A_ij K_j y_j over the nodes after the first. */
typedef struct {
  real first, second, third, t_1, t_2, t_21, M_01, M_02, M_12;
} trum_factors;

/* Eliminates the matrix for K = T df/dx at the nodes. */
/* Extrapolates the other nodes' values to the first node. */
static real trum_extrapolate_first(const real* y) {
  static const trum_real outward[NODES] = TRUM_COLLOCATION_OUTWARD;
  return REAL(outward[1]) * y[1] + REAL(outward[2]) * y[2] + REAL(outward[3]) * y[3];
}

static trum_factors trum_factorise(const real* K, mask damped) {
  static const trum_real A[NODES][NODES] = TRUM_COLLOCATION_INTEGRALS, outward[NODES] = TRUM_COLLOCATION_OUTWARD;
  const real first = where(damped, REAL(1), REAL(0));
  trum_factors e;
  real M[3][3];
  int i, j;
  for (i = 0; i < 3; ++i)
    for (j = 0; j < 3; ++j)
      M[i][j] = REAL(i == j ? 1 : 0) - (REAL(A[i + 1][j + 1]) + first * REAL(A[i + 1][0] * outward[j + 1])) * K[j + 1];
  e.first = reciprocal(M[0][0]);
  e.t_1 = M[1][0] * e.first, e.t_2 = M[2][0] * e.first;
  M[1][1] = M[1][1] - e.t_1 * M[0][1], M[1][2] = M[1][2] - e.t_1 * M[0][2];
  M[2][1] = M[2][1] - e.t_2 * M[0][1], M[2][2] = M[2][2] - e.t_2 * M[0][2];
  e.second = reciprocal(M[1][1]);
  e.t_21 = M[2][1] * e.second;
  e.third = reciprocal(M[2][2] - e.t_21 * M[1][2]);
  e.M_01 = M[0][1], e.M_02 = M[0][2], e.M_12 = M[1][2];
  return e;
}

/* Solves for y[1] to y[3]. */
static void trum_substitute(const trum_factors* e, const real* right, real* y) {
  const real b_1 = right[2] - e->t_1 * right[1], b_2 = right[3] - e->t_2 * right[1];
  y[3] = (b_2 - e->t_21 * b_1) * e->third;
  y[2] = (b_1 - e->M_12 * y[3]) * e->second;
  y[1] = (right[1] - e->M_01 * y[2] - e->M_02 * y[3]) * e->first;
}

#endif
