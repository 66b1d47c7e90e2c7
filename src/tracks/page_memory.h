// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "tracks/pages.h"

namespace sward::tracks {

/// All that a page holds.
struct PageContent {
    std::vector<std::uint32_t> pressed; ///< words of track_pack(), in units of `epoch`
    std::vector<std::int64_t>
        moving; ///< blocks that move: number in the page, last step that moves it
    std::vector<glm::vec4> bends, changes; ///< of their cells: theta, omega; their changes
    std::int64_t epoch = 0;
};

/// Pages that are out of the pool, as they were, bit for bit: compressed without loss, on a budget.
/// Over it those that were put first go.
class PageMemory {
public:
    explicit PageMemory(std::size_t most_bytes) : most_bytes_(most_bytes) {}

    /// Keeps a page; true if nothing was lost for it.
    bool put(PageKey key, const PageContent& content);
    /// Hands a page back, once.
    [[nodiscard]] std::optional<PageContent> take(PageKey key);
    [[nodiscard]] bool has(PageKey key) const { return kept_.contains({key.y, key.x}); }
    [[nodiscard]] std::vector<PageKey> keys() const;
    /// As take(), but it stays.
    [[nodiscard]] std::optional<PageContent> look(PageKey key) const;
    void clear();
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    [[nodiscard]] std::size_t lost() const { return lost_; } ///< pages, for want of budget

private:
    struct Kept {
        std::vector<std::byte> packed;
        std::uint64_t order = 0;
        std::int64_t epoch = 0;
        std::size_t moving = 0; ///< numbers in PageContent::moving
    };
    std::size_t most_bytes_, bytes_ = 0, lost_ = 0;
    std::uint64_t order_ = 0;
    std::map<std::pair<int, int>, Kept> kept_;
};

} // namespace sward::tracks
