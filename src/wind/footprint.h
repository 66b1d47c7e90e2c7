// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/mesh.h"

namespace sward::wind {

/// What a mesh covers at one height, in bits of its own frame (x east, z south at yaw 0). Row 0 is
/// the least z.
struct Footprint {
    glm::dvec2 corner_m{0, 0}; ///< least x, z
    double bit_m = 0;
    int width = 0, height = 0; ///< bits; 0: the height meets no triangle
    std::vector<std::uint32_t>
        words; ///< bit b at words[b / 32] >> (b % 32); b = row * width + column

    [[nodiscard]] bool at(int column, int row) const {
        const auto bit = static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(column);
        return (words[bit / 32] >> (bit % 32) & 1U) != 0;
    }
};

/// Cuts the triangles at `height_m` (above the mesh's origin) and fills the contour where its
/// winding number is not 0, so that parts may overlap and walls may enclose a yard. A row whose
/// contour is open is not filled. Whatever lies within half a cell of the contour is covered too: a
/// cell that a wall touches is solid, however thin the wall. Bits are a quarter of a cell, or
/// larger where a footprint would take more than 4096 a side.
[[nodiscard]] Footprint footprint_of(const scene::Mesh& mesh, double height_m, double cell_m);

} // namespace sward::wind
