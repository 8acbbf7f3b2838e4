#define LANES 4
#define ORBIT orbit_baseline
#include "orbit.inc"
