#define LANES 8
#define COUPLED coupled_avx512
#include "coupled.inc"
