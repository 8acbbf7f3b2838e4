#define LANES 8
#define ORBIT orbit_avx2
#include "orbit.inc"
