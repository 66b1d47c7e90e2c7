// SPDX-License-Identifier: Apache-2.0
#include "fly/aeroplane_mesh.h"

#include <array>
#include <cstddef>

#include "fly/mesh_parts.h"

namespace sward::fly {

scene::Mesh aeroplane_mesh(const AeroplaneSpec& spec) {
    const double l = spec.length_m, half_span = spec.span_m / 2, chord = spec.chord_m,
                 chin = spec.eye_m.y - 0.3, wing = spec.eye_m.y + 0.3;
    scene::Mesh mesh;
    const std::array<Ring, 5> rings = {
        Ring{-0.32 * l, 0.28, -0.35, 0.02}, Ring{-0.2 * l, 0.45, -0.45, chin - 0.2},
        Ring{0.02 * l, 0.5, -0.5, chin}, Ring{0.2 * l, 0.45, -0.4, chin + 0.15},
        Ring{0.64 * l, 0.08, 0, 0.3}};
    for (std::size_t i = 1; i < rings.size(); ++i)
        add_body(mesh, rings[i - 1], rings[i]);
    add_box(mesh, {-half_span, wing, -0.35 * chord}, {half_span, wing + 0.12, 0.65 * chord});
    for (const double side :
         {-1.0, 1.0}) { // what holds it: struts of the cabin, one behind the pilot too
        add_box(mesh, {side * 0.5 - 0.03, chin - 0.1, -0.3 * chord},
                {side * 0.5 + 0.03, wing, -0.3 * chord + 0.05});
        add_box(mesh, {side * 0.46 - 0.03, chin, 0.6 * chord},
                {side * 0.46 + 0.03, wing, 0.6 * chord + 0.05});
        const double wheel = side * spec.gear_track_m / 2;
        add_box(mesh, {wheel - 0.08, -spec.gear_m, spec.gear_back_m - 0.2},
                {wheel + 0.08, 0.4 - spec.gear_m, spec.gear_back_m + 0.2});
    }
    add_box(mesh, {-spec.gear_track_m / 2, 0.3 - spec.gear_m, spec.gear_back_m - 0.05},
            {spec.gear_track_m / 2, 0.36 - spec.gear_m, spec.gear_back_m + 0.05});
    add_box(mesh, {-0.07, -spec.gear_m, -spec.gear_ahead_m - 0.18},
            {0.07, 0.36 - spec.gear_m, -spec.gear_ahead_m + 0.18});
    add_box(mesh, {-0.04, 0.3 - spec.gear_m, -spec.gear_ahead_m - 0.04},
            {0.04, -0.3, -spec.gear_ahead_m + 0.04});
    add_box(mesh, {-0.16 * spec.span_m, 0.25, 0.55 * l}, {0.16 * spec.span_m, 0.31, 0.64 * l});
    add_box(mesh, {-0.04, 0.2, 0.54 * l}, {0.04, 1.4, 0.66 * l});
    return mesh;
}

} // namespace sward::fly
