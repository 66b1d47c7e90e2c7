// SPDX-License-Identifier: Apache-2.0
// Blades of a mesh in the world.
#include "lib/frame.glsl"
#include "shared/surface_blade.h"

layout(std430, binding = BIND_BLADES) readonly buffer SurfaceBlades { SurfaceBlade surface_blades[]; };
uniform vec4 surface_origin; // of the mesh's space, world; w: greatest height of a blade (m)

vec3 surface_root(SurfaceBlade blade) {
    return blade.root_direction.xyz + surface_origin.xyz;
}
