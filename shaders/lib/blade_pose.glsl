// SPDX-License-Identifier: Apache-2.0
// A blade of a tile as it stands in this frame (J1, J4 or W3, B3, W6's flutter): to draw it, and to
// find out whether anything of it is seen. Both must get the same.
#include "lib/blade_place.glsl"
#include "lib/sway.glsl"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"

layout(std430, binding = BIND_BLADE_STATES) readonly buffer States {
    vec4 states[];
};
layout(std430, binding = BIND_BLADE_PLACES) readonly buffer Places {
    uint places[];
}; // in the Morton order

struct BladePose {
    vec3 root; // world
    vec3 v1;   // relative to the root
    vec3 v2;   // likewise
    float facing;
    float from_eye;  // distance from the place that tier selection measures from
    float simulated; // share of the simulated pose
    Sway sway;       // what bends it
};

// Moves a pose to the blade's own one, where its tile has a page, by what the hand-over leaves of
// it; returns the share.
float live(uvec2 which, BladeRecord blade, vec3 root, inout vec3 v1, inout vec3 v2) {
    int page = int(tiles[which.x].page) - 1;
    float share =
        page < 0 ? 0.0
                 : simulated_share(distance(root, frame.eye), frame.living_band) *
                       own_pose_share(blade.root.z, distance(root, frame.lod_eye), frame.pose_band);
    if (share > 0.0) {
        vec4 state = states[page * frame.page_blades + int(places[which.y])];
        vec3 own1;
        vec3 own2;
        simulated_pose(set_blade_shape(blade, frame.canopy_m), state, own1, own2);
        v1 = mix(v1, own1, share);
        v2 = mix(v2, own2, share);
    }
    return share;
}

// `which`: tile, blade.
BladePose blade_pose(uvec2 which, BladeRecord blade) {
    BladePose pose;
    pose.root = blade_root(which.x, blade);
    pose.from_eye = distance(pose.root, frame.lod_eye);
    pose.v1 = blade.v1.xyz;
    pose.v2 = blade.v2.xyz;
    pose.sway = sway_at(pose.root.xz);
    vec2 wind = pose.sway.wind;
    float shell = pose_share(blade.root.z, pose.from_eye, frame.pose_band);
    pose_blade(pose.v1, pose.v2, vec4(blade.shape.y, frame.canopy_m, frame.wind.response, shell),
               wind);
    vec2 ahead = track_ahead(pose.root.xz, 0.0, 1.0);
    if (dot(ahead, ahead) > 0.0) {
        vec3 tip1 = blade.v1.xyz;
        vec3 tip2 = blade.v2.xyz;
        pose_blade(tip1, tip2, vec4(blade.shape.y, frame.canopy_m, frame.wind.response, shell),
                   sway_tip(pose.root.xz, pose.sway, ahead));
        pose.v1 = mix(pose.v1, tip1, 0.5);
        pose.v2 = tip2;
        keep_length(pose.v1, pose.v2, blade.shape.y);
    }
    pose.simulated = live(which, blade, pose.root, pose.v1, pose.v2);
    float lying = lying_height(pose.sway.lying);
    if (lying <
        1.0) { // after contacts and wind: what lies is lower, in every tier by the same factor
        pose.v1.y *= lying;
        pose.v2.y *= lying;
    }
    // Gone where the pose has become the shell image's
    float amplitude = (1.0 - shell) * (1.0 - min(pose.sway.lying, 1.0)) *
                      flutter_amplitude(length(wind), frame.wind.response);
    vec3 flutter =
        flutter_at(frame.flutter_time, vec4(blade.shape.y, blade.v2.w, blade.root.zw), amplitude);
    flutter_blade(pose.v1, pose.v2, blade.shape.y, flutter.xy, wind);
    if (has_heights()) { // last of all, since flutter keeps a blade's length: the march draws its
                         // whole canopy out, too
        float height = land_height(pose.root.xz, distance(pose.root, frame.eye) / frame.focal_px);
        pose.v1.y *= height;
        pose.v2.y *= height;
    }
    pose.facing = blade.shape.x + flutter.z;
    return pose;
}
