// SPDX-License-Identifier: Apache-2.0
// In: a shell or slice. Out: the blades of its slab that are this tier's and this level's to show,
// each decided at its own root by the hand-over that the blade culling calls too.
#include "lib/grass_surface.glsl"
#include "shared/blade.h"

layout(binding = TEX_FAR_IMAGES) uniform sampler2DArray far_images;
#ifdef BLOCK_SHAPES
layout(binding = TEX_FAR_SHAPES) uniform sampler2DArray far_shapes;
#endif

in vec3 world;
in vec3 rest;
in vec4 ground_here;
in vec3 ground_slope;
in vec3 turn;
in vec3 air_added;
in vec3 air_through;
flat in ivec4 image;

// Texels are as wide as a pixel from here on: above 0 coarser, cheaper for caches, and blades break
// up sooner.
const float kMipBias = -0.35;

bool own_blade(float rank, float seed, vec3 root, float dither) {
    float density = ground_here.y;
    if (seed >= density) {
        return false;
    }
#ifdef SLICES
    vec2 view = normalize(root.xz - frame.eye.xz);
    if (!slice_shows(seed, density, ground_slope.z * (image.z == kAxisX ? view.x : view.y))) {
        return false;
    }
#else
    if (!shell_shows(seed, density, ground_slope.z)) {
        return false;
    }
#endif
    float from_eye = distance(root, frame.lod_eye);
    int level = image.w;
    if (frame.forced_level >= 0) { // one level forced, out to the far tier's end
        return from_eye < frame.far_bands[frame.far_levels - 1].outgoing.y;
    }
    FarBand band = frame.far_bands[level];
    if (level == 0) {
        bool near = handover_near(rank, from_eye, band.incoming, dither, frame.handover_mode);
        if (frame.far_alone == 0 &&
            (frame.handover_mode == kHandoverOff ? from_eye < band.incoming.x : near)) {
            return false;
        }
    } else if (handover_near(rank, from_eye, band.incoming, dither, kHandoverRank)) {
        return false;
    }
    return handover_near(rank, from_eye, band.outgoing, dither, kHandoverRank);
}

struct FarTexel {
    vec3 uv; // of the id plane, counted with the shape planes between
    float mip;
    ivec2 cell; // texel at that mip, over the whole world
    float dither;
};

FarTexel find_texel() {
    vec2 place = (rest.xz + frame.patch_offset_m) / frame.patch_side_m;
    ivec2 tile = ivec2(floor(place)) + frame.anchor_tile;
    int layer = image.x + tile_variant(tile, frame.patch_variants) * image.y;
#ifdef SLICES
    vec2 uv = vec2(image.z == kAxisX ? place.y : place.x, rest.y / frame.canopy_m);
#else
    vec2 uv = place;
#endif
    float dither = pixel_threshold(ivec2(gl_FragCoord.xy));
    // Mip by distance, not by derivatives: blades seen at a grazing angle stay blades. The dither
    // hides the step between mips.
    float pixel_m = distance(world, frame.eye) / frame.focal_px;
    vec2 size = vec2(textureSize(far_images, 0).xy);
    float texel_m = frame.patch_side_m / size.x;
    float mip = floor(max(log2(pixel_m / texel_m) + kMipBias + dither, 0.0));
    return FarTexel(vec3(uv, layer), mip, ivec2(floor(uv * size * exp2(-mip))), dither);
}

// The two planes of a texel (shared/grass_layout.h). With BLOCK_SHAPES the ids are alone in their
// array, and the shape's two halves stand where id and shape stood.
void read_planes(FarTexel texel, out vec4 id, out vec4 shape) {
    vec3 next = texel.uv + vec3(0.0, 0.0, kPlaneShape);
#ifdef BLOCK_SHAPES
    id = textureLod(far_images, vec3(texel.uv.xy, texel.uv.z / float(kPlanes)), texel.mip);
    shape = vec4(textureLod(far_shapes, texel.uv, texel.mip).rg,
                 textureLod(far_shapes, next, texel.mip).rg);
#else
    id = textureLod(far_images, texel.uv, texel.mip);
    shape = textureLod(far_images, next, texel.mip);
#endif
}

void main() {
    FarTexel texel = find_texel();
    vec4 id, shape;
    read_planes(texel, id, shape);
    int code = int(id.a * 255.0 + 0.5);
    float along = decode_along(code);
#ifndef SLICES
    if (frame.height_coding != kHeightNone &&
        id.r > 0.0) { // B1: the blade stands in every shell below its top
        float top = decode_height(id.r, frame.height_coding) * frame.canopy_m;
        along *= rest.y / top;
        id.r = top >= rest.y ? 1.0 : 0.0;
    }
#endif
    vec2 offset = decode_offset(shape.ba, frame.offset_range_m);
    vec3 root =
        vec3(rest.x + offset.x, ground_here.x + dot(ground_slope.xy, offset), rest.z + offset.y);
    float rank = unorm8_to_unit(id.g);
    float seed = unorm8_to_unit(id.b);
    vec3 upright = decode_tangent(shape.rg);
    vec3 tangent = vec3(upright.x, 0.0, upright.z) + upright.y * turn;
#ifdef SLICES
    vec3 flattened = image.z == kAxisX ? vec3(0.0, 0.0, upright.z) + upright.y * turn
                                       : vec3(upright.x, 0.0, 0.0) + upright.y * turn;
#else
    vec3 flattened = vec3(upright.x, 0.0, upright.z);
#endif
    // Each sample shows the texel or not, with its coverage as the chance: a hash of the texel, so
    // that it stays put.
    uint h = hash_ivec2(texel.cell, uint(texel.uv.z));
    vec4 chances = (vec4(h & 255u, (h >> 8u) & 255u, (h >> 16u) & 255u, h >> 24u) + 0.5) / 256.0;
    float coverage = id.r * max(ground_slope.z, 1.0) *
                     flattening(tangent, flattened, normalize(frame.eye - world));
    bvec4 shown = greaterThan(vec4(coverage), chances);
    gl_SampleMask[0] =
        (shown.x ? 1 : 0) | (shown.y ? 2 : 0) | (shown.z ? 4 : 0) | (shown.w ? 8 : 0);
    if (!any(shown) || !own_blade(rank, seed, root, texel.dither)) {
        discard;
    }
    tangent = normalize(tangent);
#ifdef SLICES
    float tier = image.z == kAxisX ? kTierSliceX : kTierSliceZ;
#else
    float tier = kTierShell;
#endif
    AirLight air = AirLight(air_added, air_through);
    write_grass(GrassSample(world, tangent, tangent, rank, seed, along,
                            clamp(rest.y / frame.canopy_m, 0.0, 1.0), ground_here.z, ground_here.w,
                            tier, decode_species(code), air));
}
