// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "scene/mesh.h"

namespace sward::tracks {

/// A mesh as grass meets it (methods.md C4): how low it reaches over every place of its own frame,
/// and the contour that it has at grass height with the way out of it.
struct Underside {
    std::vector<glm::vec4> texels; ///< as shared/track_map.h has it; empty: nothing to meet
    float lowest_m = 0;            ///< over the mesh's origin
    float reach_m = 0;             ///< of the farthest place from its origin, in plan
    glm::dvec2 middle{0}, half{0}; ///< of the map in the mesh's frame (m)
};

/// What counts is what comes within two canopies of the mesh's lowest point: the rest touches
/// nothing while the mesh stands or hovers. Parts narrower than a cell count as a cell wide, or
/// their strips would have gaps. Texels are half a cell, or larger where a mesh would take more
/// than shared::kMostMapSide of them a side; what is farther than `most_m` from the origin is left
/// out. Parts may overlap and the mesh may be open: only what is lowest counts. A second for a
/// million triangles.
[[nodiscard]] Underside underside_of(const scene::Mesh& mesh, double cell_m, double canopy_m,
                                     double most_m);

/// Undersides one after the other, as the passes and their twin read them.
struct UndersideMaps {
    std::vector<glm::vec4> texels; ///< at least one
    std::vector<int> first;        ///< of each underside
};
[[nodiscard]] UndersideMaps joined(std::span<const Underside> undersides);

} // namespace sward::tracks
