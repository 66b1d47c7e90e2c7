// SPDX-License-Identifier: Apache-2.0
// In: a list of patches that are awake, the wind, their colliders. Out: their blades' states one
// step on (J4 to J6), and which patches have come to rest. The twin is blades::step_blade. One
// program a list: FREE, COLLIDING or NEW. Both sides of a branch cost their time wherever lanes go
// together, in software always; what a list's patches never do is not in its program. PHYSICS_ALL:
// one program for whatever comes, by branches; the bench compares.
#include "blades/physics.glsl"

#if defined(PHYSICS_FREE)
const bool kMeets = false, kBegins = false, kGoesOn = true;
#elif defined(PHYSICS_COLLIDING)
const bool kMeets = true, kBegins = false, kGoesOn = true;
#elif defined(PHYSICS_NEW)
const bool kMeets = true, kBegins = true, kGoesOn = false;
#else // PHYSICS_ALL
const bool kMeets = true, kBegins = true, kGoesOn = true;
#endif

layout(local_size_x = CULL_GROUP) in;
layout(std430, binding = BIND_PHYSICS_STATES) buffer States {
    vec4 states[];
};
layout(std430, binding = BIND_PHYSICS_AWAKE) readonly buffer Awake {
    AwakePatch awake[];
};
layout(std430, binding = BIND_PHYSICS_SPHERES) readonly buffer Spheres {
    vec4 spheres[];
}; // now, radius; before

layout(binding = TEX_PHYSICS_BLADES) uniform samplerBuffer record_texels;

uniform int list_begin;

#ifdef PHYSICS_ALL // as one program for all would do it: each blade looks up its patch, and the
                   // workgroup waits to tell whether it moves
shared uint moving;
shared vec2 patch_wind;

AwakePatch begin_patch() {
    uint patch_id = awake[list_begin + int(gl_WorkGroupID.x)].number;
    AwakePatch found = AwakePatch(
        pages[patch_id / uint(patches_a_page)],
        uvec2(sphere_lists[2u * patch_id], sphere_lists[2u * patch_id + 1u]), patch_id, 0u);
    found.status = awake[list_begin + int(gl_WorkGroupID.x)].status;
    if (gl_LocalInvocationID.x == 0u) {
        moving = 0u;
    }
    barrier();
    return found;
}
PhysicsRecord record_at(uint n) {
    return records[n];
}
void tell_moving(uint patch_id) {
    moving = 1u;
}
void tell_wind(uint patch_id, vec2 wind) {
    patch_wind = wind;
}
void end_patch(AwakePatch entry) {
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        uint next = moving > 0u || entry.colliders.y > 0u ? kPatchAwake : kPatchAsleep;
        patches[entry.number] = PatchState(patch_wind, next, patches[entry.number].steps);
    }
}
#else
AwakePatch begin_patch() {
    return awake[list_begin +
                 int(gl_WorkGroupID.x)]; // the same for all lanes, and known to be: fetched once
}
// As texels: software fetches them for all lanes at once, a storage block's floats one by one.
PhysicsRecord record_at(uint n) {
    int at = 4 * int(n);
    return PhysicsRecord(texelFetch(record_texels, at), texelFetch(record_texels, at + 1),
                         texelFetch(record_texels, at + 2), texelFetch(record_texels, at + 3));
}
void tell_moving(uint patch_id) {
    patches[patch_id].status =
        kPatchAwake; // by any lane; wake.comp has it asleep where nothing meets it
}
void tell_wind(uint patch_id, vec2 wind) {
    patches[patch_id].wind = wind;
}
void end_patch(AwakePatch entry) {}
#endif

// Number in the list of the next sphere that could touch the blade, from `n` on; the list's end:
// none. A loop of its own, so that lanes whose blades are free do not wait for each other's
// spheres.
uint next_near(vec3 root, uvec2 list, uint n, vec3 v1, vec3 v2) {
    while (n < list.y) {
        uint sphere = 2u * sphere_lists[list.x + n];
        vec4 now = spheres[sphere];
        if (sphere_is_near(v1, v2, vec4(now.xyz - root, now.w), spheres[sphere + 1u].xyz - root)) {
            break;
        }
        ++n;
    }
    return n;
}

void collide(BladeBody body, vec3 root, uvec2 list, inout vec3 v1, inout vec3 v2) {
    for (int round = 0; round < kCollisionRounds; ++round) {
        bool touched = false;
        for (uint n = next_near(root, list, 0u, v1, v2); n < list.y;
             n = next_near(root, list, n + 1u, v1, v2)) {
            uint sphere = 2u * sphere_lists[list.x + n];
            vec4 now = spheres[sphere];
            touched = collide_blade(body, v1, v2, vec4(now.xyz - root, now.w),
                                    spheres[sphere + 1u].xyz - root) ||
                      touched;
        }
        if (!touched) {
            return;
        }
    }
}

// Steps the blade; true while it moves or remembers.
bool step_blade(PhysicsRecord blade, vec3 root, vec2 wind, uvec2 list, uint at) {
    BladeBody body = physics_body(blade, root);
    vec4 state = states[at];
    if (!blade_moves(body)) {
        states[at] = vec4(0.0);
        return false;
    }
    vec3 v2 = state_tip(body, state);
    float eta = state.w;
    vec3 v1 = move_blade(rules, body, checked_wind(vec3(wind.x, 0.0, wind.y)), v2, eta);
    if (kMeets) {
        vec3 moved = v2;
        collide(body, root, list, v1, v2);
        eta = remember_push(rules, body, v2 - moved, eta);
    }
    vec4 next = vec4(v2 - body.calm2, eta);
    states[at] = next;
    return next.w > 0.0 || distance(next.xyz, state.xyz) > kStillMove * body.stem_canopy.x;
}

void main() {
    AwakePatch entry = begin_patch();
    uint patch_id = entry.number;
    uvec2 list = entry.colliders;
    uint status = entry.status;
    uint lane = gl_LocalInvocationID.x;
    uint within = (patch_id % uint(patches_a_page)) * uint(CULL_GROUP) + lane;
    if (within < uint(entry.page.blades)) {
        PhysicsRecord blade = physics_laid(entry.page, record_at(uint(entry.page.first) + within));
        vec3 root = physics_root(entry.page, blade, kMeets && (list.y > 0u || needs_height()));
        vec2 wind = physics_wind(root.xz);
        uint at = patch_id * uint(CULL_GROUP) + lane;
        bool moves = true;
        if (kBegins && (!kGoesOn || status == kPatchNew)) {
            BladeBody body = physics_body(blade, vec3(0.0));
            states[at] =
                grouped_state(body, wind, rules.response > 0.0 ? rules.response : body.response);
        }
        // In a run-up a collider finds blades that have not begun.
        if ((kGoesOn && (!kBegins || status != kPatchNew)) ||
            (kBegins && list.y > 0u && rules.step_s > 0.0)) {
            moves = step_blade(blade, root, wind, list, at);
        }
        if (moves) {
            tell_moving(patch_id);
        }
        if (lane == 0u) {
            tell_wind(patch_id, wind);
        }
    }
    end_patch(entry);
}
