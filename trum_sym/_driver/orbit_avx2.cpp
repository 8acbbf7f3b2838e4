#define LANES 4
#define ORBIT orbit_avx2
#include "orbit.inc"
