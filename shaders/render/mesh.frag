// SPDX-License-Identifier: Apache-2.0
// In: a mesh: the ground under its grass, or an object. Out: its light: the sun's by Lambert, the
// sky's, the air.
#include "lib/ground.glsl"
#include "lib/land_shadow.glsl"
#include "lib/output.glsl"

in vec3 world;
in vec3 normal;
uniform float density; // of the grass on it
uniform vec4 colour;   // reflectance; tier
uniform vec4 bare;     // reflectance where the surface is too steep for grass; least cosine of its
                       // slope that grass stands on

void main() {
    vec3 face = normalize(cross(dFdx(world), dFdy(world)));
    vec3 from_eye = world - frame.eye;
    face *= dot(face, from_eye) > 0.0 ? -1.0 : 1.0; // toward the eye, whichever way it is wound
    vec3 n = normalize(normal + 1e-6 * face);
    n = dot(n, face) < 0.0 ? -n : n;
    bool grows = (gl_FrontFacing ? face.y : -face.y) >= bare.w;
    float sun =
        frame.has_shadow < 0.5 ? 1.0 : sun_seen(world.xz, max(world.y - ground_at(world.xz), 0.0));
    vec3 radiance = shade_soil(light_in_sway(frame.light, vec2(sun, 1.0)),
                               grows ? colour.rgb : bare.rgb, n, grows ? density : 0.0);
    AirLight air = haze_of(from_eye);
    write_surface(radiance * air.through + air.added, vec3(colour.w, 0.0, 0.0), vec3(0.0), n);
}
