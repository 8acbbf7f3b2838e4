/* Friction of a plain wave whose layer gives way along the circumference, as a brush: where its bristles stick and where
 * they slide.  Formulas live in the generated C (derivations/brush.py); here are only the order of events and their roots.
 *
 * C99 without allocation or globals, which is also C++. */
#ifndef TRUM_BRUSH_H
#define TRUM_BRUSH_H

#include "trum_kernels.h"
#include "trum_plain_calls.h"

#define TRUM_BRUSH_PI TRUM_C(3.14159265358979323846)

/* Friction's limit less the stress of a bristle that sticks, in one sense of sliding or the other. */
static inline trum_real trum_brush_gap(const trum_bristle* b, int sense, trum_real u) {
  trum_passage p;
  trum_plain_brush_passage(b, &p, u);
  return p.limit - (trum_real)sense * p.stress;
}

/* The first place after u at which something equals `at` plus whole turns. */
static inline trum_real trum_brush_next(trum_real at, trum_real u) {
  const trum_real turn = 2 * TRUM_BRUSH_PI;
  while (at > u + turn) at -= turn;
  while (at <= u) at += turn;
  return at;
}

/* Where a bristle that sticks from b->u_0 begins to slide, theta at the latest; sets the sense. */
static inline trum_real trum_brush_slides(const trum_bristle* b, const trum_turns* turns, int* sense) {
  trum_real low = b->u_0, high;
  for (;;) { /* between two of these places either gap only grows or only falls */
    int k;
    high = b->theta;
    for (k = 0; k < 4; ++k) {
      const trum_real place = (k & 1 ? turns->delay : -turns->delay) + (k & 2 ? turns->span : -turns->span);
      const trum_real next = trum_brush_next(place, low);
      if (next < high) high = next;
    }
    *sense = trum_brush_gap(b, 1, high) < trum_brush_gap(b, -1, high) ? 1 : -1;
    if (!(high < b->theta) || trum_brush_gap(b, *sense, high) < 0) break;
    low = high;
  }
  for (;;) {
    const trum_real middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) return high;
    if (trum_brush_gap(b, *sense, middle) < 0) high = middle;
    else low = middle;
  }
}

/* Net friction over the most that friction can carry, of a contact |u| < theta < pi, at a rotor's speed over the surface's
 * greatest; between -1 and 1, falling with the speed.  NaN where the whole wave touches: no bristle then leaves. */
static inline trum_real trum_brush_friction(trum_real theta, trum_real grip, trum_real ratio) {
  trum_bristle b;
  trum_turns turns;
  trum_passage p;
  trum_real sum = 0, all, end;
  int sense = 0, k;
  if (!(theta > 0 && theta < TRUM_BRUSH_PI && grip > 0 && ratio - ratio == 0)) return TRUM_NAN;
  b.theta = theta, b.grip = grip, b.ratio = ratio, b.u_0 = -theta, b.t_0 = 0;
  trum_plain_brush_passage(&b, &p, theta);
  all = p.slid;
  trum_plain_brush_turns(&b, &turns);
  if (!(turns.span > 0)) return -1;
  if (!(turns.span < TRUM_BRUSH_PI)) return 1;
  if (trum_cos(turns.delay + theta) > trum_cos(turns.span)) sense = 1;
  else if (trum_cos(turns.delay - theta) < trum_cos(turns.span)) sense = -1;
  for (k = 0; k < 16 && b.u_0 < theta; ++k) {
    if (sense == 0) {
      end = trum_brush_slides(&b, &turns, &sense);
      trum_plain_brush_passage(&b, &p, end);
      sum += p.stuck;
    } else {
      end = trum_brush_next((trum_real)sense * (turns.delay + turns.span), b.u_0);
      if (end > theta) end = theta;
      trum_plain_brush_passage(&b, &p, end);
      sum += (trum_real)sense * p.slid;
      b.t_0 = (trum_real)sense * p.limit, sense = 0;
    }
    b.u_0 = end;
  }
  return sum / all;
}

/* The least speed over the surface's greatest from which on no bristle sticks. */
static inline trum_real trum_brush_fastest(trum_real grip) { return trum_sqrt(1 + 1 / (grip * grip)); }

/* Speed of the rotor over the surface's greatest at which a brush carries a friction fraction between -1 and 1. */
static inline trum_real trum_brush_speed(trum_real theta, trum_real grip, trum_real fraction) {
  const trum_real most = trum_brush_fastest(grip);
  trum_real low = -most, high = most;
  if (!(fraction > -1 && fraction < 1) || !(trum_brush_friction(theta, grip, 0) <= 1)) return TRUM_NAN;
  for (;;) {
    const trum_real middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) return middle;
    if (trum_brush_friction(theta, grip, middle) < fraction) high = middle;
    else low = middle;
  }
}

/* Bound of what rounding does to a friction fraction: the more the grip, the shorter the ways on which bristles stick. */
static inline trum_real trum_brush_rounding(trum_real grip) {
  const trum_real unit = TRUM_EITHER(2.2e-16, 1.2e-7);
  return 500 * unit * trum_sqrt(1 + grip);
}

/* And to that speed: how far it moves where the fraction does by as much. */
static inline trum_real trum_brush_speed_error(trum_real theta, trum_real grip, trum_real fraction, trum_real speed) {
  const trum_real by = trum_brush_rounding(grip), most = trum_brush_fastest(grip);
  const trum_real slower = fraction + by < 1 ? trum_brush_speed(theta, grip, fraction + by) : -most;
  const trum_real faster = fraction - by > -1 ? trum_brush_speed(theta, grip, fraction - by) : most;
  return (speed - slower > faster - speed ? speed - slower : faster - speed) + by / 100;
}

#endif
