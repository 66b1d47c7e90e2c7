// SPDX-License-Identifier: Apache-2.0
// C4 for a mesh: its underside as a map in its own frame, and how a cell meets it. Whoever includes
// it in GLSL has the buffer `track_maps` before.
//
// A map: corner x, z, side of a texel (m), unused; texels across, down, unused, unused; then row by
// row from the least z a texel each: height of the underside over the mesh's origin (m), how far
// inside the contour at grass height the texel is (m, negative outside), the nearest rim's outward
// normal x, z.
#ifndef SWARD_SHARED_TRACK_MAP_H
#define SWARD_SHARED_TRACK_MAP_H
#include "shared/track.h"

SHARED_BEGIN

SHARED_CONST int kMapHead = 2;       // texels before the first
SHARED_CONST int kMostMapSide = 256; // texels
SHARED_CONST int kMostMapTaps = 368; // along the way through a map: its diagonal

#ifdef __cplusplus
#define TRACK_MAPS const vec4 *track_maps,
#define TRACK_MAPS_WITH track_maps,
#else
#define TRACK_MAPS
#define TRACK_MAPS_WITH
#endif

// A map between its texels' middles; at its end as the last one.
SHARED_FN vec4 track_map_at(TRACK_MAPS int map, vec2 own) {
    vec4 place = track_maps[map];
    vec4 size = track_maps[map + 1];
    vec2 most = vec2(size.x - 1.0f, size.y - 1.0f);
    vec2 at = (own - vec2(place.x, place.y)) / place.z - vec2(0.5f, 0.5f);
    at = clamp(at, vec2(0.0f, 0.0f), most);
    vec2 low = min(floor(at), max(most - vec2(1.0f, 1.0f), vec2(0.0f, 0.0f)));
    vec2 part = at - low;
    int across = int(size.x);
    int first = map + kMapHead + int(low.y) * across + int(low.x);
    int right = size.x > 1.5f ? 1 : 0;
    int below = size.y > 1.5f ? across : 0;
    vec4 north = mix(track_maps[first], track_maps[first + right], part.x);
    vec4 south = mix(track_maps[first + below], track_maps[first + below + right], part.x);
    return mix(north, south, part.y);
}

// What a cell meets on its way through a mesh: where the underside is nearest, and of places where
// it is as near the one farthest from the rim. x: clearance (m); y: distance to the rim (m), not
// above 0: nothing is met; z, w: that rim's normal in the mesh's frame.
SHARED_FN vec4 track_map_met(TRACK_MAPS TrackPrint print, vec2 from, vec2 run) {
    const float same = 1e-3f; // m; what is flat is flat on any machine
    vec4 place = track_maps[print.map];
    vec4 size = track_maps[print.map + 1];
    vec2 half_size = vec2(size.x, size.y) * (0.5f * place.z);
    vec2 middle = vec2(place.x, place.y) + half_size;
    vec4 met = vec4(0.0f, -1.0f, 0.0f, 0.0f);
    vec2 span = track_inside(from - middle, run, half_size);
    if (span.x > span.y) {
        return met;
    }
    float way = length(run) * (span.y - span.x) / place.z;
    int taps = clamp(int(ceil(way - 0.01f)), 1, kMostMapTaps);
    for (int n = 0; n <= taps; ++n) {
        vec2 own = from + run * mix(span.x, span.y, float(n) / float(taps));
        vec4 found = track_map_at(TRACK_MAPS_WITH print.map, own);
        float clearance = print.underside_m + found.x + dot(print.tilt, own);
        bool nearer = clearance < met.x - same;
        bool deeper = clearance < met.x + same && found.y > met.y + same;
        if (found.y > 0.0f && (met.y <= 0.0f || nearer || deeper)) {
            met = vec4(clearance, found.y, found.z, found.w);
        }
    }
    return met;
}

// track_contact() for a mesh.
SHARED_FN TrackContact track_map_contact(TRACK_MAPS TrackRules rules, TrackPrint print, vec2 xz) {
    TrackContact contact;
    contact.touched = 0;
    contact.way = vec2(0.0f, 0.0f);
    contact.speed = 0.0f;
    vec2 from = track_own(print.before, xz);
    vec4 met = track_map_met(TRACK_MAPS_WITH print, from, track_own(print.now, xz) - from);
    contact.clearance = max(met.x, 0.0f);
    if (met.y <= 0.0f || contact.clearance >= rules.canopy_m) {
        return contact;
    }
    vec2 normal = vec2(met.z, met.w) / max(length(vec2(met.z, met.w)), 1e-6f);
    vec3 way = track_way(rules, print, vec3(normal.x, normal.y, met.y));
    contact.way = vec2(way.x, way.y);
    contact.speed = way.z;
    contact.touched = 1;
    return contact;
}

SHARED_END
#endif
