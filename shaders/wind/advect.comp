// SPDX-License-Identifier: Apache-2.0
// In: velocities of the last step (divergence-free), their vorticity, the ambient wind. Out:
// velocities carried along, confined, diffused, dissipated, braked; at an open rim the ambient
// wind's (W2). Back-tracing by the midpoint rule, cubic (Lagrange) interpolation held within what
// the 16 values around span: third order in space where the flow is smooth, no new extremes where
// it is not. What is carried is the velocity with half of the last pressure step already taken off;
// that half is given back at the end, and the projection takes off the whole: pressure acts half
// before and half after, and the splitting loses no energy to first order.
#include "wind/faces.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;
layout(std430, binding = BIND_WIND_U_NEXT) writeonly buffer WindUNext {
    float u_next[];
};
layout(std430, binding = BIND_WIND_V_NEXT) writeonly buffer WindVNext {
    float v_next[];
};
layout(std430, binding = BIND_WIND_WEIGHTS) readonly buffer WindWeights {
    uint weights[];
};
layout(std430, binding = BIND_WIND_LAST_PRESSURE) readonly buffer WindLastPressure {
    float pressure[];
};
#ifdef CONFINEMENT
layout(std430, binding = BIND_WIND_VORTICITY) readonly buffer WindVorticity {
    float vorticity[];
};
#endif
#ifndef PERIODIC
#include "lib/wind_field.glsl"
layout(std140, binding = BIND_WIND_FIELD) uniform WindFieldBlock {
    WindField rim_field;
};
#endif

const float kBrakeLength_m =
    1.0; // what is faster than anything explains loses speed over this length

// Columns and rows of a stencil that begins at logical cell `low`, as storage places.
ivec2 stencil(ivec2 low, int k) {
    return ivec2(stored_column(near_cell(low.x + k)),
                 stored_row(near_cell(low.y + k)) * grid.cells);
}

// Velocity at a place (cells from the corner), bilinear.
vec2 velocity_at(vec2 place) {
    vec2 pu = place - vec2(0.0, 0.5);
    vec2 pv = place - vec2(0.5, 0.0);
    vec2 lu = floor(pu), lv = floor(pv);
    vec2 fu = pu - lu, fv = pv - lv;
    ivec2 u0 = stencil(ivec2(lu), 0), u1 = stencil(ivec2(lu), 1), v0 = stencil(ivec2(lv), 0),
          v1 = stencil(ivec2(lv), 1);
    float u = mix(mix(wind_u[u0.y + u0.x], wind_u[u0.y + u1.x], fu.x),
                  mix(wind_u[u1.y + u0.x], wind_u[u1.y + u1.x], fu.x), fu.y);
    float v = mix(mix(wind_v[v0.y + v0.x], wind_v[v0.y + v1.x], fv.x),
                  mix(wind_v[v1.y + v0.x], wind_v[v1.y + v1.x], fv.x), fv.y);
    return vec2(u, v);
}

// Where the air at `place` was a step ago.
vec2 departure(vec2 place, vec2 velocity) {
    vec2 back = place - velocity_at(place - 0.5 * grid.step_per_m * velocity) * grid.step_per_m;
#ifdef PERIODIC
    float n = float(grid.cells);
    return back - n * floor(back / n);
#else
    return clamp(back, vec2(0.0), vec2(float(grid.cells)));
#endif
}

vec4 cubic_weights(float a) {
    float b = a + 1.0, c = a - 1.0, d = a - 2.0;
    return vec4(-a * c * d / 6.0, b * c * d / 2.0, -b * a * d / 2.0, b * a * c / 6.0);
}

#define CUBIC_AT(name, field)                                                                      \
    float name(vec2 place) {                                                                       \
        vec2 low = floor(place);                                                                   \
        ivec2 first = ivec2(low) - 1;                                                              \
        ivec2 s0 = stencil(first, 0), s1 = stencil(first, 1), s2 = stencil(first, 2),              \
              s3 = stencil(first, 3);                                                              \
        vec4 wx = cubic_weights(place.x - low.x), wy = cubic_weights(place.y - low.y);             \
        vec4 r0 =                                                                                  \
            vec4(field[s0.y + s0.x], field[s0.y + s1.x], field[s0.y + s2.x], field[s0.y + s3.x]);  \
        vec4 r1 =                                                                                  \
            vec4(field[s1.y + s0.x], field[s1.y + s1.x], field[s1.y + s2.x], field[s1.y + s3.x]);  \
        vec4 r2 =                                                                                  \
            vec4(field[s2.y + s0.x], field[s2.y + s1.x], field[s2.y + s2.x], field[s2.y + s3.x]);  \
        vec4 r3 =                                                                                  \
            vec4(field[s3.y + s0.x], field[s3.y + s1.x], field[s3.y + s2.x], field[s3.y + s3.x]);  \
        vec4 low4 = min(min(r0, r1), min(r2, r3)), high4 = max(max(r0, r1), max(r2, r3));          \
        float value = dot(vec4(dot(r0, wx), dot(r1, wx), dot(r2, wx), dot(r3, wx)), wy);           \
        return clamp(value, min(min(low4.x, low4.y), min(low4.z, low4.w)),                         \
                     max(max(high4.x, high4.y), max(high4.z, high4.w)));                           \
    }
CUBIC_AT(cubic_u, wind_u)
CUBIC_AT(cubic_v, wind_v)

