#define LANES 16
#define ORBIT orbit_avx512
#include "orbit.inc"
