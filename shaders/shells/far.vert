// SPDX-License-Identifier: Apache-2.0
// In: shells or slices of a block (instances). Out: their vertices, bent by the closed form of B3 at the wind of their place.
// Texture coordinates stay those of the rest pose.
#include "lib/frame.glsl"
#include "shared/bend.h"

layout(std430, binding = BIND_FAR_INSTANCES) readonly buffer Instances { FarInstance instances[]; };
layout(std430, binding = BIND_TERRAIN_BLOCKS) readonly buffer Blocks { TerrainBlock blocks[]; };
layout(std430, binding = BIND_BLOCK_SAMPLES) readonly buffer Samples { BlockSample samples[]; };
layout(std140, binding = BIND_FAR_SHARES) uniform SharesBlock { FarShares shares; };
uniform float rows; // of a slice's strip

out vec3 world;
out vec3 rest;        // x, z at rest (world), height above the ground at rest
out vec4 ground_here; // height of the ground (world y), grass density, cosine to the sun, tint
out vec3 ground_slope; // dy/dx, dy/dz; share of the family's blades that this view shows
out vec3 turn;          // what the bend makes of an upright tangent
out vec2 sway;          // canopy_sway
out vec3 air_added;
out vec3 air_through;
flat out ivec4 image;

// The shares were found for blades at rest; what they hang on is the angle between view and blades, so bent ones take the view's
// elevation about their own direction, `bend`.
float family_share(vec3 from_eye, vec2 slope, vec2 bend, int level) {
    vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    vec3 bent = normalize(normal + vec3(bend.x, sqrt(max(1.0 - dot(bend, bend), 0.0)) - 1.0, bend.y));
    vec3 to_eye = -normalize(from_eye);
    float upright = dot(to_eye, normal);
    float sine = dot(to_eye, bent);
    // Grass that points at the eye: slices stand edge on and shells have gaps at the ground's own elevation, so that both show more.
#ifdef SLICES
    sine = min(sine, upright);
#else
    sine = sine < upright ? sine : mix(upright, sine, dot(bend, bend));
#endif
    // A breeze leaves the shares as they were found: the spread of blades at rest is wider than its bend.
    sine = mix(upright, sine, smoothstep(0.2, 0.6, length(bend)));
    float at = asin(clamp(sine, 0.0, 0.99999)) * (float(kShareSteps) / (0.5 * kPi));
    int row = int(at);
#ifdef SLICES
    return mix(shares.slices[row].x, shares.slices[row + 1].x, at - float(row));
#else
    return mix(shares.shells[row], shares.shells[row + 1], at - float(row))[level];
#endif
}

void main() {
    FarInstance instance = instances[gl_InstanceID];
    int block_index = int(instance.place.y);
    TerrainBlock block = blocks[block_index];
    int first = block_index * kBlockPosts;
    int column = gl_VertexID % (kBlockCells + 1);
    int row = gl_VertexID / (kBlockCells + 1);
    // Cells out of the level's reach collapse: nearby ones would cover most of the screen to be discarded.
    column = clamp(column, int(instance.place.z) & 15, int(instance.place.z) >> 4);
#ifdef SLICES
    // Between two lines of the block's grid: a slice meets the very surface that the ground's mesh has there.
    bool across_x = instance.image.z == kAxisX;
    vec2 corner = across_x ? block.place.xy : block.place.yx;
    float line = clamp((instance.place.x - corner.x) / block.place.z, 0.0, float(kBlockCells) - 1e-3);
    int line_index = int(line);
    int one = across_x ? line_index + column * (kBlockCells + 1) : column + line_index * (kBlockCells + 1);
    int two = one + (across_x ? 1 : kBlockCells + 1);
    BlockSample a = samples[first + one];
    BlockSample b = samples[first + two];
    vec4 ground = mix(a.ground, b.ground, line - float(line_index));
    vec4 motion = mix(a.motion, b.motion, line - float(line_index));
    vec4 swaying = mix(a.sway, b.sway, line - float(line_index));
    float along = corner.y + float(column) * block.place.z;
    vec2 xz = across_x ? vec2(instance.place.x, along) : vec2(along, instance.place.x);
    float y = float(row) / rows * frame.patch_grid.w;
#else
    row = clamp(row, int(instance.place.w) & 15, int(instance.place.w) >> 4);
    BlockSample here = samples[first + row * (kBlockCells + 1) + column];
    vec4 ground = here.ground;
    vec4 motion = here.motion;
    vec4 swaying = here.sway;
    vec2 xz = block.place.xy + vec2(column, row) * block.place.z;
    float y = instance.place.x;
#endif
    sway = swaying.xy;
    vec2 bend = swaying.zw;
    rest = vec3(xz.x, y, xz.y);
    world = vec3(xz.x, ground.x + y, xz.y) + bend_offset(y, frame.patch_grid.w, motion.zw, frame.wind.mean.w);
    turn = bend_turn(y, frame.patch_grid.w, motion.zw, frame.wind.mean.w);
    ground_here = ground;
    ground_slope = vec3(motion.xy, family_share(world - frame.eye.xyz, motion.xy, bend, instance.image.w));
    AirLight air = haze_of(world - frame.eye.xyz);
    air_added = air.added;
    air_through = air.through;
    image = instance.image;
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
