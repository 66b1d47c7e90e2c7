// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "grass/grass_set.h"
#include "shared/blade_pages.h"
#include "terrain/surface.h"

namespace sward::blades {

/// Second order of a set's blades: inside each variant along a Morton curve over the patch, so that
/// CULL_GROUP neighbours in it are neighbours on the ground: J3's compact clusters of equal count.
struct MortonOrder {
    explicit MortonOrder(const grass::GrassSet& set);
    std::vector<std::uint32_t>
        blades; ///< of the set, in the new order; variant_begin holds for it too
    std::vector<std::uint32_t> places; ///< of each blade of the set within its variant's order
    std::vector<glm::vec4>
        boxes; ///< least x, z, most x, z of the roots of each patch, variant by variant
    std::vector<std::size_t> box_begin; ///< of each variant in `boxes`
    int patches_a_page = 0;             ///< of the largest variant
};

/// Tiles near the eye that own living blades, in slots of a bounded pool. Which ones depends on the
/// eye's place alone.
class Pages {
public:
    struct Settings {
        double radius_m =
            8; ///< tiles nearer than this have a page; memory and time grow with its square
        std::size_t most_bytes =
            64ull
            << 20; ///< of all states, 16 a blade; when they are spent the farthest tiles go without
        int eyes = 1; ///< that there is room for, wherever they are
    };
    struct Page {
        bool used = false;
        glm::ivec2 tile{0};
        int variant = 0;
        glm::dvec2 ground{0}; ///< lowest and highest (m above the datum)
    };

    Pages(const grass::GrassSet& set, Settings settings);

    /// Pages in and out for the tiles near any of the eyes (world metres, y above the datum). A
    /// tile that keeps its page keeps its slot.
    void update(const terrain::Surface& surface, std::span<const glm::dvec3> eyes);
    void update(const terrain::Surface& surface, glm::dvec3 eye) { update(surface, {&eye, 1}); }
    /// Drops all.
    void clear();

    /// Slot of a tile, -1: none.
    [[nodiscard]] int slot_of(glm::ivec2 tile) const;
    [[nodiscard]] const std::vector<Page>& slots() const { return slots_; }
    /// Slots that the last update gave to tiles without one.
    [[nodiscard]] const std::vector<int>& fresh() const { return fresh_; }
    /// Every blade nearer than this to one of the last update's eyes has a page (m).
    [[nodiscard]] double reach_m() const { return reach_m_; }
    [[nodiscard]] const MortonOrder& order() const { return order_; }
    [[nodiscard]] std::size_t used() const { return slot_of_.size(); }

private:
    struct Wish {
        glm::ivec2 tile;
        double nearest;
    };
    [[nodiscard]] std::vector<Wish> wishes(const terrain::Surface& surface,
                                           std::span<const glm::dvec3> eyes) const;
    void open(int slot, glm::ivec2 tile, const terrain::Surface& surface);

    Settings settings_;
    double side_m_;
    int variants_;
    MortonOrder order_;
    std::vector<Page> slots_;
    std::map<std::pair<int, int>, int> slot_of_;
    std::vector<int> fresh_;
    double reach_m_ = 0;
};

} // namespace sward::blades
