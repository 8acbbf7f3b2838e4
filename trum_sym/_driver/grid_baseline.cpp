#define LANES 2
#define GRID grid_baseline
#include "grid.inc"
