// SPDX-License-Identifier: Apache-2.0
// The ground: bicubic interpolation between posts and procedural relief finer than them. The
// clipmap's shader and the CPU (agl cameras, flight models) call the same functions.
#ifndef SWARD_SHARED_SURFACE_H
#define SWARD_SHARED_SURFACE_H
#include "shared/hash.h"
#include "shared/types.h"

SHARED_BEGIN

SHARED_CONST int kReliefOctaves =
    5; // wavelengths 64, 32, 16, 8, 4 m; each costs one noise evaluation a post
SHARED_CONST float kReliefWavelength_m = 64.0f; // the longest

// What a clipmap level is made from. 64 bytes.
struct SurfaceParams {
    ivec2 posts; // in x, z
    vec2 post_m; // their spacing in x, z
    vec2 anchor; // x, z (m), for drawing
    ivec2 first; // post i, j of this level's window (world posts)
    int level;
    float spacing_m;                    // of this level
    float relief_m;                     // amplitude
    float detail_from_m;                // for drawing: detail_reach's start
    float zoom;                         // likewise
    float unused_a, unused_b, unused_c; // to 64 bytes
};
#ifdef __cplusplus
static_assert(sizeof(SurfaceParams) == 64);
#endif

// Catmull-Rom through p1 and p2: passes through every post, slope continuous.
SHARED_FN float catmull_rom(vec4 p, float t) {
    return p.y + 0.5f * t *
                     (p.z - p.x +
                      t * (2.0f * p.x - 5.0f * p.y + 4.0f * p.z - p.w +
                           t * (3.0f * (p.y - p.z) + p.w - p.x)));
}

SHARED_FN float gradient_dot(ivec2 cell, vec2 offset) {
    float angle = hash_to_unit(hash_ivec2(cell, 0x7e11u)) * 6.2831853f;
    return cos(angle) * offset.x + sin(angle) * offset.y;
}

// Gradient noise (Perlin 2002) on the integer lattice, about -0.7 .. 0.7.
SHARED_FN float gradient_noise(vec2 p) {
    vec2 base = floor(p);
    ivec2 cell = ivec2(int(base.x), int(base.y));
    vec2 f = p - base;
    vec2 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
    float n00 = gradient_dot(cell, f);
    float n10 = gradient_dot(ivec2(cell.x + 1, cell.y), vec2(f.x - 1.0f, f.y));
    float n01 = gradient_dot(ivec2(cell.x, cell.y + 1), vec2(f.x, f.y - 1.0f));
    float n11 = gradient_dot(ivec2(cell.x + 1, cell.y + 1), vec2(f.x - 1.0f, f.y - 1.0f));
    return mix(mix(n00, n10, w.x), mix(n01, n11, w.x), w.y);
}

// Relief (m) at world xz for a grid of `spacing` metres: octaves shorter than four posts are left
// out, so that a level never samples what it cannot hold.
SHARED_FN float relief_at(vec2 xz, float amplitude, float spacing) {
    float sum = 0.0f;
    float wavelength = kReliefWavelength_m;
    float weight = amplitude;
    for (int i = 0; i < kReliefOctaves; ++i) {
        if (wavelength >= 4.0f * spacing) {
            sum +=
                weight * gradient_noise(xz / wavelength + vec2(float(i) * 17.0f, float(i) * 31.0f));
        }
        wavelength *= 0.5f;
        weight *= 0.45f;
    }
    return sum;
}

// Default density where no mask is given: grass thins out on slopes, and is patchy there first.
SHARED_FN float slope_density(vec3 normal, vec2 xz) {
    float slope = sqrt(max(1.0f - normal.y * normal.y, 0.0f)) / max(normal.y, 1e-3f);
    float patchy = 0.25f * gradient_noise(xz / 23.0f);
    return 1.0f - smoothstep(0.65f, 1.1f, slope + patchy);
}

// Slow variation of soil and sward, 0..1, for a grid of `spacing` metres.
SHARED_FN float surface_tint(vec2 xz, float spacing) {
    return clamp(0.5f + 0.5f * gradient_noise(xz / 310.0f) + 0.35f * gradient_noise(xz / 71.0f) +
                     (spacing <= 8.0f ? 0.2f * gradient_noise(xz / 19.0f) : 0.0f),
                 0.0f, 1.0f);
}

// From how far (m) the ground at a distance (larger of |x|, |z|) is to be seen as: levels go by it.
// Up to `start`, where blades may stand, by distance alone; from twice that on through a lens that
// brings it `zoom` times nearer.
SHARED_FN float detail_reach(float distance_m, float start, float zoom) {
    float t = clamp(distance_m / max(start, 1e-3f) - 1.0f, 0.0f, 1.0f);
    return distance_m <= start ? distance_m
           : t < 1.0f          ? mix(start, 2.0f * start / zoom, t)
                               : distance_m / zoom;
}

SHARED_END
#endif
