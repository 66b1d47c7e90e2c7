// SPDX-License-Identifier: Apache-2.0
#include "blades/pages.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "shared/bindings.h"
#include "shared/hash.h"

namespace sward::blades {

namespace {

constexpr int kMortonBits = 12;         // half a millimetre on a 2 m side
constexpr double kGroundSlack_m = 0.15; // what relief may do between the samples

std::uint32_t spread_bits(std::uint32_t v) {
    v = (v | v << 8) & 0x00ff00ffu;
    v = (v | v << 4) & 0x0f0f0f0fu;
    v = (v | v << 2) & 0x33333333u;
    return (v | v << 1) & 0x55555555u;
}

std::uint32_t morton(glm::vec2 root, float side) {
    const glm::vec2 cells =
        glm::clamp(root / side, 0.0f, 0.99999f) * static_cast<float>(1 << kMortonBits);
    return spread_bits(static_cast<std::uint32_t>(cells.x)) |
           spread_bits(static_cast<std::uint32_t>(cells.y)) << 1;
}

/// Distance from a place to a tile on the ground: over its middle's height, less what a slope adds.
double nearest_of(const terrain::Surface& surface, glm::dvec3 eye, glm::dvec2 corner, double side) {
    const glm::dvec2 flat(eye.x, eye.z);
    const glm::dvec2 gap = glm::max(glm::max(corner - flat, flat - corner - side), glm::dvec2(0));
    const double drop =
        std::max(eye.y - surface.height(corner.x + side / 2, corner.y + side / 2) - side, 0.0);
    return std::sqrt(glm::dot(gap, gap) + drop * drop);
}

} // namespace

MortonOrder::MortonOrder(const grass::GrassSet& set) : places(set.blades.size()) {
    blades.resize(set.blades.size());
    std::iota(blades.begin(), blades.end(), 0u);
    for (std::size_t v = 0; v + 1 < set.variant_begin.size(); ++v) {
        const auto begin = blades.begin() + set.variant_begin[v],
                   end = blades.begin() + set.variant_begin[v + 1];
        std::stable_sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
            return morton(glm::vec2(set.blades[a].root), set.side_m) <
                   morton(glm::vec2(set.blades[b].root), set.side_m);
        });
        box_begin.push_back(boxes.size());
        const auto count = static_cast<std::size_t>(end - begin);
        for (std::size_t n = 0; n < count; ++n) {
            const glm::vec2 root(set.blades[begin[static_cast<std::ptrdiff_t>(n)]].root);
            if (n % CULL_GROUP == 0) {
                boxes.emplace_back(root, root);
            }
            boxes.back() = glm::vec4(glm::min(glm::vec2(boxes.back()), root),
                                     glm::max(glm::vec2(boxes.back().z, boxes.back().w), root));
            places[begin[static_cast<std::ptrdiff_t>(n)]] = static_cast<std::uint32_t>(n);
        }
        patches_a_page =
            std::max(patches_a_page, static_cast<int>((count + CULL_GROUP - 1) / CULL_GROUP));
    }
    box_begin.push_back(boxes.size());
}

Pages::Pages(const grass::GrassSet& set, Settings settings)
    : settings_(settings), side_m_(set.side_m), variants_(set.variants), order_(set) {
    const std::size_t page_bytes =
        static_cast<std::size_t>(order_.patches_a_page) * CULL_GROUP * sizeof(glm::vec4);
    if (page_bytes == 0 || settings.radius_m <= 0) {
        return;
    }
    const auto across = static_cast<std::size_t>(2 * std::ceil(settings.radius_m / side_m_) + 1);
    slots_.resize(std::min(across * across * static_cast<std::size_t>(std::max(settings.eyes, 1)),
                           settings.most_bytes / page_bytes));
}

std::vector<Pages::Wish> Pages::wishes(const terrain::Surface& surface,
                                       std::span<const glm::dvec3> eyes) const {
    std::map<std::pair<int, int>, double> near; // z, x: distance to the nearest eye
    for (const glm::dvec3& eye : eyes) {
        const glm::dvec2 flat(eye.x, eye.z);
        const glm::ivec2 low(glm::floor((flat - settings_.radius_m) / side_m_)),
            high(glm::floor((flat + settings_.radius_m) / side_m_));
        for (int z = low.y; z <= high.y; ++z) {
            for (int x = low.x; x <= high.x; ++x) {
                const double nearest =
                    nearest_of(surface, eye, glm::dvec2(x, z) * side_m_, side_m_);
                if (nearest < settings_.radius_m) {
                    double& least = near.try_emplace({z, x}, nearest).first->second;
                    least = std::min(least, nearest);
                }
            }
        }
    }
    std::vector<Wish> out;
    for (const auto& [place, nearest] : near) {
        out.push_back({{place.second, place.first}, nearest});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Wish& a, const Wish& b) { return a.nearest < b.nearest; });
    return out;
}

void Pages::open(int slot, glm::ivec2 tile, const terrain::Surface& surface) {
    Page page{true, tile, shared::tile_variant(tile, variants_), {1e30, -1e30}};
    constexpr int kSamples = 4; // each way; posts of the finest grid on a side of 2 m
    for (int j = 0; j <= kSamples; ++j) {
        for (int i = 0; i <= kSamples; ++i) {
            const glm::dvec2 at =
                (glm::dvec2(tile) + glm::dvec2(i, j) / static_cast<double>(kSamples)) * side_m_;
            const double height = surface.height(at.x, at.y);
            page.ground = {std::min(page.ground.x, height - kGroundSlack_m),
                           std::max(page.ground.y, height + kGroundSlack_m)};
        }
    }
    slots_[static_cast<std::size_t>(slot)] = page;
    slot_of_[{tile.x, tile.y}] = slot;
    fresh_.push_back(slot);
}

void Pages::update(const terrain::Surface& surface, std::span<const glm::dvec3> eyes) {
    fresh_.clear();
    reach_m_ = 0;
    if (slots_.empty()) {
        return;
    }
    auto wanted = wishes(surface, eyes);
    reach_m_ = settings_.radius_m;
    if (wanted.size() > slots_.size()) {
        reach_m_ = wanted[slots_.size()].nearest;
        wanted.resize(slots_.size());
    }
    std::set<std::pair<int, int>> keep;
    for (const Wish& wish : wanted) {
        keep.insert({wish.tile.x, wish.tile.y});
    }
    std::erase_if(slot_of_, [&](const auto& entry) {
        if (keep.contains(entry.first)) {
            return false;
        }
        slots_[static_cast<std::size_t>(entry.second)] = {};
        return true;
    });
    int slot = 0;
    for (const Wish& wish : wanted) {
        if (!slot_of_.contains({wish.tile.x, wish.tile.y})) {
            while (slots_[static_cast<std::size_t>(slot)].used) {
                ++slot;
            }
            open(slot, wish.tile, surface);
        }
    }
}

void Pages::clear() {
    slot_of_.clear();
    fresh_.clear();
    reach_m_ = 0;
    std::fill(slots_.begin(), slots_.end(), Page{});
}

int Pages::slot_of(glm::ivec2 tile) const {
    const auto found = slot_of_.find({tile.x, tile.y});
    return found == slot_of_.end() ? -1 : found->second;
}

} // namespace sward::blades
