// SPDX-License-Identifier: Apache-2.0
// The ground as every tier sees it: the clipmap, blended between levels so that nothing cracks or
// pops. World xz in.
#include "lib/frame.glsl"
#ifdef FINE_GROUND
#include "lib/posts.glsl"
#endif

layout(binding = TEX_CLIP_HEIGHT) uniform sampler2DArray clip_height;
layout(binding = TEX_CLIP_SURFACE) uniform sampler2DArray clip_surface;
layout(binding = TEX_MASK) uniform sampler2D mask;
#include "lib/land.glsl"

// A level is whole out to 56 cells from the eye (its window moves in steps of 16); it dissolves
// into the next before that.
const float kBlendStart = 40.0;
const float kBlendEnd = 54.0;

struct ClipPlace {
    int level;
    float blend; // share of the next level
};

ClipPlace clip_place(vec2 xz) {
    vec2 from_eye = abs(xz - frame.eye.xz);
    float distance_m = max(from_eye.x, from_eye.y);
#ifdef FINE_GROUND
    distance_m = detail_reach(distance_m, params.detail_from_m, params.zoom);
#endif
    float cells = distance_m / frame.clip[0].spacing_m;
    int last = frame.clip_levels - 1;
    int level = int(clamp(ceil(log2(max(cells / kBlendEnd, 1e-3))), 0.0, float(last)));
    float own = cells / float(1 << level);
    float blend =
        level == last ? 0.0 : clamp((own - kBlendStart) / (kBlendEnd - kBlendStart), 0.0, 1.0);
    return ClipPlace(level, blend);
}

#ifdef FINE_GROUND
#include "lib/fine_ground.glsl"
#endif

vec3 clip_uv(vec2 xz, int level) {
    ClipLevel clip = frame.clip[level];
    return vec3(xz * clip.per_m + clip.offset, float(level));
}

// Height of the ground, world y.
float ground_at(vec2 xz) {
    ClipPlace place = clip_place(xz);
#ifdef FINE_GROUND
    if (is_fine(xz)) {
        return fine_height(xz, place);
    }
#endif
    float fine = textureLod(clip_height, clip_uv(xz, place.level), 0.0).r;
    float coarse =
        textureLod(clip_height, clip_uv(xz, min(place.level + 1, frame.clip_levels - 1)), 0.0).r;
    return mix(fine, coarse, place.blend) - frame.anchor_height_m;
}

struct Ground {
    vec3 normal;
    float density; // of grass, 0..1, the scene's scale included
    float tint;    // slow variation of soil and sward, 0..1
};

// Density by the scene's mask, as the mean over `width` metres: not through the clipmap, whose
// posts far away are wider than the roads that a mask shows.
float mask_density(vec2 xz, float width) {
    vec2 uv = mask_uv(xz);
    if (off_mask(uv)) {
        return 0.0;
    }
    vec2 texels = vec2(textureSize(mask, 0)) * frame.mask_per_m;
    float lod = log2(max(width * max(texels.x, texels.y), 1.0));
    float density = textureLod(mask, uv, lod).r;
    return has_land() ? land_density(density, xz, uv, lod, width) : density;
}

// `width`: of what the answer stands for (m); a pixel at least.
Ground ground_surface(vec2 xz, float width) {
    ClipPlace place = clip_place(xz);
    vec4 fine = textureLod(clip_surface, clip_uv(xz, place.level), 0.0);
    vec4 coarse =
        textureLod(clip_surface, clip_uv(xz, min(place.level + 1, frame.clip_levels - 1)), 0.0);
    vec4 s = mix(fine, coarse, place.blend);
    vec2 n = (s.xy * 255.0 - 128.0) / 127.0;
    float density = s.z;
#ifdef FINE_GROUND
    if (is_fine(xz)) {
        s = fine_surface(xz, place);
        n = s.xy;
        density = s.z;
    }
#endif
    if (frame.mask_mode != kMaskNone) {
        float height =
            textureLod(clip_height, clip_uv(xz, place.level), 0.0).r - frame.anchor_height_m;
        float pixel = distance(vec3(xz.x, height, xz.y), frame.eye) / frame.focal_px;
        density = mask_density(xz, max(width, pixel));
        s.w += has_land() ? land_dryness(xz, max(width, pixel)) : 0.0;
    }
    return Ground(vec3(n.x, sqrt(max(1.0 - dot(n, n), 0.0)), n.y), density * frame.density_scale,
                  s.w);
}

Ground ground_surface(vec2 xz) {
    return ground_surface(xz, 0.0);
}
