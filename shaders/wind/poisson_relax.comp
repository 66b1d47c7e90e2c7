// SPDX-License-Identifier: Apache-2.0
// Half a red-black sweep over a level: the cells of one colour, from those of the other. CORRECT:
// the others are first corrected by the coarser level, bilinearly, beside walls by the plain value
// of the coarse cell on their side; they need not be written, since the next half sweep replaces
// them.
#include "wind/poisson.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(location = 1) uniform int colour;

#ifdef CORRECT
// Beyond the open rim phi goes on antisymmetrically: it is 0 on the rim.
float coarse_at(ivec2 c) {
    float value = phi[element(level + 1, held(level + 1, c))];
    return beyond(level + 1, c) ? -value : value;
}

float plain_at(ivec2 c) {
    ivec2 near = held(level, c);
    return coarse_at(source_of(near, unpack_weights(weights[element(level, near)])));
}

// Corrections at the four neighbours of a fine cell; their parents lie in the 3 x 3 block around
// its own.
vec4 corrections(ivec2 c) {
    ivec2 parent = c >> 1;
    ivec2 side = (c & 1) * 2 - 1;
    vec4 open = unpack_weights(weights[element(level + 1, parent)]);
    if (min(min(open.x, open.y), min(open.z, open.w)) < 1.0) {
        return vec4(plain_at(c - ivec2(1, 0)), plain_at(c + ivec2(1, 0)), plain_at(c - ivec2(0, 1)),
                    plain_at(c + ivec2(0, 1)));
    }
    float own = coarse_at(parent), beside = coarse_at(parent + ivec2(side.x, 0)),
          over = coarse_at(parent + ivec2(0, side.y));
    float corner = coarse_at(parent + side);
    float away_x = coarse_at(parent - ivec2(side.x, 0)),
          away_y = coarse_at(parent - ivec2(0, side.y));
    float away_x_over = coarse_at(parent + ivec2(-side.x, side.y)),
          away_y_beside = coarse_at(parent + ivec2(side.x, -side.y));
    float column = 0.75 * own + 0.25 * over, column_side = 0.75 * beside + 0.25 * corner,
          column_away = 0.75 * away_x + 0.25 * away_x_over;
    float row = 0.75 * own + 0.25 * beside, row_side = 0.75 * over + 0.25 * corner,
          row_away = 0.75 * away_y + 0.25 * away_y_beside;
    // The neighbour on the parent's outer side has the next parent; the one on the inner side
    // shares ours.
    float outer_x = 0.25 * column + 0.75 * column_side,
          inner_x = 0.75 * column + 0.25 * column_away;
    float outer_y = 0.25 * row + 0.75 * row_side, inner_y = 0.75 * row + 0.25 * row_away;
    return vec4(side.x < 0 ? outer_x : inner_x, side.x < 0 ? inner_x : outer_x,
                side.y < 0 ? outer_y : inner_y, side.y < 0 ? inner_y : outer_y);
}
#endif

void main() {
    int y = int(gl_GlobalInvocationID.y);
    ivec2 c = ivec2(2 * int(gl_GlobalInvocationID.x) + ((y + colour) & 1), y);
    if (any(greaterThanEqual(c, ivec2(side_of(level))))) {
        return;
    }
    int own = element(level, c);
    vec4 around = phi_around(c);
#ifdef CORRECT
    bvec4 outside = bvec4(beyond(level, c - ivec2(1, 0)), beyond(level, c + ivec2(1, 0)),
                          beyond(level, c - ivec2(0, 1)), beyond(level, c + ivec2(0, 1)));
    around += mix(corrections(c), vec4(0.0), outside);
#endif
    phi[own] = relaxed(unpack_weights(weights[own]), around, rhs[own]);
}
