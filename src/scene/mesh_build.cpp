// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_build.h"

namespace sward::scene {

void add_quad(Mesh& mesh, const Quad& face) {
    const glm::dvec3 across = glm::cross(face.c - face.a, face.d - face.b);
    const double area = glm::length(across);
    if (!(area > 1e-9))
        return;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::dvec3& corner : {face.a, face.b, face.c, face.d}) {
        mesh.positions.emplace_back(corner);
        mesh.normals.emplace_back(across / area);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
}

void add_outward(Mesh& mesh, const glm::dvec3& middle, const Quad& face) {
    const glm::dvec3 own = (face.a + face.b + face.c + face.d) / 4.0;
    const bool inward = glm::dot(glm::cross(face.c - face.a, face.d - face.b), own - middle) < 0;
    add_quad(mesh, inward ? Quad{face.d, face.c, face.b, face.a} : face);
}

} // namespace sward::scene
