// SPDX-License-Identifier: Apache-2.0
// A blade of a tile as it stands in this frame (J1, J4 or W3, B3, W6's flutter): to draw it, and to find out whether anything of it is
// seen. Both must get the same.
#include "lib/blade_place.glsl"
#include "lib/wind.glsl"
#include "shared/bend.h"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"

layout(std430, binding = BIND_BLADE_STATES) readonly buffer States { vec4 states[]; };
layout(std430, binding = BIND_BLADE_PLACES) readonly buffer Places { uint places[]; }; // in the Morton order

struct BladePose {
    vec3 root;       // world
    vec3 v1;         // relative to the root
    vec3 v2;         // likewise
    float facing;
    float from_eye;  // distance from the place that tier selection measures from
    float simulated; // share of the simulated pose
    vec2 wind;
};

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

// `which`: tile, blade.
BladePose blade_pose(uvec2 which, BladeRecord blade) {
    BladePose pose;
    pose.root = blade_root(which.x, blade);
    pose.from_eye = distance(pose.root, frame.lod_eye.xyz);
    pose.v1 = blade.v1.xyz;
    pose.v2 = blade.v2.xyz;
    pose.wind = wind_at(pose.root.xz);
    float shell = pose_share(blade.root.z, pose.from_eye, frame.pose_band.xy);
    pose_blade(pose.v1, pose.v2, vec4(blade.shape.y, frame.patch_grid.w, frame.wind.mean.w, shell), pose.wind);
    pose.simulated = live(which, blade, pose.root, pose.v1, pose.v2);
    // Gone where the pose has become the shell image's
    float amplitude = (1.0 - shell) * flutter_amplitude(length(pose.wind), frame.wind.mean.w);
    vec3 flutter = flutter_at(frame.lod_eye.w, vec4(blade.shape.y, blade.v2.w, blade.root.zw), amplitude);
    flutter_blade(pose.v1, pose.v2, blade.shape.y, flutter.xy, pose.wind);
    pose.facing = blade.shape.x + flutter.z;
    return pose;
}
