// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_build.h"

namespace sward::scene {

void add_quad(Mesh& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    const glm::dvec3 across = glm::cross(c - a, d - b);
    const double area = glm::length(across);
    if (!(area > 1e-9))
        return;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::dvec3& corner : {a, b, c, d}) {
        mesh.positions.emplace_back(corner);
        mesh.normals.emplace_back(across / area);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

void add_outward(Mesh& mesh, const glm::dvec3& middle, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
    if (glm::dot(glm::cross(c - a, d - b), (a + b + c + d) / 4.0 - middle) < 0)
        add_quad(mesh, d, c, b, a);
    else
        add_quad(mesh, a, b, c, d);
}

} // namespace sward::scene
