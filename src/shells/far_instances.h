// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "grass/grass_set.h"
#include "lod/lod.h"
#include "shared/frame.h"
#include "terrain/terrain_pass.h"

namespace sward::shells {

/// Shells and slices to draw, per far level, nearest block first; inside a block shells from the
/// top down and slices from the near side on, so that the depth test spares most hidden fragments.
struct FarList {
    std::array<std::vector<shared::FarInstance>, shared::kMaxFarLevels> shells, slices;
};

struct FarQuery {
    glm::vec3 eye{0};          ///< anchor-relative
    glm::vec3 lod_eye{0};      ///< anchor-relative, where distances are measured from
    glm::vec2 patch_offset{0}; ///< of the anchor in its patch (m)
    bool alone = false;        ///< the far tier from the eye's feet on
    int forced_level = -1;
    shared::FarShares shares{}; ///< of the blades, that the families show
    glm::vec2 bend{0}; ///< where the mean wind turns an upright blade: x, z of a unit vector
};

[[nodiscard]] FarList select_far(const grass::GrassSet& set,
                                 const std::vector<terrain::VisibleBlock>& blocks,
                                 const lod::Bands& bands, const FarQuery& query);

} // namespace sward::shells
