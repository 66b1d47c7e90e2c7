// SPDX-License-Identifier: Apache-2.0
// Consumes the forces that touch each tile. Produces velocities nearer to what they want
// (methods.md W5, J4, C5), or with INFLOW the divergence that they bring. One invocation a cell,
// forces in one order: the same bits on every run.
#include "wind/grid.glsl"
#include "shared/wind_force.h"

layout(local_size_x = WIND_TILE, local_size_y = WIND_TILE) in;

uniform int first_tile;

layout(std430, binding = BIND_WIND_FORCES) readonly buffer Forces {
    WindForce forces[];
};
layout(std430, binding = BIND_WIND_TILES) readonly buffer WindTiles {
    ivec4 tiles[]; // column, row, first item, items
};
layout(std430, binding = BIND_WIND_TILE_ITEMS) readonly buffer TileItems {
    uint tile_items[];
};

#ifdef INFLOW
layout(std430, binding = BIND_WIND_INFLOW) writeonly buffer Inflow {
    float inflow[];
};
#else
layout(std430, binding = BIND_WIND_U) buffer U {
    float u[];
};
layout(std430, binding = BIND_WIND_V) buffer V {
    float v[];
};
#endif

void main() {
    ivec4 tile = tiles[first_tile + int(gl_WorkGroupID.x)];
    ivec2 cell = tile.xy * WIND_TILE + ivec2(gl_LocalInvocationID.xy);
    if (!in_grid(cell))
        return;
    vec2 west = west_face(cell), north = north_face(cell);
#ifdef INFLOW
    // Differences of values at faces: over all cells they sum to nothing.
    vec2 east = west_face(cell + ivec2(1, 0)), south = north_face(cell + ivec2(0, 1));
    float sum = 0.0;
    for (int i = tile.z; i < tile.z + tile.w; ++i) {
        WindForce force = forces[tile_items[i]];
        sum += wind_force_at(force, east).outflow.x - wind_force_at(force, west).outflow.x;
        sum += wind_force_at(force, south).outflow.y - wind_force_at(force, north).outflow.y;
    }
    inflow[cell_index(cell)] = sum * grid.per_m;
#else
    vec2 wanted = vec2(0.0), rate = vec2(0.0);
    for (int i = tile.z; i < tile.z + tile.w; ++i) {
        WindForce force = forces[tile_items[i]];
        WindPush at_west = wind_force_at(force, west), at_north = wind_force_at(force, north);
        wanted += vec2(at_west.target.x * at_west.rate, at_north.target.y * at_north.rate);
        rate += vec2(at_west.rate, at_north.rate);
    }
    int index = cell_index(cell);
    u[index] = relaxed(u[index], wanted.x, rate.x, grid.step_s);
    v[index] = relaxed(v[index], wanted.y, rate.y, grid.step_s);
#endif
}
