// SPDX-License-Identifier: Apache-2.0
#include "wind/tile_bins.h"

#include <algorithm>
#include <cmath>

#include "shared/bindings.h"

namespace sward::wind {
namespace {

struct TileRange {
    int x0, z0, x1, z1; // both ends included; empty when x1 < x0 or z1 < z0
};

/// A cell's faces are half a cell from its centre: a rim of one cell catches them.
TileRange tiles_of(const glm::vec4& bounds, int cells, double cell_m) {
    const auto tile = [&](double metres, double rim) {
        const double cell = std::clamp(std::floor(metres / cell_m) + rim, -1.0 * WIND_TILE,
                                       1.0 * cells + WIND_TILE);
        return static_cast<int>(std::floor(cell / WIND_TILE));
    };
    const int last = (cells - 1) / WIND_TILE;
    return {std::max(tile(bounds.x, -1), 0), std::max(tile(bounds.y, -1), 0),
            std::min(tile(bounds.z, 1), last), std::min(tile(bounds.w, 1), last)};
}

} // namespace

TileBins bin_tiles(std::span<const glm::vec4> bounds, int cells, double cell_m) {
    const int side = (cells + WIND_TILE - 1) / WIND_TILE;
    std::vector<TileRange> ranges;
    std::vector<std::uint32_t> counts(
        static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
    const auto each_tile = [&](const TileRange& r, auto&& visit) {
        for (int z = r.z0; z <= r.z1; ++z)
            for (int x = r.x0; x <= r.x1; ++x)
                visit(static_cast<std::size_t>(z * side + x));
    };
    for (const glm::vec4& rectangle : bounds) {
        ranges.push_back(tiles_of(rectangle, cells, cell_m));
        each_tile(ranges.back(), [&](std::size_t tile) { ++counts[tile]; });
    }
    TileBins bins;
    std::vector<std::uint32_t> next(counts.size(), 0);
    std::uint32_t first = 0;
    for (std::size_t tile = 0; tile < counts.size(); ++tile) {
        next[tile] = first;
        if (counts[tile] == 0)
            continue;
        const int at = static_cast<int>(tile);
        bins.tiles.emplace_back(at % side, at / side, static_cast<int>(first),
                                static_cast<int>(counts[tile]));
        first += counts[tile];
    }
    bins.items.resize(first);
    for (std::size_t i = 0; i < ranges.size(); ++i)
        each_tile(ranges[i], [&](std::size_t tile) {
            bins.items[next[tile]++] = static_cast<std::uint32_t>(i);
        });
    return bins;
}

} // namespace sward::wind
