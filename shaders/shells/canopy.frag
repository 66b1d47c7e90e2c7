// SPDX-License-Identifier: Apache-2.0
// In: the canopy's upper surface. Out: what a ray that enters it there has to know of the ground
// and the air.
layout(location = 0) out vec4 out_ground;
layout(location = 1) out vec4 out_air;

in vec4 ground;
in vec4 air;

void main() {
    out_ground = ground;
    out_air = air;
}
