// SPDX-License-Identifier: Apache-2.0
// Where wind_at() finds its answer: the ambient tile, laid over the plane twice and carried along
// by the mean wind, and the local window over it. The arithmetic of places and weights is here, for
// shaders and for the C++ twin; each fetches by itself.
#ifndef SWARD_SHARED_WIND_H
#define SWARD_SHARED_WIND_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kWindLayers =
    2; // copies of the ambient tile: one alone would show itself repeating

// Offsets hold anchor and time already (reduced in double precision on the CPU), so that shaders
// only add places near the anchor. A layer: 32 bytes; the field: 128.
struct WindLayer {
    vec2 place; // tile coordinates of the anchor (cells)
    vec2 turn;  // cosine and sine of the layer's turn over its cell (1/m)
    float weight;
    float cell_m;
    float unused_a, unused_b; // to 32 bytes
};

struct WindField {
    vec2 mean;      // mean velocity x, z (m/s)
    float response; // of the grass, 1 / (m/s)
    int tile_cells; // a side of the tile, 0: no gusts
    WindLayer layers[kWindLayers];
    vec2 window_corner_m;               // the north-west one from the anchor x, z
    float window_per_m;                 // 1 / cell
    int window_cells;                   // a side, 0: no window
    ivec2 window_first;                 // storage place of that corner's cell x, z
    float window_share;                 // of the latest state in time
    float window_rim;                   // width of its blend (cells)
    float tile_share;                   // of the tile's latest state in time
    float unused_a, unused_b, unused_c; // to 16 bytes
};
#ifdef __cplusplus
static_assert(sizeof(WindLayer) == 32 && sizeof(WindField) == 128);
#endif

// Winds that the far appearance is computed for: 0.5, 1 and 1.5 times the mean one.
SHARED_CONST int kFarWinds = 3;

// The speed that far winds are parts of (m/s): the mean one, but never so little that arrows in
// still air would find no table.
SHARED_FN float far_wind_speed(WindField field) {
    return max(length(field.mean), 2.0f);
}
SHARED_FN vec2 far_wind(WindField field, int index) {
    vec2 mean = field.mean;
    float speed = length(mean);
    vec2 way = speed > 0.0f ? mean / speed : vec2(1.0f, 0.0f);
    return way * (far_wind_speed(field) * (speed > 0.0f ? 0.5f + 0.5f * float(index) : 0.0f));
}
// Place of a wind among them, 0 .. kFarWinds - 1.
SHARED_FN float far_wind_place(WindField field, vec2 wind) {
    return clamp(2.0f * length(wind) / far_wind_speed(field) - 1.0f, 0.0f, float(kFarWinds - 1));
}

// Four elements around a place on a grid of cell centres, and the place among them.
struct WindTap {
    ivec4 at;    // elements north-west, north-east, south-west, south-east
    vec2 within; // 0..1 to the east, to the south
};

// Tile coordinates (cells) of an anchor-relative place in a layer.
SHARED_FN vec2 wind_layer_place(WindField field, int layer, vec2 xz) {
    vec2 place = field.layers[layer].place;
    vec2 turn = field.layers[layer].turn;
    return vec2(place.x + turn.x * xz.x + turn.y * xz.y, place.y - turn.y * xz.x + turn.x * xz.y);
}

// A tile's velocity turned into the world, and its share of the wind.
SHARED_FN vec2 wind_layer_velocity(WindField field, int layer, vec2 velocity) {
    vec2 turn = field.layers[layer].turn;
    float scale = field.layers[layer].cell_m * field.layers[layer].weight;
    return scale * vec2(turn.x * velocity.x - turn.y * velocity.y,
                        turn.y * velocity.x + turn.x * velocity.y);
}

SHARED_FN WindTap wind_tile_tap(float cells, vec2 place) {
    vec2 wrapped = place - vec2(0.5f, 0.5f);
    wrapped = wrapped - cells * floor(wrapped / cells);
    vec2 low = floor(wrapped);
    int n = int(cells);
    int x = int(low.x) < n ? int(low.x) : 0; // the wrap may round up to `cells` itself
    int y = int(low.y) < n ? int(low.y) : 0;
    int east = x + 1 < n ? x + 1 : 0;
    int south = y + 1 < n ? y + 1 : 0;
    WindTap tap;
    tap.at = ivec4(y * n + x, y * n + east, south * n + x, south * n + east);
    tap.within = wrapped - low;
    return tap;
}

// `place`: cells from the window's north-west corner, inside it.
SHARED_FN WindTap wind_window_tap(WindField field, vec2 place) {
    vec2 from_centre = place - vec2(0.5f, 0.5f);
    vec2 low = floor(from_centre);
    int n = field.window_cells;
    int x = clamp(int(low.x), 0, n - 2) + field.window_first.x;
    int y = clamp(int(low.y), 0, n - 2) + field.window_first.y;
    int west = x < n ? x : x - n;
    int east = x + 1 < n ? x + 1 : x + 1 - n;
    int north = (y < n ? y : y - n) * n;
    int south = (y + 1 < n ? y + 1 : y + 1 - n) * n;
    WindTap tap;
    tap.at = ivec4(north + west, north + east, south + west, south + east);
    tap.within = clamp(from_centre - low, vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    return tap;
}

// Share of the local window at a place (cells from its corner): 1 inside, 0 at the rim and outside.
SHARED_FN float wind_window_share(WindField field, vec2 place) {
    float n = float(field.window_cells);
    float to_rim = min(min(place.x, place.y), min(n - place.x, n - place.y)) - 4.0f;
    float t = clamp(to_rim / max(field.window_rim, 1.0f), 0.0f, 1.0f);
    return n > 0.0f ? t * t * (3.0f - 2.0f * t) : 0.0f;
}

// Velocity among four fetched elements (previous state xy, latest zw), `latest` the latest one's
// share.
SHARED_FN vec2 wind_tap_velocity(WindTap tap, vec4 nw, vec4 ne, vec4 sw, vec4 se, float latest) {
    vec4 north = nw + (ne - nw) * tap.within.x;
    vec4 south = sw + (se - sw) * tap.within.x;
    vec4 both = north + (south - north) * tap.within.y;
    return vec2(both.x + (both.z - both.x) * latest, both.y + (both.w - both.y) * latest);
}

SHARED_END
#endif
