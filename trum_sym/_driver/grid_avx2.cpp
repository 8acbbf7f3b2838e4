#define LANES 4
#define GRID grid_avx2
#include "grid.inc"
