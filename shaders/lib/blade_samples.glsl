// SPDX-License-Identifier: Apache-2.0
// Which samples of the reference's jittered pictures may fall on a blade: the test holds all that
// the tessellator makes of it. BEFORE_SCENE: in one picture, and of the samples only those that
// show nothing nearer yet.
#include "lib/blade_pose.glsl"
#include "shared/sample_places.h"

layout(std140, binding = BIND_SAMPLES) uniform SampleBlock {
    SampleRound round;
};
#ifdef BEFORE_SCENE
layout(binding = TEX_RESOLVE_DEPTH) uniform sampler2DMS scene_depth;
float nearest_depth = 0.0; // of the blade in the test
int pictures() {
    return 1;
} // its own constants hold what it is moved by, and the round's first one is moved by nothing
#else
int pictures() {
    return round.counts.x;
}
#endif

const float kSnap_px = 1.0 / 480.0; // rasterisers put vertices on a grid of 1/256 pixel: half of it
                                    // away, and what rounding adds

// A piece of blade in the picture: all of it lies within `radius`, to the sides and up and down, of
// the line from a to b (pixels).
struct Capsule {
    vec2 a;
    vec2 b;
    vec2 radius;
};

uint all_pictures() {
    return (1u << pictures()) - 1u;
}

vec2 pixel_of(vec4 clip) {
    return (0.5 + 0.5 * clip.xy / clip.w) * vec2(frame.picture_px);
}

// Could a sample at `place` of some pixel lie in it, number `s` of its pixel? Row by row: where a
// row of samples crosses it, is there a column's?
bool falls_on(Capsule piece, vec2 place, int s) {
    vec2 low = min(piece.a, piece.b) - piece.radius;
    vec2 high = max(piece.a, piece.b) + piece.radius;
    vec2 last = vec2(frame.picture_px) - 1.0;
    float row = max(ceil(low.y - place.y), 0.0);
    float end = min(high.y - place.y, last.y);
    if (max(ceil(low.x - place.x), 0.0) > min(high.x - place.x, last.x)) {
        end = -1.0;
    }
    vec2 way = piece.b - piece.a;
    float per_row = abs(way.y) > 1e-6 ? 1.0 / way.y : 0.0;
    bool found = false;
    for (; row <= end && !found; row += 1.0) {
        // The part of the line whose height is within a radius of the row's.
        float t0 = 0.0;
        float t1 = 1.0;
        if (per_row != 0.0) {
            float middle = (row + place.y - piece.a.y) * per_row;
            float reach = piece.radius.y * abs(per_row);
            t0 = clamp(middle - reach, 0.0, 1.0);
            t1 = clamp(middle + reach, 0.0, 1.0);
        }
        float x0 = piece.a.x + t0 * way.x;
        float x1 = piece.a.x + t1 * way.x;
        float left = min(x0, x1) - piece.radius.x - place.x;
        float right = max(x0, x1) + piece.radius.x - place.x;
        float column = max(ceil(left), 0.0);
#ifdef BEFORE_SCENE
        for (; column <= min(right, last.x) && !found; column += 1.0) {
            found = texelFetch(scene_depth, ivec2(column, row), s).r < nearest_depth;
        }
#else
        found = column <= min(right, last.x);
#endif
    }
    return found;
}

uint pictures_of(Capsule piece, uint mask) {
    for (int picture = 0; picture < pictures(); ++picture) {
        bool found = (mask >> picture & 1u) != 0u;
        for (int s = 0; s < round.counts.y; ++s) {
            found = found || falls_on(piece, round.places[picture * round.counts.y + s].xy, s);
        }
        mask |= (found ? 1u : 0u) << picture;
    }
    return mask;
}

// Greatest distance of the blade's surface from its middle line between two stations, over its half
// width.
float reach_of(float from, float to, BladeOutline outline) {
    float stalk = outline.stalk * (1.0 - pow(from, outline.taper));
    float head = outline.head_from < 1.0 && to > outline.head_from ? 1.0 : 0.0;
    return max(max(stalk, head), 0.5 * (1.0 - from)); // the fold stands out by the last
}

