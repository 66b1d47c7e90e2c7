// SPDX-License-Identifier: Apache-2.0
// In: all patches. Out: those that have something to do in this step, in three lists: one for each
// program of the physics pass and its indirect dispatch.
#include "blades/physics.glsl"

layout(local_size_x = WAKE_GROUP) in;
layout(std430, binding = BIND_PHYSICS_AWAKE) writeonly buffer Awake {
    AwakePatch awake[];
}; // patch_count a list
layout(std430, binding = BIND_PHYSICS_DISPATCH) buffer Dispatch {
    uvec4 dispatch[kPatchLists]; // groups of a list; 1, 1; unused
    uint stepped[kPatchLists];   // of all steps since the count began
};
uniform int patch_count;

void main() {
    uint patch_id = gl_GlobalInvocationID.x;
    if (patch_id >= uint(patch_count)) {
        return;
    }
    BladePage page = pages[patch_id / uint(patches_a_page)];
    if (page.records != buffer_number) {
        return;
    }
    PatchState state = patches[patch_id];
    uvec2 spheres = uvec2(sphere_lists[2u * patch_id], sphere_lists[2u * patch_id + 1u]);
    bool met = spheres.y > 0u;
    bool up = met && state.status != kPatchFree;
    if (state.status == kPatchNew) {
        up = met || rules.run_up == 0;
    } else if (rules.step_s == 0.0) {
        up = false;
    } else if (state.status == kPatchAwake) {
        up = true;
    } else if (state.status == kPatchAsleep && !met) {
        PhysicsRecord first = physics_laid(
            page, records[page.first + int(patch_id % uint(patches_a_page)) * CULL_GROUP]);
        vec3 root = physics_root(page, first, false);
        up = distance(physics_wind(root.xz), state.wind) > kStillWind_mps;
    }
    if (up) {
        uint list = state.status == kPatchNew ? kListNew
                    : met || needs_height()   ? kListColliding
                                              : kListFree;
        // The order varies from run to run; patches know nothing of each other.
        awake[list * uint(patch_count) + atomicAdd(dispatch[list].x, 1u)] =
            AwakePatch(page, spheres, patch_id, state.status);
        atomicAdd(stepped[list], 1u);
        // It comes to rest, unless a blade says that it moves: so no workgroup has to wait for its
        // last one.
        patches[patch_id].status = met ? kPatchAwake : kPatchAsleep;
        patches[patch_id].steps = state.status == kPatchNew ? 0u : state.steps + 1u;
    }
}
