// SPDX-License-Identifier: Apache-2.0
// Where the samples of a pixel enter the canopy. On an edge, of a hill or of a stand of grass, they
// do so in several places: each is marched by a ray of its own, through the middle of its samples,
// so that the edge is as smooth as that of geometry.
#include "lib/sway.glsl"

layout(binding = TEX_CANOPY_SAMPLES) uniform sampler2DMS canopy_samples;
uniform vec4 sample_x, sample_y; // places of the samples in a pixel, 0..1

const float kSamePlace =
    2.5; // ground that a pixel covers: within so many times that, its samples' entries are one
const float kSameShare = 0.01;   // of the distance, likewise
const float kMaybeValley = 1.03; // entries that are so much farther may lie beyond a valley
const float kValley_px = 0.5;    // depth of one, in pixels

// Distances along the ray at which the pixel's samples enter the canopy; kNever: they do not.
vec4 sample_entries(View view, ivec2 pixel) {
    vec4 entries;
    for (int i = 0; i < 4; ++i) { // fewer samples count more than once
        float depth = texelFetch(canopy_samples, pixel, i * samples / 4).r;
        entries[i] = depth > 0.0 ? frame.near_m / (depth * view.axis) : kNever;
    }
    return entries;
}

float nearest_of(vec4 entries) {
    return min(min(entries.x, entries.y), min(entries.z, entries.w));
}

// Samples (1, else 0) that enter where the nearest does, on ground of this slope: none beyond a
// valley.
vec4 members_of(View view, vec4 entries, vec2 slope) {
    float nearest = nearest_of(entries);
    float fall = max(dot(slope, view.way.xz) - view.way.y, 1e-3);
    float reach = nearest * (1.0 + kSameShare) + kSamePlace * nearest / (frame.focal_px * fall);
    vec4 near = mix(vec4(0.0), entries, lessThanEqual(entries, vec4(min(reach, kFarthest))));
    float farthest = max(max(near.x, near.y), max(near.z, near.w));
    if (farthest > nearest * kMaybeValley) {
        vec3 between = frame.eye + view.way * (0.5 * (nearest + farthest));
        float over = between.y - ground_at(between.xz) - highest() * frame.canopy_m;
        reach = over > kValley_px * nearest / frame.focal_px ? nearest * (1.0 + kSameShare) : reach;
    }
    return vec4(lessThan(entries, vec4(kNever))) * vec4(lessThanEqual(entries, vec4(reach)));
}

// Does the middle of the pixel see past the canopy that its samples enter, between the triangles of
// two blocks?
bool misses(Entry entry, vec4 entries) {
    vec4 own = mix(vec4(0.0), entries, lessThan(entries, vec4(kNever)));
    return entry.distance > max(max(own.x, own.y), max(own.z, own.w)) * (1.0 + kSameShare);
}

// The ray through the middle of these samples.
View view_through(ivec2 pixel, vec4 members, vec2 ndc) {
    vec2 middle =
        vec2(dot(members, sample_x), dot(members, sample_y)) / max(dot(members, vec4(1.0)), 1.0);
    return view_of(pixel, ndc + 2.0 * (middle - 0.5) / vec2(textureSize(canopy_depth, 0)));
}

// Where a ray comes down into the canopy that it meets at this distance.
Entry entry_at(View view, float distance_m) {
    Entry entry;
    entry.distance = distance_m;
    entry.height = highest() * frame.canopy_m;
    vec2 xz = frame.eye.xz + view.way.xz * min(distance_m, kFarthest);
    entry.ground = ground_under(xz);
    vec2 wind = wind_at(xz);
    vec3 ground = frame.eye + view.way * min(distance_m, kFarthest) - vec3(0.0, entry.height, 0.0);
    entry.air = vec4(wind, sway_at(ground, wind).xy);
    entry.lying = entry.aligned = 1.0;
    entry.comes_down = is_uneven();
    entry.height = entry.comes_down ? canopy_top(entry.air.xy) : entry.height;
    return entry;
}
