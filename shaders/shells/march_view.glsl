// SPDX-License-Identifier: Apache-2.0
// A pixel's ray and where it enters the canopy: for the choice of its kind and for the march
// itself. SURFACE: the canopy of a mesh.
#define LAND_SMOOTH
#include "lib/ground.glsl"
#include "shared/bend.h"
#include "shared/lod.h"
#include "shared/march_medium.h"

layout(std140, binding = BIND_MARCH) uniform MarchBlock {
    MarchMedium medium;
};
#include "shared/march.h"
#include "shared/surface_chart.h"
#ifndef SURFACE
#include "lib/sway.glsl"
#endif

layout(binding = TEX_CANOPY_DEPTH) uniform sampler2D canopy_depth;
layout(binding = TEX_CANOPY_GROUND) uniform sampler2D canopy_ground;
layout(binding = TEX_CANOPY_AIR) uniform sampler2D canopy_air;
flat in vec2 eye_place;  // 1: the eye stands in the canopy; its height over the ground (m)
flat in vec4 eye_ground; // Entry::ground, air there
flat in vec4 eye_air;

const float kNever = 1e9;
const float kFarthest = 1e6; // no place beyond is asked for (m)
const float kLowPath = 3.0;  // over ground within so many canopies' reach no curve is looked for

struct View {
    vec3 way;   // of the pixel's ray, unit
    float axis; // distance along the view axis for a metre of the ray
    float dither;
};

// Where a ray enters the canopy, and what lies there.
struct Entry {
    float distance; // along the ray (m); kNever: nowhere
    float height;   // over the ground (m)
    vec4 ground;    // slope (of a mesh: unused; room), density, tint
    vec4 air;       // wind, canopy_sway
#ifndef SURFACE
    float lying;     // factor on heights where stems lie (lying_height)
    float aligned;   // Sway's
    bool comes_down; // not looked at yet: what stands there may be lower than `height` (settled)
#endif
#ifdef SURFACE
    SurfaceFrame frame; // the patch's axes there, in the world
    vec2 place;         // of the entry on its chart (m)
    float bend;   // of the surface under the ray: half of the height's second derivative (1/m)
    vec2 way_out; // how far the ray's way through the canopy is, and how high over the ground it
                  // ends (m); 0: unknown
#endif
};

View view_of(ivec2 pixel, vec2 ndc) {
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    View view;
    view.way = normalize(near.xyz / near.w - frame.eye);
    view.axis = (frame.clip_from_world * vec4(view.way, 0.0)).w;
    view.dither = pixel_threshold(pixel);
    return view;
}

#ifdef SURFACE
#include "shells/surface_view.glsl"
#else
vec4 ground_under(vec2 xz) {
    Ground ground = ground_surface(xz);
    return vec4(-ground.normal.xz / max(ground.normal.y, 0.1), ground.density, ground.tint);
}

// Does what stands somewhere differ from what the canopy's surface was drawn by?
bool is_uneven() {
    return has_tracks() || has_heights();
}

// Height over the ground at which rays come into the canopy from above.
float canopy_top(vec2 wind) {
    float canopy = frame.canopy_m;
    return highest() * (canopy + bend_offset(canopy, canopy, wind, frame.wind.response).y);
}

// Where the ray comes through the canopy's upper surface from above.
Entry entry_from_above(View view, ivec2 pixel) {
    float depth = texelFetch(canopy_depth, pixel, 0).r;
    float distance_m = depth > 0.0 ? frame.near_m / (depth * view.axis) : kNever;
    vec4 ground = texelFetch(canopy_ground, pixel, 0);
    if (frame.mask_mode !=
        kMaskNone) { // a mask is finer than the vertices that the surface was drawn by
        vec2 xz = frame.eye.xz + view.way.xz * min(distance_m, kFarthest);
        ground.z = mask_density(xz, distance_m / frame.focal_px) * frame.density_scale;
    }
    vec4 air = texelFetch(canopy_air, pixel, 0);
    float height = is_uneven() ? canopy_top(air.xy) : frame.canopy_m;
    return Entry(distance_m, height, ground, air, 1.0, 1.0, is_uneven());
}

Entry entry_of(View view, ivec2 pixel) {
    if (eye_place.x > 0.5) { // the eye stands in the canopy
        return Entry(frame.near_m, eye_place.y, eye_ground, eye_air, 1.0, 1.0, has_heights());
    }
    return entry_from_above(view, pixel);
}

#include "shells/settle.glsl"

