// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sward::scene {

/// A triangle mesh, every node's transform applied: metres, y up. Every index is inside, every
/// number finite.
struct Mesh {
    std::vector<glm::vec3> positions; ///< at most a coordinate of kMostCoordinate_m
    std::vector<glm::vec3>
        normals; ///< one a position, of length 1; from the triangles where the file has none
    std::vector<glm::vec2> uvs; ///< one a position; empty unless every part of the file has them
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< at least one
};

/// Balls that stand for a mesh: centre in its space, radius (m); the greatest first.
struct SphereSet {
    std::vector<glm::vec4> spheres;
};

inline constexpr float kMostCoordinate_m = 1e6f;

} // namespace sward::scene
