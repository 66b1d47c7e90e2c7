// SPDX-License-Identifier: Apache-2.0
// Blades of a mesh in the world.
#include "lib/frame.glsl"
#include "shared/lod.h"
#include "shared/surface_blade.h"

layout(std430, binding = BIND_BLADES) readonly buffer SurfaceBlades {
    SurfaceBlade surface_blades[];
};
uniform vec4 surface_origin; // of the mesh's space, world; w: greatest height of a blade (m)

uniform float surface_thin_out; // distance_share's (m)

vec3 surface_root(SurfaceBlade blade) {
    return blade.root_direction.xyz + surface_origin.xyz;
}

// Factor on the width of a blade, 0: left out (J7's distance test). The paper's distance is the one
// along the surface's plane.
float surface_width_share(uint index, vec3 root, vec3 up) {
    vec3 away = root - frame.lod_eye;
    return distance_width(surface_rank_seed(index).x,
                          distance_share(length(away - up * dot(away, up)), surface_thin_out));
}