// Slope and curvature of a path as the whole pixel (m wide) has them: at a crest the ground turns
// away within it, from 2 sqrt(pixel z) to level, and a ray through its middle would show now the
// one, now the other. Where a pixel is higher than the canopy, whose fringe is then no more to be
// seen.
const float kCrestMean = 4.0 / 3.0; // mean of 2 sqrt(h) over h from 0 to 1
const float kCrestReach = 4.0;      // pixels: no nearer is the ground's curvature looked for, where
                                    // the slopes of vertices and posts differ by more
const float kCrestCurve = 1e-9;     // of the mean (1/m): none, and a mark
vec2 crest_mean(vec2 slope_curve, float pixel) {
    float fringe = smoothstep(0.5, 1.5, pixel / frame.canopy_m);
    float mean = fringe * kCrestMean * sqrt(pixel * max(slope_curve.y, 0.0));
    return -slope_curve.x < mean ? vec2(-mean, kCrestCurve) : slope_curve;
}
bool is_crest_mean(MarchPath path) {
    return path.height.z == kCrestCurve;
}

MarchPath path_of(View view, Entry entry) {
    MarchPath path;
    vec3 at = frame.eye + view.way * entry.distance;
    float canopy = frame.canopy_m;
    float speed = length(entry.air.xy);
    float bend = 0.5 * kPi * bend_intensity(speed, frame.wind.response) / canopy;
    path.bend = vec4(entry.air.xy / max(speed, 1e-4), bend, 0.0);
    path.bend.w = march_bent_height(path, canopy);
    float height = min(entry.height, path.bend.w * highest());
    path.from = vec3(at.x, height, at.z);
    path.way = view.way;
    float fall = view.way.y - dot(entry.ground.xy, view.way.xz);
    float most = 40.0 * canopy + 0.02 * entry.distance;
    float reach = fall < 0.0 ? min(height / -fall, most) : most;
    float lying = 1.0;
    if (is_uneven()) { // heights are counted as they were before the stems lay down
        path.bend.xy *= entry.aligned;
        lying = entry.lying;
        height = min(entry.height / lying, path.bend.w);
        path.from.y = height;
        path.way.y /= lying;
        fall /= lying;
    }
    path.height =
        vec4(height, fall, 0.0, 1.5 * reach + 0.1 * canopy); // beyond, the ground is another one
    if (reach > kLowPath * canopy) { // low over the ground: it curves under the ray
        float pixel = entry.distance / frame.focal_px;
        float far = max(reach, kCrestReach * pixel);
        vec2 ahead = at.xz + far * view.way.xz;
        float rise = ground_at(ahead) - ground_at(at.xz) - dot(entry.ground.xy, ahead - at.xz);
        path.height.z = -rise / (far * far * lying);
        path.height.yz = crest_mean(path.height.yz, pixel);
    }
    return path;
}

// May the ray leave the canopy through its top again? Where the ground falls away under it, or from
// within.
bool at_crest(MarchPath path) {
    float a = path.height.y;
    return eye_place.x > 0.5 || a >= 0.0 || 4.0 * path.height.z * path.height.x > 0.5 * a * a;
}

// Where a path that is not looked at closely comes to the ground.
float ground_reach(MarchPath path) {
    return min(path.height.x / max(-path.height.y, 1e-4), kNever);
}

// Light, and directions, as the canopy's own axes have them: level ground's are the world's.
Light light_at(Entry entry) {
    return light_in_sway(frame.light, entry.air.zw);
}
vec3 normal_at(Entry entry) {
    return normalize(vec3(-entry.ground.x, 1.0, -entry.ground.y));
}
vec3 to_eye_at(Entry entry, View view) {
    return -view.way;
}
// Metres that the ground rises along the ray for a metre.
float rise_at(Entry entry, View view) {
    return dot(entry.ground.xy, view.way.xz) / max(length(view.way.xz), 1e-4);
}
#endif

// So far from the eye all blades are the near tier's (m).
float near_reach() {
    float aside = distance(frame.lod_eye, frame.eye); // in tests alone
    return frame.far_alone != 0 || frame.handover_mode == kHandoverOff
               ? 0.0
               : max(frame.handover_band.x - aside, 0.0);
}

#include "shells/march_land.glsl"

// How the pixel is marched. Where there is next to no grass, as if there were a little.
MarchPlan plan_of(View view, Entry entry, MarchPath path) {
    MarchPlan plan = march_look(
        path, vec3(1.0 / frame.focal_px, entry.distance, max(densest(view, entry, path), 0.002)));
    march_choose(plan, view.dither);
    return plan;
}
