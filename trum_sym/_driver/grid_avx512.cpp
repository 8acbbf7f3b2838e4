#define LANES 8
#define GRID grid_avx512
#include "grid.inc"
