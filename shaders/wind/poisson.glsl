// SPDX-License-Identifier: Apache-2.0
// The Poisson equation of the projection on the levels of the multigrid: sum over faces of w
// (phi_neighbour - phi) = rhs, lengths counted in cells of the level. w is the open share of a
// face: 0 at a solid, 1 in the air, 2 towards the open rim, where phi is 0 on the face itself, half
// a cell away. Level 0 is stored toroidally, the others plainly.
#include "wind/grid.glsl"

layout(std430, binding = BIND_WIND_PHI) buffer WindPhi {
    float phi[];
};
layout(std430, binding = BIND_WIND_RHS) buffer WindRhs {
    float rhs[];
};
layout(std430, binding = BIND_WIND_WEIGHTS) buffer WindWeights {
    uint weights[];
};
layout(location = 0) uniform int level;

const float kWeightUnit = 64.0; // a byte of this is an open face

int side_of(int l) {
    return grid.levels[l].cells;
}

// Element of a cell of a level that lies in it.
int element(int l, ivec2 c) {
    WindLevel own = grid.levels[l];
    ivec2 place = c + own.stored;
    place -= ivec2(greaterThanEqual(place, ivec2(own.row))) * own.row;
    return own.first + place.y * own.row + place.x;
}

// The cell that stands in for one beyond the level's edge.
ivec2 held(int l, ivec2 c) {
    int n = side_of(l);
#ifdef PERIODIC
    return c + n * (ivec2(lessThan(c, ivec2(0))) - ivec2(greaterThanEqual(c, ivec2(n))));
#else
    return clamp(c, ivec2(0), ivec2(n - 1));
#endif
}

bool beyond(int l, ivec2 c) {
#ifdef PERIODIC
    return false;
#else
    return any(lessThan(c, ivec2(0))) || any(greaterThanEqual(c, ivec2(side_of(l))));
#endif
}

// Weights of the faces west, east, north, south.
vec4 unpack_weights(uint bytes) {
    return vec4(bytes & 255u, (bytes >> 8u) & 255u, (bytes >> 16u) & 255u, bytes >> 24u) /
           kWeightUnit;
}
uint pack_weights(vec4 w) {
    uvec4 b = uvec4(w * kWeightUnit + 0.5);
    return b.x | (b.y << 8u) | (b.z << 16u) | (b.w << 24u);
}

float phi_at(ivec2 c) {
    float value = phi[element(level, held(level, c))];
    return beyond(level, c) ? 0.0 : value;
}
vec4 phi_around(ivec2 c) {
    return vec4(phi_at(c - ivec2(1, 0)), phi_at(c + ivec2(1, 0)), phi_at(c - ivec2(0, 1)),
                phi_at(c + ivec2(0, 1)));
}

// What a cell's own value counts in its equation. A coarse cell that walls leave with little more
// than cracks is held back: it would overshoot.
float own_weight(vec4 w) {
    return max(w.x + w.y + w.z + w.w, 1.0);
}

// The value that solves a cell's equation; 0 in a cell without an open face.
float relaxed(vec4 w, vec4 around, float right) {
    return w == vec4(0.0) ? 0.0 : (dot(w, around) - right) / own_weight(w);
}

// The coarse cell that a fine cell gives its residual to and takes its correction from: its parent,
// but where a wall that the coarse level moved to the parent's far side cuts it off from that, the
// next one.
ivec2 source_of(ivec2 c, vec4 w) {
    return (c >> 1) + ivec2((c.x & 1) != 0 && w.x == 0.0 && w.y > 0.0,
                            (c.y & 1) != 0 && w.z == 0.0 && w.w > 0.0);
}
