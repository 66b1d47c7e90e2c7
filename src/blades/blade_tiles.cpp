// SPDX-License-Identifier: Apache-2.0
#include "blades/blade_tiles.h"

#include <algorithm>
#include <cmath>

#include "shared/bindings.h"
#include "shared/tile_lie.h"

namespace sward::blades {

namespace {

struct Candidate {
    glm::ivec2 tile;
    glm::vec2 corner;
    float nearest;
};

std::vector<Candidate> candidates(const grass::GrassSet& set, const terrain::Surface& surface,
                                  const terrain::Frustum& frustum, const TileQuery& query) {
    std::vector<Candidate> out;
    const double side = set.side_m;
    const glm::dvec2 eye(query.anchor.x + query.eye.x, query.anchor.z + query.eye.z);
    const glm::ivec2 low(glm::floor((eye - static_cast<double>(query.band.y)) / side));
    const glm::ivec2 high(glm::floor((eye + static_cast<double>(query.band.y)) / side));
    for (int tz = low.y; tz <= high.y; ++tz) {
        for (int tx = low.x; tx <= high.x; ++tx) {
            const glm::dvec2 corner_world = glm::dvec2(tx, tz) * side;
            const glm::vec2 corner(corner_world - glm::dvec2(query.anchor.x, query.anchor.z));
            const glm::vec2 gap = glm::max(
                glm::max(corner - glm::vec2(query.eye.x, query.eye.z),
                         glm::vec2(query.eye.x, query.eye.z) - corner - static_cast<float>(side)),
                glm::vec2(0));
            if (glm::length(gap) > query.band.y) {
                continue;
            }
            // Ground over a tile: its middle and what a steep slope adds; blades reach out by their
            // height.
            const double middle =
                surface.height(corner_world.x + side / 2, corner_world.y + side / 2) -
                query.anchor.y;
            const double slack = 1.5 * side;
            const float reach = set.canopy_m * 1.2f * query.highest;
            const glm::vec3 box_low(corner.x - reach, middle - slack, corner.y - reach);
            const glm::vec3 box_high(corner.x + side + reach, middle + slack + reach,
                                     corner.y + side + reach);
            const float drop = static_cast<float>(std::max(query.eye.y - middle - slack, 0.0));
            const float nearest = std::sqrt(glm::dot(gap, gap) + drop * drop);
            if (nearest < query.band.y && frustum.may_see(box_low, box_high)) {
                out.push_back({{tx, tz}, corner, nearest});
            }
        }
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.nearest < b.nearest; });
    return out;
}

} // namespace

TileList select_tiles(const grass::GrassSet& set, const terrain::Surface& surface,
                      const terrain::Frustum& frustum, const TileQuery& query) {
    TileList list;
    for (const Candidate& candidate : candidates(set, surface, frustum, query)) {
        const auto variant =
            static_cast<std::size_t>(shared::tile_variant(candidate.tile, set.variants));
        const std::uint32_t first = set.variant_begin[variant];
        const auto begin = set.blades.begin() + first;
        const auto end = set.blades.begin() + set.variant_begin[variant + 1];
        const auto last = std::partition_point(begin, end, [&](const shared::BladeRecord& blade) {
            return shared::handover_may_be_near(blade.root.z, candidate.nearest, query.band,
                                                query.mode);
        });
        const auto count = static_cast<std::uint32_t>(last - begin);
        for (std::uint32_t chunk = 0; chunk < count; chunk += CULL_GROUP) {
            list.items.emplace_back(list.tiles.size(), first + chunk);
        }
        if (count > 0) {
            const int page = query.pages ? query.pages->slot_of(candidate.tile) + 1 : 0;
            list.tiles.push_back({candidate.corner, first + count, static_cast<shared::uint>(page),
                                  shared::tile_lie(candidate.tile), 0, 0, 0});
            list.considered += count;
        }
    }
    return list;
}

} // namespace sward::blades
