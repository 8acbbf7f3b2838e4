/* Events: instants where the right-hand side is not smooth, located on cubics through the nodes of a step.
 *
 * Saturation: the rotor as fast as the surface's fastest point, R_v^2 = v^2; f has a square root in time.  Edges: one
 * of the two points as fast as the rotor crosses the edge of the contact, its pressure is zero; f has a kink.  Full
 * contact: W_c = W_full, the whole wave begins to touch; the half-angle has a square root. */
#ifndef TRUM_ORBIT_EVENTS_H
#define TRUM_ORBIT_EVENTS_H

/* The cubic through (0, e0), (z1, e1), (z2, e2), (1, e3). */
typedef struct {
  real e0, d1, d2, d3, z1, z2;
} trum_cubic;

/* Reciprocals of the distances between the nodes, the same for all cubics of a step. */
typedef struct {
  real z1, z2, of_01, of_12, of_23, of_02, of_13;
} trum_node_distances;

/* Distances of the nodes at 0, z[1], z[2], 1. */
static trum_node_distances trum_distances_of(const real* z) {
  trum_node_distances s;
  s.z1 = z[1], s.z2 = z[2];
  s.of_01 = reciprocal(z[1]), s.of_12 = reciprocal(z[2] - z[1]), s.of_23 = reciprocal(REAL(1) - z[2]);
  s.of_02 = reciprocal(z[2]), s.of_13 = reciprocal(REAL(1) - z[1]);
  return s;
}

/* The cubic through values at the nodes, by divided differences. */
static trum_cubic trum_interpolate(const trum_node_distances* s, real e0, real e1, real e2, real e3) {
  trum_cubic c;
  const real d01 = (e1 - e0) * s->of_01, d12 = (e2 - e1) * s->of_12, d23 = (e3 - e2) * s->of_23;
  const real d012 = (d12 - d01) * s->of_02, d123 = (d23 - d12) * s->of_13;
  c.e0 = e0, c.d1 = d01, c.d2 = d012, c.d3 = d123 - d012, c.z1 = s->z1, c.z2 = s->z2;
  return c;
}

/* A cubic's value at z. */
static real trum_cubic_at(const trum_cubic* c, real z) {
  return c->e0 + z * (c->d1 + (z - c->z1) * (c->d2 + (z - c->z2) * c->d3));
}

/* Its derivative at z. */
static real trum_cubic_slope(const trum_cubic* c, real z) {
  const real inner = c->d2 + (z - c->z2) * c->d3;
  return c->d1 + (z - c->z1) * inner + z * (inner + (z - c->z1) * c->d3);
}

/* Where the cubic times `side`, 1 or -1, has its minimum; -1 if it has none. */
static real trum_cubic_minimum(const trum_cubic* c, real side) {
  const real c3 = side * c->d3, c2 = side * (c->d2 - (c->z1 + c->z2) * c->d3);
  const real c1 = side * (c->d1 - c->z1 * (c->d2 - c->z2 * c->d3)), square = c2 * c2 - REAL(3) * c1 * c3;
  const real below = c2 + square_root(maximum(square, REAL(0)));
  const mask exists = less_than(REAL(0), square) & less_than(REAL(TRUM_EITHER(1e-300, 1e-37)), absolute(below));
  return where(exists, -c1 * reciprocal(where(exists, below, REAL(1))), REAL(-1));
}

/* Where an event function leaves the side on which it begins: between two nodes, or at its lowest point between them
 * (highest, if it begins negative). */
typedef struct {
  real from, to;
  mask found;
} trum_crossing;

/* Looks for a crossing of the cubic through e at the nodes z.  Where the step starts at the event, e begins at 0 but for
 * noise: the crossing is between later nodes then; or if saturation begins or ends for a moment that is over before the
 * second node, between its extremum and that node. */
