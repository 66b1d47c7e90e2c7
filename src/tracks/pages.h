// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "shared/track_field.h"

namespace sward::tracks {

/// A page of the world by its number east and south; page (0, 0) begins at x = z = 0.
using PageKey = glm::ivec2;

/// Which pages have a slot of the pool (methods.md C6). Neighbours share their cells' rims: a cell
/// beside a page's end reads the next page's.
class Pages {
public:
    /// A part of a page that moves, or did.
    struct Block {
        int place = -1;               ///< in the pool of what moves; -1: at rest
        std::int64_t busy_until = -1; ///< last step that moves it
    };
    struct Page {
        bool used = false;
        PageKey key{0, 0};
        std::int64_t busy_until = -1; ///< last step that moves any of it
        std::array<Block, shared::kTrackBlocks> blocks{};
        glm::vec2 slope{0, 0}; ///< of its ground dy/dx, dy/dz
        bool shown = false;    ///< what is drawn of it is what it holds
    };

    Pages(int most, double side_m) : side_m_(side_m), slots_(static_cast<std::size_t>(most)) {}

    /// Slot of a page, -1: none.
    [[nodiscard]] int slot_of(PageKey key) const;
    /// A slot for a page that has none; -1: all are taken.
    int open(PageKey key);
    void close(int slot);
    void clear();
    /// The page farthest from all of the places (world x, z) that is not busy at `step`, else the
    /// farthest that is; never one of `kept`. -1: none.
    [[nodiscard]] int least_needed(std::span<const glm::dvec2> places, std::int64_t step,
                                   std::span<const PageKey> kept) const;

    [[nodiscard]] PageKey key_at(glm::dvec2 xz) const;
    [[nodiscard]] glm::dvec2 corner(PageKey key) const { return glm::dvec2(key) * side_m_; }
    [[nodiscard]] double side_m() const { return side_m_; }
    [[nodiscard]] std::vector<Page>& slots() { return slots_; }
    [[nodiscard]] const std::vector<Page>& slots() const { return slots_; }
    [[nodiscard]] std::size_t used() const { return slot_of_.size(); }
    /// Slots in the order of their keys, which no order of arrival changes.
    [[nodiscard]] std::vector<int> in_order() const;

    /// The table that shaders look pages up in: page x, z, slot, 1 where something moves; a power
    /// of two of entries, at least four a page; then of every slot the places of its blocks.
    [[nodiscard]] std::vector<glm::ivec4> table() const;
    [[nodiscard]] int table_size() const;

private:
    double side_m_;
    std::vector<Page> slots_;
    std::map<std::pair<int, int>, int> slot_of_;
};

} // namespace sward::tracks
