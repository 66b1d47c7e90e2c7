// SPDX-License-Identifier: Apache-2.0
// How a grass set lies on a mesh: in charts, each a flat view of the triangles that face its way,
// on which the set's patches are laid as on level ground. The placement of blades and the far field
// call the same functions, so that both have the same grass at a place.
#ifndef SWARD_SHARED_SURFACE_CHART_H
#define SWARD_SHARED_SURFACE_CHART_H
#include "shared/surface_blade.h"
#include "shared/types.h"

SHARED_BEGIN

// To the faces, edges and corners of a cube: a surface is never off its chart's direction by more
// than 27.4 degrees.
SHARED_CONST int kCharts = 26;

// Unit direction that a chart faces.
SHARED_FN vec3 chart_up(int chart) {
    int n = chart < 13 ? chart : chart + 1; // the 13th of 27 has no direction
    return normalize(vec3(float(n % 3 - 1), float(n / 3 % 3 - 1), float(n / 9 - 1)));
}

// The chart of a triangle with this normal.
SHARED_FN int chart_of(vec3 normal) {
    int best = 0;
    float most = -2.0f;
    for (int i = 0; i < kCharts; ++i) {
        float along = dot(chart_up(i), normal);
        best = along > most ? i : best;
        most = max(along, most);
    }
    return best;
}

// The patch's x on a chart, as a direction in the mesh's space; its z is square to it and to
// chart_up.
SHARED_FN vec3 chart_east(int chart) {
    return surface_width_direction(chart_up(chart), 0.0f);
}

// Place on the chart (m) of a point of the mesh's space: x, z of the grass there, as of a field's.
SHARED_FN vec2 chart_place(int chart, vec3 point) {
    vec3 east = chart_east(chart);
    return vec2(dot(point, east), dot(point, cross(east, chart_up(chart))));
}

// The patch's axes on a surface of unit normal `up`: those of the chart, laid down on it.
struct SurfaceFrame {
    vec3 east;
    vec3 up;
    vec3 south;
};
SHARED_FN SurfaceFrame surface_frame(int chart, vec3 up) {
    SurfaceFrame frame;
    vec3 east = chart_east(chart);
    frame.up = up;
    frame.east = normalize(east - up * dot(east, up));
    frame.south = cross(frame.east, up);
    return frame;
}

// Of a vector of the patch, in the mesh's space; and back.
SHARED_FN vec3 from_surface(SurfaceFrame frame, vec3 v) {
    return frame.east * v.x + frame.up * v.y + frame.south * v.z;
}
SHARED_FN vec3 to_surface(SurfaceFrame frame, vec3 v) {
    return vec3(dot(frame.east, v), dot(frame.up, v), dot(frame.south, v));
}

// Slow variation over a mesh, 0..1: two waves whose lengths are metres.
SHARED_FN float surface_tint(vec3 place) {
    return 0.5f + 0.25f * (sin(dot(place, vec3(1.9f, 0.7f, 1.3f))) +
                           sin(dot(place, vec3(-0.8f, 1.7f, 2.3f)) + 2.0f));
}

SHARED_END
#endif
