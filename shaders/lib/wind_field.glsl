// SPDX-License-Identifier: Apache-2.0
// The wind that a WindField describes: for wind_at() and for the rim of the window. Fetches and
// blends by itself: texture filters are too coarse to agree with the C++ twin.
#include "shared/bindings.h"
#include "shared/wind.h"

layout(binding = TEX_WIND_AMBIENT) uniform samplerBuffer wind_ambient;
layout(binding = TEX_WIND_LOCAL) uniform samplerBuffer wind_local;

vec2 ambient_wind(WindField field, vec2 xz) {
    vec2 sum = field.mean;
    if (field.tile_cells > 0) {
        for (int layer = 0; layer < kWindLayers; ++layer) {
            WindTap tap =
                wind_tile_tap(float(field.tile_cells), wind_layer_place(field, layer, xz));
            vec2 found = wind_tap_velocity(tap, texelFetch(wind_ambient, tap.at.x),
                                           texelFetch(wind_ambient, tap.at.y),
                                           texelFetch(wind_ambient, tap.at.z),
                                           texelFetch(wind_ambient, tap.at.w), field.tile_share);
            sum += wind_layer_velocity(field, layer, found);
        }
    }
    return sum;
}

vec2 wind_of(WindField field, vec2 xz) {
    vec2 wind = ambient_wind(field, xz);
    vec2 place = (xz - field.window_corner_m) * field.window_per_m;
    float share = wind_window_share(field, place);
    if (share > 0.0) {
        WindTap tap = wind_window_tap(field, place);
        vec2 found = wind_tap_velocity(
            tap, texelFetch(wind_local, tap.at.x), texelFetch(wind_local, tap.at.y),
            texelFetch(wind_local, tap.at.z), texelFetch(wind_local, tap.at.w), field.window_share);
        wind += (found - wind) * share;
    }
    return wind;
}
