// SPDX-License-Identifier: Apache-2.0
// The staggered grid of the wind passes. Logical cells run from (0, 0), the window's north-west corner; storage is toroidal.
// u lies on the west face of its cell, v on the north face. Window places are metres from the north-west corner.
#include "shared/bindings.h"
#include "shared/wind_grid.h"

layout(std140, binding = BIND_WIND_GRID) uniform WindGridBlock {
    WindGrid grid;
};

// Index of a logical cell within [0, cells) on each axis.
int cell_index(ivec2 logical) {
    int n = grid.layout.x;
    ivec2 place = logical + grid.layout.yz;
    place -= ivec2(greaterThanEqual(place, ivec2(n))) * n;
    return place.y * n + place.x;
}

bool in_grid(ivec2 logical) {
    return all(greaterThanEqual(logical, ivec2(0))) && all(lessThan(logical, ivec2(grid.layout.x)));
}

vec2 cell_centre(ivec2 logical) {
    return (vec2(logical) + 0.5) * grid.size.x;
}
vec2 west_face(ivec2 logical) { // where u(logical) lies
    return (vec2(logical) + vec2(0.0, 0.5)) * grid.size.x;
}
vec2 north_face(ivec2 logical) { // where v(logical) lies
    return (vec2(logical) + vec2(0.5, 0.0)) * grid.size.x;
}