// How far it takes a point to the sides, up or down to move it by `way` or by its opposite
// (pixels).
vec2 extent(vec4 clip, vec3 way) {
    vec4 moved = frame.clip_from_world * vec4(way, 0.0);
    return abs(moved.xy - clip.xy / clip.w * moved.w) / (clip.w - abs(moved.w)) * 0.5 *
           vec2(frame.picture_px);
}

// Of a blade's rims and of its fold at a station, whose vertices these are.
vec2 station_extent(vec4 clip, float v, float width, BladePose pose, BladeOutline outline) {
    vec3 across = blade_width_direction(pose.facing);
    vec3 normal = normalize(cross(blade_tangent(pose.v1, pose.v2, v), across));
    return max(extent(clip, across * (width * blade_width_at(v, outline))),
               extent(clip, normal * (width * 0.5 * (1.0 - v))));
}

// The pictures that a sample of may fall on the blade as blade.tesc and blade.tese draw it.
uint pictures_with(BladeRecord blade, BladePose pose) {
    BladeOutline outline = frame.looks[int(blade.shape.w)].outline;
    vec4 root = frame.clip_from_world * vec4(pose.root, 1.0);
    vec4 clip1 = frame.clip_from_world * vec4(pose.v1, 0.0);
    vec4 clip2 = frame.clip_from_world * vec4(pose.v2, 0.0);
    float width = blade.v1.w;
    float nearest = root.w + min(min(clip1.w, clip2.w), 0.0) - 2.0 * width;
    float pixels = frame.focal_px / max(distance(pose.root, frame.eye), 0.05);
    float wanted = (length(pose.v1) + length(pose.v2 - pose.v1)) * pixels / frame.segment_px;
    bool head = outline.head_from < 1.0;
    bool unsure =
        wanted > 7.99 || (!head && wanted > 1.5 &&
                          abs(fract(wanted) - 0.5) > 0.49); // how many segments rounding makes
    if (nearest < 2.0 * frame.near_m || unsure) {
        return all_pictures(); // clipped, or long: not worth the trouble
    }
#ifdef BEFORE_SCENE
    // Rasterisers extend the depth of a sliver over what its ends were moved by: more than a
    // quarter of a pixel's width makes of that is not shown.
    nearest_depth = frame.near_m / (nearest - 0.25 * root.w / frame.focal_px);
#endif
    // The segments' own ends, or of a head's eight every other: both those and ours lie within a
    // quarter of the bulge times the square of our step from the curve.
    int pieces = head ? 4 : max(int(ceil(wanted)), 2);
    float bulge = head ? 0.5 * length(pose.v2 - 2.0 * pose.v1) : 0.0;
    uint mask = 0u;
    float before = 0.0;
    vec4 clip = root;
    vec2 place = pixel_of(root);
    vec2 ahead = station_extent(root, 0.0, width, pose, outline);
    for (int k = 1; k <= pieces; ++k) {
        float v = blade_station(float(k) / float(pieces), outline);
        vec4 next = root + 2.0 * v * (1.0 - v) * clip1 + v * v * clip2;
        vec2 next_place = pixel_of(next);
        float radius = width * reach_of(before, v, outline) + bulge * (v - before) * (v - before);
        vec2 aside = max(abs(place - 0.5 * vec2(frame.picture_px)),
                         abs(next_place - 0.5 * vec2(frame.picture_px))) /
                     frame.focal_px;
        float per_metre = frame.focal_px * sqrt(1.0 + dot(aside, aside)) /
                          max(min(clip.w, next.w) - radius, frame.near_m);
        vec2 next_ahead = station_extent(next, v, width, pose, outline);
        vec2 reach = head ? vec2(radius * per_metre) : max(ahead, next_ahead);
        mask = pictures_of(Capsule(place, next_place, reach + kSnap_px), mask);
        ahead = next_ahead;
        before = v;
        clip = next;
        place = next_place;
    }
    return mask;
}
