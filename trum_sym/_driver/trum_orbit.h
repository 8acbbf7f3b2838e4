/* The rotor's periodic orbit: time steps, laps of the drive cycle, and the search for the lap that repeats itself.
 *
 * C99 without allocation or globals, which is also C++: with TRUM_LANES defined, `real` is a class of that many
 * points side by side and `mask` their truth values; else `real` is a plain number and there is one lane.  Every
 * operation acts on each lane alone, so a point's results do not depend on its neighbours or on their number.
 *
 * The rim's speed obeys v' = push f(v, t) - drag, and f falls as v rises.  Where v(t) meets the surface's fastest
 * point, f has a square root in time; where a point of equal speed crosses the edge of the contact, f has a kink.
 * Steps end at those events, and next to a square root the time in a step runs as the square of its parameter,
 * where everything is smooth again.  Between events a step is collocation at Lobatto's nodes.  The speed at which a lap
 * of the drive cycle ends where it began is found by shooting: Newton on the start speed.  A step's defect at nodes that
 * the collocation does not use tells what the lap is off by; the figures' bounds rest on that (bounds.h).
 *
 * One concern a header, in the order in which they need each other; orbit/types.h has a glossary. */
#ifndef TRUM_ORBIT_H
#define TRUM_ORBIT_H
#include "trum_fixed_grid.h"
#include "trum_kernels.h" /* which refuses arithmetic without NaN */

#include "orbit/number.h"
#include "orbit/types.h"
#include "orbit/constants.h"
#include "orbit/surface.h"
#include "orbit/sharing.h"
#include "orbit/derivatives.h"
#include "orbit/collocation.h"
#include "orbit/events.h"
#include "orbit/lap_start.h"
#include "orbit/history.h"
#include "orbit/step.h"
#include "orbit/event_steps.h"
#include "orbit/sensitivities.h"
#include "orbit/defect.h"
#include "orbit/extremes.h"
#include "orbit/error.h"
#include "orbit/accept.h"
#include "orbit/repeat.h"
#include "orbit/lap.h"
#include "orbit/segments.h"
#include "orbit/bounds.h"
#include "orbit/figure_slopes.h"
#include "orbit/shooting.h"
#include "orbit/balance.h"
#include "orbit/task.h"
#include "orbit/coarse.h"
#include "orbit/run.h"

#undef REAL
#endif
