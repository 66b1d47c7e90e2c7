// SPDX-License-Identifier: Apache-2.0
// The fluid's grid as the wind passes see it. One struct for the window and the ambient tile.
#ifndef SWARD_SHARED_WIND_GRID_H
#define SWARD_SHARED_WIND_GRID_H
#include "shared/types.h"

SHARED_BEGIN

// 64 bytes. Places in the window are metres from its north-west corner (a float holds them; the corner itself is a double).
struct WindGrid {
    ivec4 layout; // cells a side; storage place of the logical cell (0, 0) x, y; cells of ambient rim on each side (periodic: 0)
    vec4 size;    // cell (m); 1 / cell (1/m); step (s); speed that nothing exceeds (m/s)
    vec4 rates;   // confinement; viscosity (m2/s); dissipation (1/s); speed above which the air is braked (m/s)
    vec4 rim;     // width of the layer that is drawn to the ambient (cells); its rate at the rim (1/s); unused
};
#ifdef __cplusplus
static_assert(sizeof(WindGrid) == 64);
#endif

SHARED_END
#endif
