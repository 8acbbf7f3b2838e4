/* Events: instants where the right-hand side is not smooth, located on cubics through the nodes of a step.
 *
 * The rotor as fast as the surface's fastest point (square root in time), a point of equal speed at the edge of the
 * contact (kink), the whole wave in contact (square root of the half-angle). */
#ifndef TRUM_ORBIT_EVENTS_H
#define TRUM_ORBIT_EVENTS_H

/* The cubic through (0, e0), (z1, e1), (z2, e2), (1, e3). */
typedef struct {
  real e0, d1, d2, d3, z1, z2;
} trum_cubic;

/* Reciprocals of the distances of the nodes, which all cubics of a step share. */
typedef struct {
  real z1, z2, of_01, of_12, of_23, of_02, of_13;
} trum_places;

static trum_places trum_space(const real* z) {
  trum_places s;
  s.z1 = z[1], s.z2 = z[2];
  s.of_01 = inverse_of(z[1]), s.of_12 = inverse_of(z[2] - z[1]), s.of_23 = inverse_of(N_(1) - z[2]);
  s.of_02 = inverse_of(z[2]), s.of_13 = inverse_of(N_(1) - z[1]);
  return s;
}

static trum_cubic trum_through(const trum_places* s, real e0, real e1, real e2, real e3) {
  trum_cubic c;
  const real d01 = (e1 - e0) * s->of_01, d12 = (e2 - e1) * s->of_12, d23 = (e3 - e2) * s->of_23;
  const real d012 = (d12 - d01) * s->of_02, d123 = (d23 - d12) * s->of_13;
  c.e0 = e0, c.d1 = d01, c.d2 = d012, c.d3 = d123 - d012, c.z1 = s->z1, c.z2 = s->z2;
  return c;
}

static real trum_cubic_at(const trum_cubic* c, real z) {
  return c->e0 + z * (c->d1 + (z - c->z1) * (c->d2 + (z - c->z2) * c->d3));
}

static real trum_cubic_slope(const trum_cubic* c, real z) {
  const real inner = c->d2 + (z - c->z2) * c->d3;
  return c->d1 + (z - c->z1) * inner + z * (inner + (z - c->z1) * c->d3);
}

/* Where the step first meets an event: its place, 2 if none, and which.  Saturated friction has no edges to cross. */
static void trum_first_event(const trum_lanes* l, const real* z, real (*e)[EVENTS], trum_cubic* cubic, real* place,
                             real* which) {
  const trum_places spaces = trum_space(z);
  const mask saturated = at_most(sel(l->fresh[SPEED], e[1][SPEED], e[0][SPEED]), N_(0));
  int k, j;
  *place = N_(2), *which = N_(-1);
  for (k = 0; k < EVENTS; ++k) {
    const mask fresh = l->fresh[k], positive = less_than(N_(0), sel(fresh, e[1][k], e[0][k]));
    const trum_cubic c = cubic[k] = trum_through(&spaces, e[0][k], e[1][k], e[2][k], e[EDGE][k]);
    mask found = is(0);
    real from = N_(0), to = N_(0), root;
    for (j = 1; j < NODES; ++j) {
      const mask crossed = no(found) & (less_than(N_(0), e[j][k]) ^ positive);
      from = sel(crossed, z[j - 1], from), to = sel(crossed, z[j], to), found = found | crossed;
    }
    { /* it may cross and turn back between two nodes, where the cubic is lowest (highest, if it begins negative) */
      const real side = sel(positive, N_(1), N_(-1));
      const real c3 = side * c.d3, c2 = side * (c.d2 - (c.z1 + c.z2) * c.d3);
      const real c1 = side * (c.d1 - c.z1 * (c.d2 - c.z2 * c.d3)), square = c2 * c2 - N_(3) * c1 * c3;
      const real below = c2 + root_of(most(square, N_(0)));
      const mask bowl = less_than(N_(0), square) & less_than(N_(1e-300), size_of(below));
      const real lowest = sel(bowl, -c1 * inverse_of(sel(bowl, below, N_(1))), N_(-1));
      const real begin = sel(fresh, z[1], N_(0));
      const mask inside = bowl & less_than(begin, lowest) & less_than(lowest, sel(found, to, N_(1)));
      const mask crossed = inside & at_most(side * trum_cubic_at(&c, lowest), N_(0));
      from = sel(crossed, begin, from), to = sel(crossed, lowest, to), found = found | crossed;
    }
    if (k == LARGER || k == SMALLER) found = found & no(saturated);
    if (k != FULL) found = found & no(l->contact);
    if (!any(found & l->active)) continue;
    {
      const real at_from = trum_cubic_at(&c, from), at_to = trum_cubic_at(&c, to);
      const mask bracket = less_than(at_from * at_to, N_(0));
      root = from + (to - from) * (at_from * inverse_of(sel(bracket, at_from - at_to, N_(1))));
      root = sel(bracket, root, from);
    }
    for (j = 0; j < 3; ++j) {
      const real slope = trum_cubic_slope(&c, root);
      const mask steep = less_than(N_(1e-200), size_of(slope));
      root = sel(steep, root - trum_cubic_at(&c, root) * inverse_of(sel(steep, slope, N_(1))), root);
      root = most(from, least(to, root));
    }
    {
      const mask earlier = found & less_than(root, *place);
      *place = sel(earlier, root, *place), *which = sel(earlier, N_(k), *which);
    }
  }
}

#endif
