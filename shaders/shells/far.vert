// SPDX-License-Identifier: Apache-2.0
// In: shells or slices of a block (instances). Out: their vertices, bent by the closed form of B3 at the wind of their place.
// Texture coordinates stay those of the rest pose.
#include "lib/ground.glsl"
#include "lib/wind.glsl"
#include "shared/bend.h"

layout(std430, binding = BIND_FAR_INSTANCES) readonly buffer Instances { FarInstance instances[]; };

out vec3 world;
out vec3 rest;        // x, z at rest (world), height above the ground at rest
out vec4 ground_here; // height of the ground (world y), grass density, cosine to the sun, tint
out vec2 ground_slope; // dy/dx, dy/dz
flat out ivec4 image;

void main() {
    FarInstance instance = instances[gl_InstanceID];
    vec2 cell = vec2(gl_VertexID % 9, gl_VertexID / 9);
    vec2 xz;
    float y;
#ifdef SLICES
    float along = instance.place.y + cell.x * instance.place.z;
    xz = instance.image.z == kAxisX ? vec2(instance.place.x, along) : vec2(along, instance.place.x);
    y = cell.y / 3.0 * frame.patch_grid.w;
#else
    xz = instance.place.xy + cell * instance.place.z;
    y = instance.place.w;
#endif
    Ground ground = ground_surface(xz);
    float base = ground_at(xz);
    rest = vec3(xz.x, y, xz.y);
    world = vec3(xz.x, base + y, xz.y) + bend_offset(y, frame.patch_grid.w, wind_at(xz), frame.wind.mean.w);
    ground_here = vec4(base, ground.density, dot(ground.normal, frame.light.to_sun.xyz), ground.tint);
    ground_slope = -ground.normal.xz / max(ground.normal.y, 0.1);
    image = instance.image;
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
