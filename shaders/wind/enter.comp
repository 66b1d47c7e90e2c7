// SPDX-License-Identifier: Apache-2.0
// In: the ambient wind. Out: the state of cells that the window has just come to; the others are
// not touched.
#include "lib/wind_field.glsl"
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_U_CARRIED) writeonly buffer WindUCarried {
    float u_carried[];
};
layout(std430, binding = BIND_WIND_V_ENTERING) writeonly buffer WindVEntering {
    float v_carried[];
};
layout(std430, binding = BIND_WIND_PRESSURE) writeonly buffer WindPressure {
    float pressure[];
};
layout(std430, binding = BIND_WIND_EARLIER_PRESSURE) writeonly buffer WindEarlierPressure {
    float earlier_pressure[];
};
layout(std430, binding = BIND_WIND_CELLS) writeonly buffer WindCells {
    vec4 cells[];
};
layout(std140, binding = BIND_WIND_FIELD) uniform WindFieldBlock {
    WindField rim_field;
};
layout(location = 0) uniform ivec4 kept; // logical cells that stay: first x, z; end x, z

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c) || (all(greaterThanEqual(c, kept.xy)) && all(lessThan(c, kept.zw)))) {
        return;
    }
    int own = cell_index(c);
    vec2 centre = ambient_wind(rim_field, cell_centre(c));
    float u = ambient_wind(rim_field, west_face(c)).x, v = ambient_wind(rim_field, north_face(c)).y;
    wind_u[own] = u;
    u_carried[own] = u;
    wind_v[own] = v;
    v_carried[own] = v;
    cells[own] = vec4(centre, centre);
    pressure[own] = 0.0;
    earlier_pressure[own] = 0.0;
}
