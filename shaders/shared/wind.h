// SPDX-License-Identifier: Apache-2.0
// Where wind_at() finds its answer: the ambient tile, laid over the plane twice and carried along by the mean wind, and the
// local window over it. The arithmetic of places and weights is here, for shaders and for the C++ twin; each fetches by itself.
#ifndef SWARD_SHARED_WIND_H
#define SWARD_SHARED_WIND_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kWindLayers = 2; // copies of the ambient tile: one alone would show itself repeating

// Offsets hold anchor and time already (reduced in double precision on the CPU), so that shaders only add places near
// the anchor. 112 bytes.
struct WindField {
    vec4 mean;      // mean velocity x, z (m/s); unused; response of the grass, 1 / (m/s)
    vec4 ambient;   // cells a side of the tile (0: no gusts); share of the latest state in time; unused
    vec4 layers[2]; // tile coordinates of the anchor (cells); cosine and sine of the layer's turn over its cell (1/m)
    vec4 weights;   // of the layers; their cells (m)
    vec4 window;    // north-west corner from the anchor x, z (m); 1 / cell (1/m); cells a side (0: no window)
    vec4 blend;     // storage place of that corner's cell x, z; share of the latest state; width of the rim's blend (cells)
};
#ifdef __cplusplus
static_assert(sizeof(WindField) == 112);
#endif

// Winds that the far appearance is computed for: 0.5, 1 and 1.5 times the mean one.
SHARED_CONST int kFarWinds = 3;

// The speed that far winds are parts of (m/s): the mean one, but never so little that arrows in still air would find no table.
SHARED_FN float far_wind_speed(WindField field) {
    return max(length(vec2(field.mean.x, field.mean.y)), 2.0f);
}
SHARED_FN vec2 far_wind(WindField field, int index) {
    vec2 mean = vec2(field.mean.x, field.mean.y);
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
    vec4 turn = field.layers[layer];
    return vec2(turn.x + turn.z * xz.x + turn.w * xz.y, turn.y - turn.w * xz.x + turn.z * xz.y);
}

// A tile's velocity turned into the world, and its share of the wind.
SHARED_FN vec2 wind_layer_velocity(WindField field, int layer, vec2 velocity) {
    vec4 turn = field.layers[layer];
    float cell = layer == 0 ? field.weights.z : field.weights.w;
    float scale = cell * (layer == 0 ? field.weights.x : field.weights.y);
    return scale * vec2(turn.z * velocity.x - turn.w * velocity.y, turn.w * velocity.x + turn.z * velocity.y);
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
    int n = int(field.window.w);
    int x = clamp(int(low.x), 0, n - 2) + int(field.blend.x);
    int y = clamp(int(low.y), 0, n - 2) + int(field.blend.y);
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
    float n = field.window.w;
    float to_rim = min(min(place.x, place.y), min(n - place.x, n - place.y)) - 4.0f;
    float t = clamp(to_rim / max(field.blend.w, 1.0f), 0.0f, 1.0f);
    return n > 0.0f ? t * t * (3.0f - 2.0f * t) : 0.0f;
}

// Velocity among four fetched elements (previous state xy, latest zw), `latest` the latest one's share.
SHARED_FN vec2 wind_tap_velocity(WindTap tap, vec4 nw, vec4 ne, vec4 sw, vec4 se, float latest) {
    vec4 north = nw + (ne - nw) * tap.within.x;
    vec4 south = sw + (se - sw) * tap.within.x;
    vec4 both = north + (south - north) * tap.within.y;
    return vec2(both.x + (both.z - both.x) * latest, both.y + (both.w - both.y) * latest);
}

SHARED_END
#endif
