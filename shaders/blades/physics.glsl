// SPDX-License-Identifier: Apache-2.0
// What the two passes of the blades' physics share. SURFACE: of a mesh's blades, a page a cluster.
#include "lib/wind_field.glsl"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"
#ifdef SURFACE
#include "shared/surface_blade.h"
#else
#include "lib/ground.glsl"
#include "lib/track.glsl"
#include "shared/tile_lie.h"
#endif

layout(std140, binding = BIND_PHYSICS) uniform PhysicsBlock {
    BladeStep rules;
    WindField step_wind; // at the step's end
};
#ifdef SURFACE
#define PhysicsRecord SurfaceBlade
#else
#define PhysicsRecord BladeRecord
#endif
layout(std430, binding = BIND_PHYSICS_BLADES) readonly buffer Records {
    PhysicsRecord records[];
};
layout(std430, binding = BIND_PHYSICS_PAGES) readonly buffer Pages {
    BladePage pages[];
};
layout(std430, binding = BIND_PHYSICS_PATCHES) buffer Patches {
    PatchState patches[];
};
layout(std430, binding = BIND_PHYSICS_LISTS) readonly buffer Lists {
    uint sphere_lists[];
}; // first, count of each patch; then numbers

uniform int patches_a_page;
uniform int buffer_number; // of the records that are bound: BladePage::records

// Where something draws to a centre, the root's height matters to blades that nothing meets too.
bool needs_height() {
    return rules.centre_share > 0.0;
}

// A record as it lies on its page's tile.
PhysicsRecord physics_laid(BladePage page, PhysicsRecord blade) {
#ifdef SURFACE
    return blade;
#else
    return lay_blade(page.lie, blade, page.side_m);
#endif
}

// Root of a blade of a page, anchor-relative. The root's height matters to colliders and to a
// centre of gravity alone: without `high` it may be 0.
vec3 physics_root(BladePage page, PhysicsRecord blade, bool high) {
#ifdef SURFACE
    return page.origin + blade.root_direction.xyz;
#else
    vec2 xz = page.origin.xz + blade.root.xy;
    return vec3(xz.x, high ? ground_at(xz) : 0.0, xz.y);
#endif
}

#ifdef SURFACE
vec2 physics_wind(vec2 xz) {
    return wind_of(step_wind, xz);
}
#else
// What bends a living blade at a place: the wind, what lies there and holds it down, and the bend
// that passes. Each blade by its own response: what presses asks not how stiff it is. Of the bend
// `own` is left out, what a blade's own contacts stand for.
vec2 physics_wind(vec2 xz, float response, float own) {
    vec2 wind = wind_of(step_wind, xz);
    if (has_tracks()) {
        TrackSeen track = track_at(xz, 0.0);
        wind = sway_wind(wind, response, track.theta * (1.0 - own), sway_pressed(track));
    }
    return wind;
}

// The same for blades that begin, and for a patch as a whole: as grouped ones have it.
vec2 physics_wind(vec2 xz) {
    return physics_wind(xz, rules.response > 0.0 ? rules.response : frame.wind.response, 0.0);
}
#endif

BladeBody physics_body(PhysicsRecord blade, vec3 root) {
#ifdef SURFACE
    return surface_blade_body(rules, blade, root);
#else
    return set_blade_body(rules, blade, root);
#endif
}
