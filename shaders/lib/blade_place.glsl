// SPDX-License-Identifier: Apache-2.0
// A blade of a tile in the world.
#include "lib/ground.glsl"
#include "shared/tile_lie.h"

layout(std430, binding = BIND_BLADES) readonly buffer Blades {
    BladeRecord blades[];
};
layout(std430, binding = BIND_BLADE_TILES) readonly buffer Tiles {
    BladeTile tiles[];
};

// A blade of the set as it lies on a tile.
BladeRecord tile_blade(uint tile, uint index) {
    return lay_blade(tiles[tile].lie, blades[index], frame.patch_side_m);
}

vec3 blade_root(uint tile, BladeRecord blade) {
    vec2 xz = tiles[tile].corner + blade.root.xy;
    return vec3(xz.x, ground_at(xz), xz.y);
}