static trum_crossing trum_find_crossing(const trum_cubic* c, const real* z, real (*e)[EVENT_COUNT], int k, mask starts_here) {
  const mask positive = less_than(REAL(0), where(starts_here, e[1][k], e[0][k]));
  trum_crossing crossing;
  int j;
  crossing.found = mask_all(0), crossing.from = crossing.to = REAL(0);
  for (j = 1; j < NODES; ++j) {
    const mask crossed = mask_not(crossing.found) & (less_than(REAL(0), e[j][k]) ^ positive);
    crossing.from = where(crossed, z[j - 1], crossing.from), crossing.to = where(crossed, z[j], crossing.to);
    crossing.found = crossing.found | crossed;
  }
  { /* a double crossing between two nodes: look at the cubic's minimum (maximum, if it begins negative) */
    const real side = where(positive, REAL(1), REAL(-1)), lowest = trum_cubic_minimum(c, side);
    const real noise = REAL(8) * absolute(c->e0) + REAL(100 * trum_unit) * absolute(e[1][k]);
    const real begin = where(starts_here, z[1], REAL(0));
    const mask early = starts_here & less_than(lowest, begin);
    const mask between = less_than(k == EVENT_SATURATION ? REAL(0) : begin, lowest) &
                         less_than(lowest, where(crossing.found, crossing.to, REAL(1)));
    const mask crossed = between & at_most(side * trum_cubic_at(c, lowest), where(early, -noise, REAL(0)));
    crossing.from = where(crossed, where(early, lowest, begin), crossing.from);
    crossing.to = where(crossed, where(early, z[1], lowest), crossing.to);
    crossing.found = crossing.found | crossed;
  }
  return crossing;
}

/* The first event in a step: its location in lengths of the step (2 if there is none) and its number.  Where friction
 * is saturated no point is as fast as the rotor, so there are no edges to cross. */
static void trum_locate_first_event(const trum_lanes* lanes, const real* z, real (*e)[EVENT_COUNT], trum_cubic* cubic,
                                    real* location, real* event) {
  const trum_node_distances distances = trum_distances_of(z);
  const mask saturated =
      at_most(where(lanes->start.at_event[EVENT_SATURATION], e[1][EVENT_SATURATION], e[0][EVENT_SATURATION]), REAL(0));
  trum_crossing crossing[EVENT_COUNT];
  real root[EVENT_COUNT];
  mask any = mask_all(0);
  int k, j;
  for (k = 0; k < EVENT_COUNT; ++k) {
    cubic[k] = trum_interpolate(&distances, e[0][k], e[1][k], e[2][k], e[LAST_NODE][k]);
    crossing[k] = trum_find_crossing(&cubic[k], z, e, k, lanes->start.at_event[k]);
    if (k == EVENT_LARGER_PRESSURE || k == EVENT_SMALLER_PRESSURE)
      crossing[k].found = crossing[k].found & mask_not(saturated);
    if (k != EVENT_FULL_CONTACT) crossing[k].found = crossing[k].found & mask_not(lanes->status.contact_only);
    any = any | crossing[k].found;
  }
  *location = REAL(2), *event = REAL(-1);
  if (!any_lane(any & lanes->status.active)) return;
  for (k = 0; k < EVENT_COUNT; ++k) {
    const real from = crossing[k].from, to = crossing[k].to;
    const real at_from = trum_cubic_at(&cubic[k], from), at_to = trum_cubic_at(&cubic[k], to);
    const mask bracket = less_than(at_from * at_to, REAL(0));
    root[k] = from + (to - from) * (at_from * reciprocal(where(bracket, at_from - at_to, REAL(1))));
    root[k] = where(bracket, root[k], from);
  }
  for (j = 0; j < 3; ++j)
    for (k = 0; k < EVENT_COUNT; ++k) { /* innermost, as the events do not wait for each other */
      const real slope = trum_cubic_slope(&cubic[k], root[k]);
      const mask usable = less_than(REAL(trum_no_slope), absolute(slope));
      root[k] = where(usable, root[k] - trum_cubic_at(&cubic[k], root[k]) * reciprocal(where(usable, slope, REAL(1))), root[k]);
      root[k] = maximum(crossing[k].from, minimum(crossing[k].to, root[k]));
    }
  for (k = 0; k < EVENT_COUNT; ++k) {
    const mask earlier = crossing[k].found & less_than(root[k], *location);
    *location = where(earlier, root[k], *location), *event = where(earlier, REAL(k), *event);
  }
}

#endif