#ifdef CONFINEMENT
float spin(ivec2 corner) {
    return vorticity[near_index(corner)];
}

// f = eps h (N x omega), N = grad |omega| / |grad |omega|| (W2). A force that follows |omega| omega
// would need no unit of eps, but outruns what the advection smooths: it ends in noise. x at the
// west face, z at the north face of cell c.
vec2 confinement(ivec2 c) {
    float nw = spin(c), sw = spin(c + ivec2(0, 1)), ne = spin(c + ivec2(1, 0));
    float west = abs(spin(c + ivec2(-1, 0))) + abs(spin(c + ivec2(-1, 1)));
    float east = abs(ne) + abs(spin(c + ivec2(1, 1)));
    float north = abs(spin(c + ivec2(0, -1))) + abs(spin(c + ivec2(1, -1)));
    float south = abs(sw) + abs(spin(c + ivec2(1, 1)));
    vec2 slope_u = vec2(0.25 * (east - west), abs(sw) - abs(nw));
    vec2 slope_v = vec2(abs(ne) - abs(nw), 0.25 * (south - north));
    float omega_u = 0.5 * (nw + sw), omega_v = 0.5 * (nw + ne);
    float fx = omega_u * slope_u.y / (length(slope_u) + 1e-9);
    float fz = -omega_v * slope_v.x / (length(slope_v) + 1e-9);
    return grid.confinement * grid.cell_m * grid.step_s * vec2(fx, fz);
}
#endif

// Pulls a component back where the air is faster than present forces and the ambient wind explain.
float brake(float component, float speed) {
    float excess = max(speed - grid.brake_mps, 0.0);
    float left = grid.brake_mps + excess / (1.0 + excess * grid.step_s / kBrakeLength_m);
    return excess > 0.0 ? component * left / speed : component;
}

float dissipated(float component, float mean) {
    return mean + (component - mean) * grid.kept;
}

bool west_is_rim() {
#ifdef PERIODIC
    return false;
#else
    return true;
#endif
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (!in_grid(c)) {
        return;
    }
    int own = cell_index(c);
    int west = near_index(c - ivec2(1, 0)), east = near_index(c + ivec2(1, 0));
    int north = near_index(c - ivec2(0, 1)), south = near_index(c + ivec2(0, 1));
    int south_west = near_index(c + ivec2(-1, 1)), north_east = near_index(c + ivec2(1, -1));
    float u0 = wind_u[own], v0 = wind_v[own];
    vec2 at_u = vec2(u0, 0.25 * (v0 + wind_v[west] + wind_v[south] + wind_v[south_west]));
    vec2 at_v = vec2(0.25 * (u0 + wind_u[east] + wind_u[north] + wind_u[north_east]), v0);
    vec2 place = vec2(c);
    float u = cubic_u(departure(place + vec2(0.0, 0.5), at_u) - vec2(0.0, 0.5));
    float v = cubic_v(departure(place + vec2(0.5, 0.0), at_v) - vec2(0.5, 0.0));
#ifdef CONFINEMENT
    vec2 push = confinement(c);
    u += push.x;
    v += push.y;
#endif
    ivec2 inner = c - grid.inner_first;
    if (all(greaterThanEqual(inner, ivec2(0))) && all(lessThan(inner, ivec2(grid.inner_cells)))) {
        // Towards the rim a face is open by 2 and pressure behind it is 0; of the far rim's faces
        // no half was taken.
        uint open = weights[own];
        float here = pressure[own];
        u += 0.5 * float(open & 255u) / 64.0 *
             (here - (inner.x == 0 && west_is_rim() ? 0.0 : pressure[west]));
        v += 0.5 * float((open >> 16u) & 255u) / 64.0 *
             (here - (inner.y == 0 && west_is_rim() ? 0.0 : pressure[north]));
    }
    if (grid.diffusion > 0.0) { // explicit: Fluid keeps this number where it is stable
        u += grid.diffusion *
             (wind_u[west] + wind_u[east] + wind_u[north] + wind_u[south] - 4.0 * u0);
        v += grid.diffusion *
             (wind_v[west] + wind_v[east] + wind_v[north] + wind_v[south] - 4.0 * v0);
    }
    u = brake(dissipated(u, grid.mean.x), length(vec2(u, at_u.y)));
    v = brake(dissipated(v, grid.mean.y), length(vec2(at_v.x, v)));
#ifndef PERIODIC
    ivec2 last = ivec2(grid.inner_first + grid.inner_cells);
    ivec2 to_rim = min(c - grid.inner_first, last - 1 - c);
    float depth = float(min(to_rim.x, to_rim.y));
    if (depth < grid.rim_cells) {
        float t = clamp(1.0 - depth / grid.rim_cells, 0.0, 1.0);
        float share = depth < 0.0 ? 1.0 : grid.rim_share * t * t;
        // Faces of the solved cells on their far side stay with the solver.
        float share_u = depth < 0.0 && c.x == last.x && to_rim.y >= 0 ? grid.rim_share : share;
        float share_v = depth < 0.0 && c.y == last.y && to_rim.x >= 0 ? grid.rim_share : share;
        u += (ambient_wind(rim_field, west_face(c)).x - u) * share_u;
        v += (ambient_wind(rim_field, north_face(c)).y - v) * share_v;
    }
#endif
    u_next[own] = sane(u);
    v_next[own] = sane(v);
}
