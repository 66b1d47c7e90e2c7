// SPDX-License-Identifier: Apache-2.0
// The only way any shader learns of tracks. Anchor-relative xz in; what bends and lies there out
// (shared/track_seen.h).
#include "lib/frame.glsl"
#include "shared/bindings.h"
#include "shared/track_seen.h"

layout(binding = TEX_TRACK_BENDS) uniform samplerBuffer track_bends;
layout(binding = TEX_TRACK_SHOWN) uniform usamplerBuffer track_shown;
layout(binding = TEX_TRACK_TABLE) uniform isamplerBuffer track_table;

bool has_tracks() {
    return frame.tracks.table_mask > 0;
}

// Slot of a page and whether something moves in it; -1: it has none.
ivec2 track_slot(ivec2 page) {
    int at = track_hash(page) & frame.tracks.table_mask;
    for (int n = 0; n < 64; ++n) {
        ivec4 entry = texelFetch(track_table, at);
        if (entry.z < 0 || entry.xy == page) {
            return entry.zw;
        }
        at = (at + 1) & frame.tracks.table_mask;
    }
    return ivec2(-1, 0);
}

// A cell's texel in the pool of what moves; -1: at rest.
int track_moving(int slot, ivec2 cell) {
    int block = track_block_of(cell);
    int place = texelFetch(track_table, frame.tracks.table_mask + 1 + slot * (kTrackBlocks / 4) +
                                            block / 4)[block % 4];
    return place < 0 ? -1 : place * kTrackBlock * kTrackBlock + track_in_block(cell);
}

TrackSeen track_cell(ivec2 slot, ivec2 cell) {
    int moving = slot.y != 0 ? track_moving(slot.x, cell) : -1;
    vec2 theta = moving < 0 ? vec2(0.0) : texelFetch(track_bends, moving).xy;
    return track_seen(
        theta,
        track_unpack(
            texelFetch(track_shown, slot.x * kTrackWords + cell.y * kTrackCells + cell.x).x));
}

// A cell of a level, counted from the anchor page's north-west corner.
TrackSeen track_texel(ivec2 cell, int level, inout ivec2 page, inout ivec2 slot) {
    int side = kTrackCells >> level;
    ivec2 own = ivec2(floor(vec2(cell) / float(side)));
    if (own != page) {
        page = own;
        slot = track_slot(own + frame.tracks.page);
    }
    ivec2 within = cell - own * side;
    if (slot.x < 0) {
        return track_nothing();
    }
    if (level == 0) {
        return track_cell(slot, within);
    }
    int at = slot.x * kTrackWords + track_level_first(level) + 2 * (within.y * side + within.x);
    return track_unpack_seen(
        uvec2(texelFetch(track_shown, at).x, texelFetch(track_shown, at + 1).x));
}

// Loops in place of four calls, and below of two: compilers write every call out, and few programs
// are longer than those that ask here.
TrackSeen track_of_level(vec2 xz, int level) {
    vec2 place = track_level_place(frame.tracks, xz, level);
    vec2 low = floor(place);
    vec2 part = place - low;
    ivec2 page = ivec2(-1000000);
    ivec2 slot = ivec2(-1, 0);
    TrackSeen found = track_nothing();
    TrackSeen row = found;
    for (int n = 0; n < 4; ++n) {
        ivec2 corner = ivec2(n & 1, n >> 1);
        TrackSeen here = track_texel(ivec2(low) + corner, level, page, slot);
        if (corner.x == 0) {
            row = here;
        } else {
            row = track_mean(row, here, part.x);
            found = track_mean(found, row, corner.y == 0 ? 1.0 : part.y);
        }
    }
    return found;
}

bool track_within(vec2 xz, float beyond) {
    vec2 least = frame.tracks.least;
    vec2 most = frame.tracks.most;
    return has_tracks() && xz.x >= least.x - beyond && xz.y >= least.y - beyond &&
           xz.x <= most.x + beyond && xz.y <= most.y + beyond;
}

// What is seen over `width` metres around a place.
TrackSeen track_at(vec2 xz, float width) {
    if (!track_within(xz, 0.0)) {
        return track_nothing();
    }
    float level = clamp(log2(max(width * frame.tracks.per_m, 1.0)), 0.0, float(kTrackLevels - 1));
    int fine = int(level);
    int coarse = level > float(fine) ? min(fine + 1, kTrackLevels - 1) : fine;
    TrackSeen found = track_nothing();
    for (int n = fine; n <= coarse; ++n) {
        found = track_mean(found, track_of_level(xz, n), n == fine ? 1.0 : level - float(fine));
    }
    float left = frame.tracks.left;
    found.pressed *= left;
    found.axis *= left;
    found.lying *= left;
    return found;
}

// C3: how far ahead a part of the stem (`share`, 0 root .. 1 tip) has its bend from; nothing where
// all is at rest, or seen so coarsely that it is less than a cell.
vec2 track_ahead(vec2 xz, float width, float share) {
    if (width * frame.tracks.per_m > 2.0 || !track_within(xz, 0.0)) {
        return vec2(0.0);
    }
    ivec2 cell = ivec2(floor(track_level_place(frame.tracks, xz, 0) + 0.5));
    ivec2 page = ivec2(floor(vec2(cell) / float(kTrackCells)));
    ivec2 slot = track_slot(page + frame.tracks.page);
    if (slot.x < 0 || slot.y == 0) {
        return vec2(0.0);
    }
    int at = track_moving(slot.x, cell - page * kTrackCells);
    if (at < 0) {
        return vec2(0.0);
    }
    vec4 bend = texelFetch(track_bends, at);
    return track_delay(bend.xy, bend.zw, share,
                       vec2(frame.tracks.wave_mps, frame.tracks.wave_gain_m));
}

// Of a footprint that is longer than wide, as that of a ray low over the ground: `along`, its
// length, one way.
const int kTrackTaps = 6;
TrackSeen track_along(vec2 xz, float width, vec2 along) {
    float run = length(along);
    int taps = clamp(int(ceil(run / max(width, 1.0 / frame.tracks.per_m))), 1, kTrackTaps);
    taps = track_within(xz, 0.5 * run) ? taps : 1;
    TrackSeen found = track_nothing();
    for (int n = 0; n < taps; ++n) {
        TrackSeen one = track_at(xz + along * ((float(n) + 0.5) / float(taps) - 0.5),
                                 max(width, run / float(taps)));
        found = track_mean(found, one, 1.0 / float(n + 1));
    }
    return found;
}
