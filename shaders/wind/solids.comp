// SPDX-License-Identifier: Apache-2.0
// Consumes the obstacles that touch each tile. Produces the solid mask and the solids' velocity of
// its cells (methods.md W2); cells of other tiles were cleared to air. A cell is what its centre
// is; of several solids the last in the scene counts.
#include "wind/grid.glsl"
#include "shared/wind_solid.h"

layout(local_size_x = WIND_TILE, local_size_y = WIND_TILE) in;

uniform int first_tile;

layout(std430, binding = BIND_WIND_SOLID) writeonly buffer Solid {
    uint solid[];
};
layout(std430, binding = BIND_WIND_SOLID_VELOCITY) writeonly buffer SolidVelocity {
    vec2 velocity[];
};
layout(std430, binding = BIND_WIND_SOLIDS) readonly buffer Solids {
    WindSolid solids[];
};
layout(std430, binding = BIND_WIND_TILES) readonly buffer WindTiles {
    ivec4 tiles[]; // column, row, first item, items
};
layout(std430, binding = BIND_WIND_TILE_ITEMS) readonly buffer TileItems {
    uint tile_items[];
};
layout(std430, binding = BIND_WIND_FOOTPRINTS) readonly buffer Footprints {
    uint words[];
};

bool covers(WindSolid one, vec2 xz) {
    vec2 own = solid_frame(one, xz);
    if (one.kind != kSolidFootprint)
        return solid_covers(one, own);
    int bit = solid_bit(one, own);
    return bit >= 0 && (words[one.first_word + bit / 32] >> uint(bit % 32) & 1u) != 0u;
}

void main() {
    ivec4 tile = tiles[first_tile + int(gl_WorkGroupID.x)];
    ivec2 cell = tile.xy * WIND_TILE + ivec2(gl_LocalInvocationID.xy);
    if (!in_grid(cell))
        return;
    vec2 xz = cell_centre(cell);
    for (int i = tile.z + tile.w - 1; i >= tile.z; --i) {
        WindSolid one = solids[tile_items[i]];
        if (!covers(one, xz))
            continue;
        int index = cell_index(cell);
        solid[index] = 1u;
        velocity[index] = solid_velocity(one, xz);
        return;
    }
}
