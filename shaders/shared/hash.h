// SPDX-License-Identifier: Apache-2.0
// Integer hashes (PCG, O'Neill 2014; Jarzynski & Olano 2020): the same bits in C++ and GLSL.
#ifndef SWARD_SHARED_HASH_H
#define SWARD_SHARED_HASH_H
#include "shared/types.h"

SHARED_BEGIN

SHARED_FN uint hash_pcg(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// One round: enough for places on a grid, and far-tier fragments run it twice each.
SHARED_FN uint hash_ivec2(ivec2 cell, uint salt) {
    return hash_pcg(uint(cell.x) * 0x9e3779b1u + uint(cell.y) * 0x85ebca77u + salt * 0xc2b2ae3du);
}

// Uniform in [0, 1), 24 bits: exact in a float.
SHARED_FN float hash_to_unit(uint h) {
    return float(h >> 8u) * (1.0f / 16777216.0f);
}

// Which of the set's variants stands on a tile (design: one hash, read by every tier).
// Multiply and shift, not a division: that is slow on vectors.
SHARED_FN int tile_variant(ivec2 tile, int variants) {
    return int(((hash_ivec2(tile, 0x5eedu) >> 16u) * uint(variants)) >> 16u);
}

SHARED_END
#endif
