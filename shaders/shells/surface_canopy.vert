// SPDX-License-Identifier: Apache-2.0
// In: a mesh's canopy (SurfaceCanopy). Out: its upper surface, lifted along the normals as high as
// the wind leaves it (B1), and walls where the grass ends.
#include "lib/wind.glsl"
#include "shared/bend.h"
#include "shared/march_medium.h"

layout(std140, binding = BIND_MARCH) uniform MarchBlock {
    MarchMedium medium;
};

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec3
    curve_squares; // diagonal of the shape operator, in the mesh's space (1/m)
layout(location = 3) in vec3 curve_products; // its yz, zx, xy
layout(location = 4) in vec2 chart_lift; // chart; 2 on top; of a wall 1 at its top, 0 on the ground
uniform vec4 surface_origin;
uniform float lift; // 1; 0: the ground itself

out vec3 world;
out vec3 normal;
out vec3 squares;
out vec3 products;
out vec3 wind;
out float height;
out float room;   // over its height on level ground: less over a hollow, more on a ridge
out float on_top; // 1: of the top; a wall's is never above 0
flat out int chart;

// Most that a surface of this shape may be lifted without a fold (m): not past where the normals of
// a hollow meet.
float most_lift() {
    float sum = curve_squares.x + curve_squares.y + curve_squares.z;
    float product = curve_squares.x * curve_squares.y + curve_squares.y * curve_squares.z +
                    curve_squares.z * curve_squares.x -
                    dot(curve_products, curve_products); // of the two curvatures: the third is 0
    float least = 0.5 * sum - sqrt(max(0.25 * sum * sum - product, 0.0));
    return 0.35 / max(-least, 1e-6);
}

// On a ridge, what leans aside stands higher over the ground beside its root than over that: by so
// much of its height, in the mean over the ways it may lean.
float reached_over(float top) {
    float upright = clamp(medium.layers[kMarchLayers / 2].x, 0.55, 1.0);
    float aside = sqrt(1.0 - upright * upright) / upright;
    float bend = max(0.5 * (curve_squares.x + curve_squares.y + curve_squares.z), 0.0) * top;
    float away = 1.0 + bend; // from the middle of the curve, in its radii
    float farther = bend * aside;
    return bend > 0.0 ? (sqrt(away * away + farther * farther) - away) / bend : 0.0;
}

void main() {
    vec3 root = position + surface_origin.xyz;
    float canopy = frame.canopy_m;
    vec2 level = wind_at(root.xz);
    normal = normal_in;
    wind = vec3(level.x, 0.0, level.y) - normal * dot(normal, vec3(level.x, 0.0, level.y)); // B2
    float top =
        canopy + bend_offset(canopy, canopy, vec2(length(wind), 0.0), frame.wind.response).y;
    height = lift * top * min(chart_lift.y, 1.0);
    on_top = chart_lift.y - 1.0;
    room = min(most_lift() / top, 1.0) + reached_over(top);
    world = root + normal * (height * room);
    squares = curve_squares;
    products = curve_products;
    chart = int(chart_lift.x + 0.5);
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
}
