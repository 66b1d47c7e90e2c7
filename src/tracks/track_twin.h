// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "shared/track.h"

namespace sward::tracks {

/// One page alone on the CPU: what shaders/tracks/change.comp and advance.comp do, by the same
/// functions.
class TrackTwin {
public:
    TrackTwin() : cells(kCount), pressed(kCount, glm::vec2(0)) {}
    void step(const shared::TrackRules& rules, std::span<const shared::TrackPrint> prints,
              glm::vec2 slope);

    [[nodiscard]] shared::TrackCell& at(int x, int z) {
        return cells[static_cast<std::size_t>(z * shared::kTrackCells + x)];
    }
    static constexpr std::size_t kCount = std::size_t{shared::kTrackCells} * shared::kTrackCells;
    std::vector<shared::TrackCell> cells; ///< row by row from the north-west
    std::vector<glm::vec2> pressed;
};

} // namespace sward::tracks
