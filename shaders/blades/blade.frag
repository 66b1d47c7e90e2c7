// SPDX-License-Identifier: Apache-2.0
// In: a blade's surface. Out: its light; pixels that its shell image shows already are left to it.
#include "lib/grass_surface.glsl"

in vec3 world;
in vec3 tangent;
in vec3 normal;
in vec2 along;
flat in vec4 own;
flat in float tint;

void main() {
    if (frame.mode.x != kHandoverOff &&
        !handover_near(own.x, own.z, frame.handover.xy, pixel_threshold(ivec2(gl_FragCoord.xy)), frame.mode.x)) {
        discard;
    }
    write_grass(GrassSample(world, normalize(tangent), normal, own.x, own.y, along.x, along.y, own.w, tint, kTierGroupedBlade));
}
