// SPDX-License-Identifier: Apache-2.0
// In: survivors of the cull pass among a mesh's blades, states of the living ones. Out: a blade in its simulated pose (J4), or bent by
// the wind (W3), for the tessellator.
#include "lib/surface_place.glsl"
#include "lib/wind.glsl"
#include "shared/blade_pages.h"

layout(std430, binding = BIND_SURVIVORS) readonly buffer Survivors { uvec2 survivors[]; };
layout(std430, binding = BIND_BLADE_STATES) readonly buffer States { vec4 states[]; };
layout(std430, binding = BIND_BLADE_PLACES) readonly buffer Slots { uint slots[]; }; // a cluster; 0: none, else one more than it is
uniform int first_cluster; // of the bound blades, among all

out BladeVertex {
    vec4 root;   // world; w: distance from the place that tier selection measures from
    vec4 v1;     // relative to the root; w: half width
    vec4 v2;     // relative to the root; w: facing
    vec4 sway;   // canopy_sway; share of the sky that the surface there faces
    vec4 rest;   // rest heights of v1 and v2 over the canopy's; rank; seed
    vec4 ground; // cosine ground to sun; tint; species; share of the simulated pose
    vec4 across; // width direction
} blade_out;

// Slow variation over a mesh, 0..1: two waves whose lengths are metres.
float surface_tint(vec3 place) {
    return 0.5 + 0.25 * (sin(dot(place, vec3(1.9, 0.7, 1.3))) + sin(dot(place, vec3(-0.8, 1.7, 2.3)) + 2.0));
}

// Where the blade bends to; returns the share of it that is simulated.
float pose(SurfaceBlade blade, uint index, vec3 root, out vec3 v1, out vec3 v2) {
    BladeBody body = surface_blade_shape(blade, surface_origin.w);
    float share = 0.0;
    vec4 state = vec4(0.0);
    uint slot = frame.simulated.y > 0.0 ? slots[uint(first_cluster) + index / uint(CULL_GROUP)] : 0u;
    if (slot > 0u) {
        share = simulated_share(distance(root, frame.eye.xyz), frame.simulated.xy);
        state = states[(slot - 1u) * uint(CULL_GROUP) + index % uint(CULL_GROUP)];
    }
    if (share < 1.0) {
        vec2 wind = wind_at(root.xz);
        state = mix(grouped_state(body, wind, body.response), state, share);
    }
    simulated_pose(body, state, v1, v2);
    return share;
}

void main() {
    uint index = survivors[gl_VertexID].y;
    SurfaceBlade blade = surface_blades[index];
    vec3 root = surface_root(blade);
    vec3 up = blade.up_stiffness.xyz;
    float height = blade.v1_height.w;
    blade_out.root = vec4(root, distance(root, frame.lod_eye.xyz));
    vec3 v1, v2;
    float alive = pose(blade, index, root, v1, v2);
    blade_out.v1 = vec4(v1, blade.v2_width.w * surface_width_share(index, root, up));
    blade_out.v2 = vec4(v2, blade.root_direction.w);
    blade_out.sway = vec4(1.0, 1.0, 0.5 + 0.5 * up.y, 0.0);
    // Hair that hangs is as much in the light as the layer it forms: halfway between its height over the surface and its length.
    vec2 above = 0.5 * (vec2(dot(v1, up), dot(v2, up)) + height * vec2(0.5, 1.0));
    blade_out.rest = vec4(above / surface_origin.w, surface_rank_seed(index));
    blade_out.ground = vec4(dot(up, frame.light.to_sun.xyz), surface_tint(blade.root_direction.xyz), 0.0, alive);
    blade_out.across = vec4(surface_width_direction(up, blade.root_direction.w), 0.0);
    gl_Position = vec4(0.0);
}
