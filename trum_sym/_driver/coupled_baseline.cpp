#define LANES 2
#define COUPLED coupled_baseline
#include "coupled.inc"
