// SPDX-License-Identifier: Apache-2.0
// The only way any shader learns of tracks. Anchor-relative xz in; theta and what lies pressed out (shared/track.h).
#include "lib/frame.glsl"
#include "shared/bindings.h"

layout(binding = TEX_TRACK_SHOWN) uniform samplerBuffer track_shown;
layout(binding = TEX_TRACK_TABLE) uniform isamplerBuffer track_table;

bool has_tracks() {
    return frame.tracks.page.z > 0;
}

// Slot of a page; -1: it has none.
int track_slot(ivec2 page) {
    int at = track_hash(page) & frame.tracks.page.z;
    for (int n = 0; n < 64; ++n) {
        ivec4 entry = texelFetch(track_table, at);
        if (entry.z < 0 || entry.xy == page) {
            return entry.z;
        }
        at = (at + 1) & frame.tracks.page.z;
    }
    return -1;
}

// A cell of a level, counted from the anchor page's north-west corner.
vec4 track_texel(ivec2 cell, int level, inout ivec2 page, inout int slot) {
    int side = kTrackCells >> level;
    ivec2 own = ivec2(floor(vec2(cell) / float(side)));
    if (own != page) {
        page = own;
        slot = track_slot(own + frame.tracks.page.xy);
    }
    ivec2 within = cell - own * side;
    return slot < 0 ? vec4(0.0) : texelFetch(track_shown, slot * kTrackTexels + track_level_first(level) + within.y * side + within.x);
}

vec4 track_of_level(vec2 xz, int level) {
    vec2 place = track_level_place(frame.tracks, xz, level);
    vec2 low = floor(place);
    vec2 part = place - low;
    ivec2 cell = ivec2(low);
    ivec2 page = ivec2(-1000000);
    int slot = -1;
    vec4 north = mix(track_texel(cell, level, page, slot), track_texel(cell + ivec2(1, 0), level, page, slot), part.x);
    vec4 south = mix(track_texel(cell + ivec2(0, 1), level, page, slot), track_texel(cell + ivec2(1, 1), level, page, slot), part.x);
    return mix(north, south, part.y);
}

// theta, pressed; as means over `width` metres.
vec4 track_at(vec2 xz, float width) {
    vec4 bounds = frame.tracks.bounds;
    if (!has_tracks() || xz.x < bounds.x || xz.y < bounds.y || xz.x > bounds.z || xz.y > bounds.w) {
        return vec4(0.0);
    }
    float level = clamp(log2(max(width * frame.tracks.place.z, 1.0)), 0.0, float(kTrackLevels - 1));
    int fine = int(level);
    vec4 found = track_of_level(xz, fine);
    if (level > float(fine)) {
        found = mix(found, track_of_level(xz, min(fine + 1, kTrackLevels - 1)), level - float(fine));
    }
    return vec4(found.xy, found.zw * frame.tracks.place.w);
}
