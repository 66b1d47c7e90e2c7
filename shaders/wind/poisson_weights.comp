// SPDX-License-Identifier: Apache-2.0
// In: solid cells (level 0), or the weights of the finer level. Out: weights of this level.
#include "wind/poisson.glsl"
#include "wind/solids.glsl"

layout(local_size_x = WIND_GROUP_X, local_size_y = WIND_GROUP_Y) in;

float open_face(ivec2 c, ivec2 other) {
    ivec2 near = held(0, other);
    bool closed = grid.has_solids != 0 && !beyond(0, other) && wind_solid[element(0, near)] != 0u;
    return closed ? 0.0 : beyond(0, other) ? 2.0 : 1.0;
}

vec4 fine_weights(ivec2 c) {
    return unpack_weights(weights[element(level - 1, held(level - 1, c))]);
}

// A coarse face in one row of finer ones: the one that lies on it. Where that one is open and a
// wall only closes the one before (an inner face of the coarse cell to the west or north), the
// coarse face closes in its place: no wall is lost, however thin.
float in_row(float face, float before, float before_that) {
    return before == 0.0 && before_that > 0.0 ? 0.0 : face;
}

float west_of(ivec2 c) {
    return beyond(level - 1, c) ? 1.0 : fine_weights(c).x;
}
float north_of(ivec2 c) {
    return beyond(level - 1, c) ? 1.0 : fine_weights(c).z;
}

float west_face_of(ivec2 c) { // of the coarse cell that begins with fine cell c
    float first = in_row(fine_weights(c).x, west_of(c - ivec2(1, 0)), west_of(c - ivec2(2, 0)));
    float second = in_row(fine_weights(c + ivec2(0, 1)).x, west_of(c + ivec2(-1, 1)),
                          west_of(c + ivec2(-2, 1)));
    return 0.5 * (first + second);
}
float east_face_of(ivec2 c) {
    float first = in_row(fine_weights(c + ivec2(1, 0)).y, west_of(c + ivec2(1, 0)), west_of(c));
    float second =
        in_row(fine_weights(c + ivec2(1, 1)).y, west_of(c + ivec2(1, 1)), west_of(c + ivec2(0, 1)));
    return 0.5 * (first + second);
}
float north_face_of(ivec2 c) {
    float first = in_row(fine_weights(c).z, north_of(c - ivec2(0, 1)), north_of(c - ivec2(0, 2)));
    float second = in_row(fine_weights(c + ivec2(1, 0)).z, north_of(c + ivec2(1, -1)),
                          north_of(c + ivec2(1, -2)));
    return 0.5 * (first + second);
}
float south_face_of(ivec2 c) {
    float first = in_row(fine_weights(c + ivec2(0, 1)).w, north_of(c + ivec2(0, 1)), north_of(c));
    float second = in_row(fine_weights(c + ivec2(1, 1)).w, north_of(c + ivec2(1, 1)),
                          north_of(c + ivec2(1, 0)));
    return 0.5 * (first + second);
}

void main() {
    ivec2 c = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(c, ivec2(side_of(level))))) {
        return;
    }
    int own = element(level, c);
    if (level == 0) {
        vec4 w = vec4(open_face(c, c - ivec2(1, 0)), open_face(c, c + ivec2(1, 0)),
                      open_face(c, c - ivec2(0, 1)), open_face(c, c + ivec2(0, 1)));
        bool solid = grid.has_solids != 0 && wind_solid[own] != 0u;
        weights[own] = solid ? 0u : pack_weights(w);
    } else {
        ivec2 f = 2 * c;
        weights[own] = pack_weights(
            vec4(west_face_of(f), east_face_of(f), north_face_of(f), south_face_of(f)));
    }
}
