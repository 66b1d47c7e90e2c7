// SPDX-License-Identifier: Apache-2.0
// What the two passes of the blades' physics share.
#include "lib/ground.glsl"
#include "lib/wind_field.glsl"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"

layout(std140, binding = BIND_PHYSICS) uniform PhysicsBlock {
    BladeStep rules;
    WindField step_wind; // at the step's end
};
layout(std430, binding = BIND_PHYSICS_BLADES) readonly buffer Records { BladeRecord records[]; };
layout(std430, binding = BIND_PHYSICS_PAGES) readonly buffer Pages { BladePage pages[]; };
layout(std430, binding = BIND_PHYSICS_PATCHES) buffer Patches { PatchState patches[]; };
layout(std430, binding = BIND_PHYSICS_LISTS) readonly buffer Lists { uint sphere_lists[]; }; // first, count of each patch; then numbers

uniform int patches_a_page;
