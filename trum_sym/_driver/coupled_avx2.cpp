#define LANES 4
#define COUPLED coupled_avx2
#include "coupled.inc"
