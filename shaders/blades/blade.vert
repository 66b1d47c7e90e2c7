// SPDX-License-Identifier: Apache-2.0
// In: survivors of the cull pass, states of the living blades. Out: a posed blade for the
// tessellator.
#include "lib/blade_pose.glsl"
#include "shared/sward.h"

layout(std430, binding = BIND_SURVIVORS) readonly buffer Survivors {
    uvec2 survivors[];
};

out BladeVertex {
    vec4 root;   // world; w: distance from the place that tier selection measures from
    vec4 v1;     // relative to the root; w: half width
    vec4 v2;     // relative to the root; w: facing
    vec4 sway;   // sway_at
    vec4 rest;   // rest heights of v1 and v2 over the canopy's; rank; seed
    vec4 ground; // cosine ground to sun; tint; species; share of the simulated pose
} blade_out;

void main() {
    uvec2 which = survivors[gl_VertexID];
    BladeRecord blade = tile_blade(which.x, which.y);
    BladePose pose = blade_pose(which, blade);
    Ground ground = ground_surface(pose.root.xz);
    float tint = sward_patches(pose.root.xz, ivec2(frame.anchor_x, frame.anchor_z), ground.tint,
                               distance(pose.root, frame.eye) / frame.focal_px);
    blade_out.sway = sway_at(pose.root, pose.sway);
    blade_out.root = vec4(pose.root, pose.from_eye);
    blade_out.v1 = vec4(pose.v1, blade.v1.w);
    blade_out.v2 = vec4(pose.v2, pose.facing);
    blade_out.rest = vec4(vec2(blade.v1.y, blade.v2.y) / frame.canopy_m, blade.root.zw);
    blade_out.ground =
        vec4(dot(ground.normal, frame.light.to_sun), tint, blade.shape.w, pose.simulated);
    gl_Position = vec4(0.0);
}
