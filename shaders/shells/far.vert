// SPDX-License-Identifier: Apache-2.0
// In: shells or slices of a block (instances). Out: their vertices, bent by the closed form of B3
// at the wind of their place. Texture coordinates stay those of the rest pose.
#include "lib/frame.glsl"
#include "shared/bend.h"

layout(std430, binding = BIND_FAR_INSTANCES) readonly buffer Instances {
    FarInstance instances[];
};
layout(std430, binding = BIND_TERRAIN_BLOCKS) readonly buffer Blocks {
    TerrainBlock blocks[];
};
layout(std430, binding = BIND_BLOCK_SAMPLES) readonly buffer Samples {
    BlockSample samples[];
};
layout(std140, binding = BIND_FAR_SHARES) uniform SharesBlock {
    FarShares shares;
};
uniform float rows; // of a slice's strip

out vec3 world;
out vec3 rest;         // x, z at rest (world), height above the ground at rest
out vec4 ground_here;  // height of the ground (world y), grass density, cosine to the sun, tint
out vec3 ground_slope; // dy/dx, dy/dz; share of the family's blades that this view shows
out vec3 turn;         // what the bend makes of an upright tangent
out vec2 sway;         // canopy_sway
out vec3 air_added;
out vec3 air_through;
flat out ivec4 image; // as FarInstance: image, planes, axis, level

// The shares were found for blades at rest; what they hang on is the angle between view and blades,
// so bent ones take the view's elevation about their own direction, `bend`.
float family_share(vec3 from_eye, vec2 slope, vec2 bend, int level) {
    vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    vec3 bent =
        normalize(normal + vec3(bend.x, sqrt(max(1.0 - dot(bend, bend), 0.0)) - 1.0, bend.y));
    vec3 to_eye = -normalize(from_eye);
    float upright = dot(to_eye, normal);
    float sine = dot(to_eye, bent);
    // Grass that points at the eye: slices stand edge on and shells have gaps at the ground's own
    // elevation, so that both show more.
#ifdef SLICES
    sine = min(sine, upright);
#else
    sine = sine < upright ? sine : mix(upright, sine, dot(bend, bend));
#endif
    // A breeze leaves the shares as they were found: the spread of blades at rest is wider than its
    // bend.
    sine = mix(upright, sine, smoothstep(0.2, 0.6, length(bend)));
    float at = asin(clamp(sine, 0.0, 0.99999)) * (float(kShareSteps) / (0.5 * kPi));
    int row = int(at);
#ifdef SLICES
    return mix(shares.steps[row].slices, shares.steps[row + 1].slices, at - float(row));
#else
    return mix(shares.steps[row].shells, shares.steps[row + 1].shells, at - float(row))[level];
#endif
}

#ifdef SLICES
BlockSample sample_between(BlockSample a, BlockSample b, float share) {
    return BlockSample(mix(a.height_m, b.height_m, share), mix(a.density, b.density, share),
                       mix(a.sun_cosine, b.sun_cosine, share), mix(a.tint, b.tint, share),
                       mix(a.slope, b.slope, share), mix(a.wind, b.wind, share),
                       mix(a.sway, b.sway, share), mix(a.bend, b.bend, share));
}
#endif

void main() {
    FarInstance instance = instances[gl_InstanceID];
    TerrainBlock block = blocks[instance.block];
    int first = instance.block * kBlockPosts;
    int column = gl_VertexID % (kBlockCells + 1);
    int row = gl_VertexID / (kBlockCells + 1);
    // Cells out of the level's reach collapse: nearby ones would cover most of the screen to be
    // discarded.
    column = clamp(column, instance.along.x, instance.along.y);
#ifdef SLICES
    // Between two lines of the block's grid: a slice meets the very surface that the ground's mesh
    // has there.
    bool across_x = instance.axis == kAxisX;
    vec2 corner = across_x ? block.corner : block.corner.yx;
    float line =
        clamp((instance.place_m - corner.x) / block.spacing_m, 0.0, float(kBlockCells) - 1e-3);
    int line_index = int(line);
    int one = across_x ? line_index + column * (kBlockCells + 1)
                       : column + line_index * (kBlockCells + 1);
    int two = one + (across_x ? 1 : kBlockCells + 1);
    BlockSample here =
        sample_between(samples[first + one], samples[first + two], line - float(line_index));
    float along = corner.y + float(column) * block.spacing_m;
    vec2 xz = across_x ? vec2(instance.place_m, along) : vec2(along, instance.place_m);
    float y = float(row) / rows * frame.canopy_m;
#else
    row = clamp(row, instance.across.x, instance.across.y);
    BlockSample here = samples[first + row * (kBlockCells + 1) + column];
    vec2 xz = block.corner + vec2(column, row) * block.spacing_m;
    float y = instance.place_m;
#endif
    sway = here.sway;
    rest = vec3(xz.x, y, xz.y);
    world = vec3(xz.x, here.height_m + y, xz.y) +
            bend_offset(y, frame.canopy_m, here.wind, frame.wind.response);
    turn = bend_turn(y, frame.canopy_m, here.wind, frame.wind.response);
    ground_here = vec4(here.height_m, here.density, here.sun_cosine, here.tint);
    ground_slope =
        vec3(here.slope, family_share(world - frame.eye, here.slope, here.bend, instance.level));
    AirLight air = haze_of(world - frame.eye);
    air_added = air.added;
    air_through = air.through;
    image = ivec4(instance.image, instance.planes, instance.axis, instance.level);
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
