// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace sward::wind {

/// Which things touch which tiles of WIND_TILE x WIND_TILE logical cells, so that a pass costs what
/// they cover and not cells times things.
struct TileBins {
    std::vector<glm::ivec4>
        tiles; ///< column, row, first of `items`, how many; only tiles that something touches
    std::vector<std::uint32_t> items; ///< numbers of things, rising within a tile
};

/// `bounds`: least x, z, most x, z from the window's north-west corner (m). What lies outside
/// touches nothing.
[[nodiscard]] TileBins bin_tiles(std::span<const glm::vec4> bounds, int cells, double cell_m);

} // namespace sward::wind
