// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"
#include "shared/wind_solid.h"
#include "wind/carrier.h"
#include "wind/footprint.h"

namespace sward::wind {

/// The meshes that a scene's obstacles name, under the names it gives them.
using Meshes = std::map<std::filesystem::path, scene::Mesh>;

/// The obstacles of a scene, from time to a list.
class SolidList {
public:
    /// Throws Error(kBadInput), with the scene's file, for a mesh that is not there or that its
    /// height does not meet.
    SolidList(const scene::Scene& scene, const Meshes& meshes);

    [[nodiscard]] bool empty() const { return obstacles_.empty(); }
    /// At `time_s`, relative to `origin` (world x, z, m). Boxes and circles are at least a cell
    /// thick, so that no wall falls between the centres of cells. In the order of the file: where
    /// two overlap, the later one's velocity counts.
    [[nodiscard]] std::vector<shared::WindSolid> at(double time_s, glm::dvec2 origin) const;
    /// Bits of all footprints; WindSolid::first_word is the first word of its own. At least one
    /// word.
    [[nodiscard]] const std::vector<std::uint32_t>& words() const { return words_; }

private:
    struct Print {
        std::size_t first_word = 0;
        glm::dvec2 corner_m{0, 0};
        double bit_m = 0;
        int width = 0, height = 0;
    };
    std::vector<scene::WindObstacle> obstacles_;
    std::vector<std::size_t> print_of_; ///< one an obstacle
    std::vector<Print> prints_;
    std::vector<std::uint32_t> words_{0};
    Paths paths_;
    double cell_m_ = 0;
};

/// The rectangle that holds a solid: least x, z, most x, z (m).
[[nodiscard]] glm::vec4 solid_bounds(const shared::WindSolid& solid);
/// Whether a solid covers a place, footprints included: the twin of shaders/wind/solids.comp.
[[nodiscard]] bool covers(const shared::WindSolid& solid, glm::vec2 xz,
                          const std::vector<std::uint32_t>& words);

} // namespace sward::wind
