// SPDX-License-Identifier: Apache-2.0
// The staggered grid of the wind passes. Logical cells run from (0, 0), the window's north-west
// corner; storage is toroidal. u lies on the west face of its cell, v on the north face. Window
// places are metres from the north-west corner.
#include "shared/bindings.h"
#include "shared/wind_grid.h"

layout(std140, binding = BIND_WIND_GRID) uniform WindGridBlock {
    WindGrid grid;
};

// Where a logical column (row) is stored; within [0, cells).
int stored_column(int x) {
    x += grid.stored.x;
    return x >= grid.cells ? x - grid.cells : x;
}
int stored_row(int y) {
    y += grid.stored.y;
    return y >= grid.cells ? y - grid.cells : y;
}

// Index of a logical cell within [0, cells) on each axis.
int cell_index(ivec2 logical) {
    return stored_row(logical.y) * grid.cells + stored_column(logical.x);
}

// The neighbour's column or row: around the tile, or held at the window's edge.
int near_cell(int x) {
#ifdef PERIODIC
    return x < 0 ? x + grid.cells : x >= grid.cells ? x - grid.cells : x;
#else
    return clamp(x, 0, grid.cells - 1);
#endif
}
int near_index(ivec2 logical) {
    return cell_index(ivec2(near_cell(logical.x), near_cell(logical.y)));
}

bool in_grid(ivec2 logical) {
    return all(greaterThanEqual(logical, ivec2(0))) && all(lessThan(logical, ivec2(grid.cells)));
}

vec2 cell_centre(ivec2 logical) {
    return (vec2(logical) + 0.5) * grid.cell_m;
}
vec2 west_face(ivec2 logical) { // where u(logical) lies
    return (vec2(logical) + vec2(0.0, 0.5)) * grid.cell_m;
}
vec2 north_face(ivec2 logical) { // where v(logical) lies
    return (vec2(logical) + vec2(0.5, 0.0)) * grid.cell_m;
}

// What no cell may exceed; what is no number is calm.
float sane(float speed) {
    return abs(speed) <= kWindCeiling_mps ? speed
           : speed > 0.0                  ? kWindCeiling_mps
           : speed < 0.0                  ? -kWindCeiling_mps
                                          : 0.0;
}
