#define LANES 2
#define ORBIT orbit_baseline
#include "orbit.inc"
