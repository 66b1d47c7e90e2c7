// SPDX-License-Identifier: Apache-2.0
// In: survivors of the cull pass, states of the living blades. Out: a posed blade (J1, J4 or W3, B3, W6's flutter) for the
// tessellator.
#include "lib/blade_place.glsl"
#include "lib/sway.glsl"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"
#include "shared/sward.h"

layout(std430, binding = BIND_SURVIVORS) readonly buffer Survivors { uvec2 survivors[]; };
layout(std430, binding = BIND_BLADE_STATES) readonly buffer States { vec4 states[]; };
layout(std430, binding = BIND_BLADE_PLACES) readonly buffer Places { uint places[]; }; // in the Morton order

out BladeVertex {
    vec4 root;  // world; w: distance from the place that tier selection measures from
    vec4 v1;    // relative to the root; w: half width
    vec4 v2;    // relative to the root; w: facing
    vec4 sway;  // sway_at
    vec4 rest;  // rest heights of v1 and v2 over the canopy's; rank; seed
    vec4 ground; // cosine ground to sun; tint; species; share of the simulated pose
} blade_out;

// Moves a pose to the blade's own one, where its tile has a page, by what the hand-over leaves of it; returns the share.
float live(uvec2 which, BladeRecord blade, vec3 root, inout vec3 v1, inout vec3 v2) {
    int page = int(tiles[which.x].page) - 1;
    float share = page < 0 ? 0.0
                           : simulated_share(distance(root, frame.eye.xyz), frame.simulated.xy) *
                                 own_pose_share(blade.root.z, distance(root, frame.lod_eye.xyz), frame.pose_band.xy);
    if (share > 0.0) {
        vec4 state = states[page * int(frame.simulated.z) + int(places[which.y])];
        vec3 own1;
        vec3 own2;
        simulated_pose(set_blade_shape(blade, frame.patch_grid.w), state, own1, own2);
        v1 = mix(v1, own1, share);
        v2 = mix(v2, own2, share);
    }
    return share;
}

void main() {
    uvec2 which = survivors[gl_VertexID];
    BladeRecord blade = tile_blade(which.x, which.y);
    vec3 root = blade_root(which.x, blade);
    Ground ground = ground_surface(root.xz);
    float from_eye = distance(root, frame.lod_eye.xyz);
    float canopy = frame.patch_grid.w;
    vec3 v1 = blade.v1.xyz;
    vec3 v2 = blade.v2.xyz;
    Sway here = sway_at(root.xz, 0.0);
    vec2 wind = here.wind;
    float shell = pose_share(blade.root.z, from_eye, frame.pose_band.xy);
    pose_blade(v1, v2, vec4(blade.shape.y, canopy, frame.wind.mean.w, shell), wind);
    float alive = live(which, blade, root, v1, v2);
    float lying = lying_height(here.pressed);
    if (lying < 1.0) { // after contacts and wind: what lies is lower, in every tier by the same factor
        v1.y *= lying;
        v2.y *= lying;
    }
    // Gone where the pose has become the shell image's
    float amplitude = (1.0 - shell) * (1.0 - min(length(here.pressed), 1.0)) * flutter_amplitude(length(wind), frame.wind.mean.w);
    vec3 flutter = flutter_at(frame.lod_eye.w, vec4(blade.shape.y, blade.v2.w, blade.root.zw), amplitude);
    flutter_blade(v1, v2, blade.shape.y, flutter.xy, wind);
    float tint = sward_patches(root.xz, ivec2(frame.anchor_x, frame.anchor_z), ground.tint, distance(root, frame.eye.xyz) / frame.eye.w);
    blade_out.sway = sway_at(root, here);
    blade_out.root = vec4(root, from_eye);
    blade_out.v1 = vec4(v1, blade.v1.w);
    blade_out.v2 = vec4(v2, blade.shape.x + flutter.z);
    blade_out.rest = vec4(vec2(blade.v1.y, blade.v2.y) / canopy, blade.root.zw);
    blade_out.ground = vec4(dot(ground.normal, frame.light.to_sun.xyz), tint, blade.shape.w, alive);
    gl_Position = vec4(0.0);
}
