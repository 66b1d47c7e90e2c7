// SPDX-License-Identifier: Apache-2.0
// In: survivors of the cull pass among a mesh's blades, states of the living ones. Out: a blade in
// its simulated pose (J4), or bent by the wind (W3), for the tessellator.
#include "lib/surface_place.glsl"
#include "lib/wind.glsl"
#include "shared/bend.h"
#include "shared/blade_pages.h"
#include "shared/surface_chart.h"

layout(std430, binding = BIND_SURVIVORS) readonly buffer Survivors {
    uvec2 survivors[];
};
layout(std430, binding = BIND_BLADE_STATES) readonly buffer States {
    vec4 states[];
};
layout(std430, binding = BIND_BLADE_PLACES) readonly buffer Slots {
    uint slots[];
};                         // a cluster; 0: none, else one more than it is
uniform int first_cluster; // of the bound blades, among all
uniform vec4 surface_shape;

out BladeVertex {
    vec4 root;   // world; w: distance from the place that tier selection measures from
    vec4 v1;     // relative to the root; w: half width
    vec4 v2;     // relative to the root; w: facing
    vec4 sway;   // canopy_sway; share of the sky that the surface there faces
    vec4 rest;   // rest heights of v1 and v2 over the canopy's; rank; seed
    vec4 ground; // cosine ground to sun; tint; species; share of the simulated pose
    vec4 across; // width direction
} blade_out;

// A point of the curve at rest, as the wind along the surface (B2) moves it in the far field (B3).
vec3 bent(vec3 point, vec3 up, vec3 along) {
    float speed = length(along);
    vec3 moved =
        bend_offset(dot(point, up), surface_origin.w, vec2(speed, 0.0), frame.wind.response);
    return point + along * (moved.x / max(speed, 1e-4)) + up * moved.y;
}

// Moves the pose of a set's blade to what the far field shows of it, as far as it has come to the
// hand-over.
void join_far_pose(SurfaceBlade blade, uint index, vec3 root, float alive, inout vec3 v1,
                   inout vec3 v2) {
    float from_eye = distance(root, frame.lod_eye);
    float rank = surface_rank_seed(index).x;
    float share = pose_share(rank, from_eye, frame.pose_band) *
                  (1.0 - alive * own_pose_share(rank, from_eye, frame.pose_band));
    if (share > 0.0) {
        vec3 up = blade.up_stiffness.xyz;
        vec2 wind = wind_at(root.xz);
        vec3 along = vec3(wind.x, 0.0, wind.y) - up * dot(up, vec3(wind.x, 0.0, wind.y));
        vec3 middle = bent(0.5 * blade.v1_height.xyz + 0.25 * blade.v2_width.xyz, up, along);
        vec3 tip = bent(blade.v2_width.xyz, up, along);
        v1 = mix(v1, 2.0 * middle - 0.5 * tip, share);
        v2 = mix(v2, tip, share);
    }
}

// Where the blade bends to; returns the share of it that is simulated.
float pose(SurfaceBlade blade, uint index, vec3 root, out vec3 v1, out vec3 v2) {
    BladeBody body = surface_blade_shape(blade, surface_origin.w);
    float share = 0.0;
    vec4 state = vec4(0.0);
    uint slot =
        frame.living_band.y > 0.0 ? slots[uint(first_cluster) + index / uint(CULL_GROUP)] : 0u;
    if (slot > 0u) {
        share = simulated_share(distance(root, frame.eye), frame.living_band);
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
    blade_out.root = vec4(root, distance(root, frame.lod_eye));
    vec3 v1, v2;
    float alive = pose(blade, index, root, v1, v2);
    bool of_set = surface_shape.x < 0.0;
    if (of_set) {
        join_far_pose(blade, index, root, alive, v1, v2);
    }
    blade_out.v1 = vec4(v1, blade.v2_width.w * surface_width_share(index, root, up));
    blade_out.v2 = vec4(v2, blade.root_direction.w);
    blade_out.sway = vec4(1.0, 1.0, 0.5 + 0.5 * up.y, 0.0);
    // At rest, as the far field has it. Hair that hangs is as much in the light as the layer it
    // forms: halfway between its height over the surface and its length.
    vec2 above = of_set ? vec2(dot(blade.v1_height.xyz, up), dot(blade.v2_width.xyz, up))
                        : 0.5 * (vec2(dot(v1, up), dot(v2, up)) + height * vec2(0.5, 1.0));
    float species = of_set ? floor(blade.root_direction.w / (2.0 * kPi)) : 0.0;
    blade_out.rest = vec4(above / surface_origin.w, surface_rank_seed(index));
    blade_out.ground =
        vec4(dot(up, frame.light.to_sun), surface_tint(blade.root_direction.xyz), species, alive);
    blade_out.across = vec4(surface_width_direction(up, blade.root_direction.w), 0.0);
    gl_Position = vec4(0.0);
}
