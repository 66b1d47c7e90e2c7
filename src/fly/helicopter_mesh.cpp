// SPDX-License-Identifier: Apache-2.0
#include "fly/helicopter_mesh.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "fly/mesh_parts.h"
#include "scene/mesh_build.h"

namespace sward::fly {
namespace {

using glm::dvec3;

constexpr double kTailRadius = 0.15; // of the main rotor's

/// Thin blades about the y axis: two faces each, for they are seen from both sides.
void add_blades(scene::Mesh& mesh, int count, double radius, double chord) {
    constexpr double kRoot = 0.08, kThick = 0.02;
    for (int i = 0; i < count; ++i) {
        const double angle = glm::two_pi<double>() * i / count;
        const dvec3 along(std::sin(angle), 0, std::cos(angle)), across(along.z, 0, -along.x);
        const auto at = [&](double share, double side, double up) {
            return radius * share * along + chord / 2 * side * across + dvec3(0, up, 0);
        };
        const dvec3 middle = at(0.5, 0, 0);
        for (const double up : {-kThick, kThick})
            scene::add_outward(mesh, middle,
                               {at(kRoot, -1, up), at(1, -1, up), at(1, 1, up), at(kRoot, 1, up)});
        for (const double side : {-1.0, 1.0})
            scene::add_outward(mesh, middle,
                               {at(kRoot, side, -kThick), at(1, side, -kThick), at(1, side, kThick),
                                at(kRoot, side, kThick)});
    }
}

void add_skids(scene::Mesh& mesh, const HelicopterSpec& spec) {
    const double half = spec.skid_length_m / 2, low = -spec.skid_m;
    for (const double side : {-1.0, 1.0}) {
        const double x = side * spec.skid_track_m / 2;
        add_box(mesh, {x - 0.04, low, -half - 0.25}, {x + 0.04, low + 0.08, half});
        for (const double z : {-0.6 * half, 0.6 * half})
            add_box(mesh, {std::min(x, 0.4 * side) - 0.03, low + 0.05, z - 0.03},
                    {std::max(x, 0.4 * side) + 0.03, -0.45, z + 0.03});
    }
}

} // namespace

scene::Mesh helicopter_mesh(const HelicopterSpec& spec) {
    const double l = spec.length_m, chin = spec.eye_m.y - 0.35, ahead = spec.eye_m.z;
    scene::Mesh mesh;
    // Nose, the floor before the pilot, the cabin behind him, engine, boom.
    const std::array<Ring, 6> rings = {Ring{ahead - 0.13 * l, 0.3, -0.55, -0.3},
                                       Ring{ahead - 0.06 * l, 0.6, -0.65, chin},
                                       Ring{ahead + 0.02 * l, 0.68, -0.68, chin},
                                       Ring{ahead + 0.2 * l, 0.6, -0.6, 0.75},
                                       Ring{0.19 * l, 0.2, 0, 0.55},
                                       Ring{spec.tail_m + 0.15, 0.07, 0.25, 0.45}};
    for (std::size_t i = 1; i < rings.size(); ++i)
        add_body(mesh, rings[i - 1], rings[i]);
    add_body(mesh, {ahead + 0.1, 0.62, chin + 0.75, chin + 0.83}, // the roof over the pilot
             {ahead + 0.2 * l, 0.6, 0.7, 0.95});
    for (const double side : {-1.0, 1.0}) // the doors' frames
        add_box(mesh, {side * 0.62 - 0.03, chin - 0.05, ahead + 0.3},
                {side * 0.62 + 0.03, chin + 0.8, ahead + 0.36});
    add_box(mesh, {-0.12, 0.6, -0.18}, {0.12, spec.hub_m, 0.18}); // the mast
    add_box(mesh, {-0.03, 0.1, spec.tail_m - 0.25}, {0.03, 1.3, spec.tail_m + 0.25});
    add_box(mesh, {-0.75, 0.3, spec.tail_m - 1.0}, {0.75, 0.34, spec.tail_m - 0.65});
    add_skids(mesh, spec);
    return mesh;
}

scene::Mesh rotor_mesh(const HelicopterSpec& spec) {
    scene::Mesh mesh;
    add_blades(mesh, spec.rotor.blades, spec.rotor.radius_m, spec.rotor.chord_m);
    add_box(mesh, {-0.15, -0.08, -0.15}, {0.15, 0.1, 0.15});
    return mesh;
}

scene::Mesh tail_rotor_mesh(const HelicopterSpec& spec) {
    scene::Mesh flat;
    add_blades(flat, 2, kTailRadius * spec.rotor.radius_m, 0.14);
    for (glm::vec3& at : flat.positions)
        at = {at.y, at.x, at.z};
    for (glm::vec3& normal : flat.normals)
        normal = {normal.y, normal.x, normal.z};
    for (auto& triangle : flat.triangles) // mirrored so, their fronts are behind
        std::swap(triangle[1], triangle[2]);
    return flat;
}

dvec3 tail_hub(const HelicopterSpec& spec) {
    return {-0.18, 0.5, spec.tail_m};
}

} // namespace sward::fly
