#define LANES 8
#define ORBIT orbit_avx512
#include "orbit.inc"
