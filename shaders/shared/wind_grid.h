// SPDX-License-Identifier: Apache-2.0
// The fluid's grid as the wind passes see it. One struct for the window and the ambient tile.
#ifndef SWARD_SHARED_WIND_GRID_H
#define SWARD_SHARED_WIND_GRID_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kMaxWindLevels = 10;
SHARED_CONST float kWindCeiling_mps = 200.0f; // no air is faster, whatever pushes it

// Places in the window are metres from its north-west corner (a float holds them; the corner itself
// is a double). A level of the multigrid. 32 bytes.
struct WindLevel {
    ivec2 stored;                     // storage place of its cell (0, 0) x, y
    int cells;                        // a side
    int row;                          // elements
    int first;                        // element
    int unused_a, unused_b, unused_c; // to 32 bytes
};

struct WindGrid {
    ivec2 stored;    // storage place of the logical cell (0, 0) x, y
    int cells;       // a side
    int has_solids;  // 1 where solids stand in the grid
    int inner_first; // first solved cell on both axes
    int inner_cells; // solved cells a side; the rest is ambient rim
    int level_count;
    float cell_m;
    float per_m; // 1 / cell
    float step_s;
    float step_per_m; // step / cell (s/m)
    float confinement;
    float diffusion; // viscosity * step / cell^2
    float kept;      // 1 / (1 + dissipation * step)
    float brake_mps; // speed above which air is braked
    float rim_cells; // width of the layer that is drawn to the ambient wind
    vec2 mean;       // mean wind x, z (m/s), which dissipation leaves
    float rim_share; // of the difference that a step takes at the rim
    float unused;    // to 16 bytes
    WindLevel levels[kMaxWindLevels];
};
#ifdef __cplusplus
static_assert(sizeof(WindLevel) == 32 && sizeof(WindGrid) == 80 + 32 * kMaxWindLevels);
#endif

SHARED_END
#endif
