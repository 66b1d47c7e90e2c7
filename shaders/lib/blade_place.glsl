// SPDX-License-Identifier: Apache-2.0
// A blade of a tile in the world.
#include "lib/ground.glsl"
#include "shared/blade.h"

layout(std430, binding = BIND_BLADES) readonly buffer Blades { BladeRecord blades[]; };
layout(std430, binding = BIND_BLADE_TILES) readonly buffer Tiles { BladeTile tiles[]; };

vec3 blade_root(uint tile, BladeRecord blade) {
    vec2 xz = tiles[tile].place.xy + blade.root.xy;
    return vec3(xz.x, ground_at(xz), xz.y);
}
