// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "scene/heightfield.h"
#include "scene/land.h"

namespace sward::scene {

/// What lies at a place, as wheels and other programs ask.
struct GroundCover {
    bool known = false;                    ///< false: beyond the terrain, or a scene on a mesh
    double grass = 0;                      ///< share of the blades that could stand, 0 to 1
    bool grows = true;                     ///< false: most of it bears no grass whatever
    bool shore = false;                    ///< some of it is water
    GroundKind ground = GroundKind::kSoil; ///< most of what bears no grass; soil where none does

    static constexpr double kBareShare = 0.05; ///< less grass is none
    [[nodiscard]] bool bare() const { return !grows || grass < kBareShare; }
};

/// A terrain's mask for the CPU, two bytes a texel: the texel under a place. Pictures fray the
/// borders by up to a third of a metre, which this does not.
class GroundCoverMap {
public:
    /// Keeps what it needs of both.
    GroundCoverMap(const Heightfield& ground, const DensityMask& mask);
    /// `normal`: of the ground there, whose slope says what stands where there is no mask.
    [[nodiscard]] GroundCover at(glm::dvec2 place, glm::vec3 normal) const;

private:
    struct Texel {
        std::uint8_t share = 0; ///< of the blades, times 255
        std::uint8_t land = 0;  ///< GroundKind, and the bits kBare and kShore
    };
    static Texel texel_of(double share, const std::uint8_t* land);

    glm::dvec2 extent_;
    int width_, height_;
    glm::dvec2 first_, size_;
    std::optional<Texel> outside_; ///< beyond the mask's rectangle; none: its rim goes on
    std::vector<Texel> texels_;
};

} // namespace sward::scene
