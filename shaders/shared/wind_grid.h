// SPDX-License-Identifier: Apache-2.0
// The fluid's grid as the wind passes see it. One struct for the window and the ambient tile.
#ifndef SWARD_SHARED_WIND_GRID_H
#define SWARD_SHARED_WIND_GRID_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kMaxWindLevels = 10;
SHARED_CONST float kWindCeiling_ms = 200.0f; // no air is faster, whatever pushes it

// Places in the window are metres from its north-west corner (a float holds them; the corner itself is a double).
struct WindGrid {
    ivec4 plan;   // cells a side; storage place of the logical cell (0, 0) x, y; 1 where solids stand in the grid
    ivec4 inner;  // first solved cell on both axes, solved cells a side (the rest is ambient rim); levels; unused
    vec4 size;    // cell (m); 1 / cell (1/m); step (s); step / cell (s/m)
    vec4 rates;   // confinement; viscosity * step / cell^2; 1 / (1 + dissipation * step); speed above which air is braked (m/s)
    vec4 mean;    // mean wind x, z (m/s), which dissipation leaves; width of the layer that is drawn to the ambient wind
                  // (cells); share of the difference that a step takes at the rim
    ivec4 level_plan[kMaxWindLevels]; // multigrid level: cells a side; row length; first element; unused
    ivec4 level_shift[kMaxWindLevels];  // storage place of its cell (0, 0) x, y; unused
};
#ifdef __cplusplus
static_assert(sizeof(WindGrid) == 80 + 2 * 160);
#endif

SHARED_END
#endif
