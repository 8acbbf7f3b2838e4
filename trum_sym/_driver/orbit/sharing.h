/* Nodes side by side: where few lanes have a task, each has several nodes of its step evaluated at once, in the lanes
 * that are idle.
 *
 * The kernels are the same functions either way, and every operation acts on each lane alone, so the results are the same
 * to the last bit.  With one lane there is nothing to share. */
#ifndef TRUM_ORBIT_SHARING_H
#define TRUM_ORBIT_SHARING_H

#if TRUM_LANES > 1

/* Shares the lanes out among those that are busy, if they are not the same as before. */
static void trum_share_lanes(trum_lanes* lanes, const int* busy) {
  trum_sharing* sharing = &lanes->sharing;
  int i, place, owners = 0, first = 0, at_work = 0;
  for (i = 0; i < TRUM_LANES; ++i) owners += busy[i] != 0, at_work |= (busy[i] != 0) << i;
  if (at_work == sharing->at_work) return;
  sharing->at_work = at_work;
  sharing->places = owners ? TRUM_LANES / owners : 1;
  sharing->owner = sharing->home = lane_numbers();
  for (place = 0; place < TRUM_LANES; ++place) sharing->of_place[place] = mask_all(0);
  if (sharing->places == 1) return;
  for (i = 0; i < TRUM_LANES; ++i) {
    if (!busy[i]) continue;
    for (place = 0; place < sharing->places; ++place) {
      set_lane_number(&sharing->owner, first + place, i);
      set_lane_mask(&sharing->of_place[place], first + place, 1);
    }
    set_lane_number(&sharing->home, i, first), first += sharing->places;
  }
}

/* Puts numbers of the owners, one for each of `count` places from the first on, into the places. */
static real trum_to_places(const trum_sharing* sharing, const real* of, int count) {
  real shared = taken_from(of[0], sharing->owner);
  int place;
  for (place = 1; place < count; ++place)
    shared = where(sharing->of_place[place], taken_from(of[place], sharing->owner), shared);
  return shared;
}

/* The owners' numbers in a place. */
static real trum_from_place(const trum_sharing* sharing, real shared, int place) {
  return taken_from(shared, sharing->home + place);
}

/* The same for all members of a struct that has no others than real ones. */
#define TRUM_MEMBERS(type) ((int)(sizeof(type) / sizeof(real)))
static void trum_struct_to_places(const trum_sharing* sharing, const real* of, real* shared, int members) {
  int k;
  for (k = 0; k < members; ++k) shared[k] = taken_from(of[k], sharing->owner);
}

/* Surfaces at `count` times, as many at once as there are places. */
static void trum_share_surfaces(const trum_lanes* lanes, const real* tau, trum_surface* at, int count) {
  const trum_sharing* sharing = &lanes->sharing;
  trum_constants constants;
  trum_region region;
  trum_surface shared;
  int first, place, k;
  trum_struct_to_places(sharing, (const real*)&lanes->constants, (real*)&constants, TRUM_MEMBERS(trum_constants));
  trum_struct_to_places(sharing, (const real*)&lanes->region, (real*)&region, TRUM_MEMBERS(trum_region));
  for (first = 0; first < count; first += sharing->places) {
    const int here = count - first < sharing->places ? count - first : sharing->places;
    trum_surface_at(&constants, &region, with_hertz(lanes), trum_to_places(sharing, tau + first, here), &shared);
    for (place = 0; place < here; ++place)
      for (k = 0; k < TRUM_MEMBERS(trum_surface); ++k)
        ((real*)&at[first + place])[k] = trum_from_place(sharing, ((real*)&shared)[k], place);
  }
}

/* Surfaces of the owners, one for each of `count` places, into the places. */
static void trum_surfaces_to_places(const trum_sharing* sharing, const trum_surface* of, trum_surface* shared, int count) {
  int place, k;
  trum_struct_to_places(sharing, (const real*)of, (real*)shared, TRUM_MEMBERS(trum_surface));
  for (place = 1; place < count; ++place)
    for (k = 0; k < TRUM_MEMBERS(trum_surface); ++k)
      ((real*)shared)[k] =
          where(sharing->of_place[place], taken_from(((const real*)&of[place])[k], sharing->owner), ((real*)shared)[k]);
}

/* Friction at `count` nodes likewise. */
static void trum_share_friction(const trum_lanes* lanes, const trum_surface* at, const real* v, trum_friction_state* friction,
                                int count) {
  const trum_sharing* sharing = &lanes->sharing;
  int first, place, k;
  for (first = 0; first < count; first += sharing->places) {
    const int here = count - first < sharing->places ? count - first : sharing->places;
    trum_surface shared;
    trum_friction_state found;
    trum_surfaces_to_places(sharing, at + first, &shared, here);
    trum_friction_at(&shared, trum_to_places(sharing, v + first, here), &found);
    for (place = 0; place < here; ++place)
      for (k = 0; k < TRUM_MEMBERS(trum_friction_state); ++k)
        ((real*)&friction[first + place])[k] = trum_from_place(sharing, ((real*)&found)[k], place);
  }
}

/* How many nodes of each lane that has a task are evaluated at once. */
static int trum_places(const trum_lanes* lanes) { return lanes->sharing.places; }

#else
static void trum_share_lanes(trum_lanes* lanes, const int* busy) { (void)lanes, (void)busy; }
static int trum_places(const trum_lanes* lanes) { return (void)lanes, 1; }
#endif

/* Surface and contact at `count` times after the region's start. */
static void trum_evaluate_surfaces(const trum_lanes* lanes, const real* tau, trum_surface* at, int count) {
  int j;
#if TRUM_LANES > 1
  if (lanes->sharing.places > 1) {
    trum_share_surfaces(lanes, tau, at, count);
    return;
  }
#endif
  for (j = 0; j < count; ++j) trum_surface_at(&lanes->constants, &lanes->region, with_hertz(lanes), tau[j], &at[j]);
}

/* Friction at `count` speeds. */
static void trum_evaluate_frictions(const trum_lanes* lanes, const trum_surface* at, const real* v,
                                    trum_friction_state* friction, int count) {
  int j;
#if TRUM_LANES > 1
  if (lanes->sharing.places > 1) {
    trum_share_friction(lanes, at, v, friction, count);
    return;
  }
#endif
  (void)lanes;
  for (j = 0; j < count; ++j) trum_friction_at(&at[j], v[j], &friction[j]);
}

#endif
