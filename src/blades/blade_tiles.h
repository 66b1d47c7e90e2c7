// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "blades/pages.h"
#include "grass/grass_set.h"
#include "shared/frame.h"
#include "terrain/frustum.h"
#include "terrain/surface.h"

namespace sward::blades {

/// Work of the cull pass: tiles of the patch that may show geometry, and their blades in chunks of
/// one workgroup.
struct TileList {
    std::vector<shared::BladeTile> tiles;
    std::vector<glm::uvec2> items; ///< tile, first blade
    std::uint64_t considered = 0;  ///< blades in all chunks
};

struct TileQuery {
    glm::dvec3 anchor{0};         ///< world metres
    glm::vec3 eye{0};             ///< anchor-relative, where distances are measured from
    glm::vec2 band{0};            ///< hand-over band (m)
    int mode = 0;                 ///< hand-over mode (shared/lod.h)
    const Pages* pages = nullptr; ///< of the living blades; null: none lives
    float highest = 1;            ///< factor on blades' height (FrameConstants::land_highest)
};

/// Tiles within the band's end that may be seen, nearest first. Inside a tile only the blades whose
/// rank may still be near at the tile's closest point: blades are sorted by rank, so that is a
/// prefix.
[[nodiscard]] TileList select_tiles(const grass::GrassSet& set, const terrain::Surface& surface,
                                    const terrain::Frustum& frustum, const TileQuery& query);

} // namespace sward::blades
