// SPDX-License-Identifier: Apache-2.0
// The blocks of pages that move: which are woken, what a step does to each, when they are at rest
// again.
#include <algorithm>
#include <array>
#include <cmath>

#include "tracks/tracks.h"

namespace sward::tracks {

namespace {

constexpr double kWakeBeyond_m = 1.5; // of a print: so far waves run before they are nothing

/// Blocks of a page that a print meets, or comes within `beyond` of (m); none: low over high.
struct BlockRange {
    glm::ivec2 low{0}, high{0};
};

BlockRange blocks_of(const Pages& pages, PageKey key, const Print& print, double beyond) {
    const double side = pages.side_m() / shared::kTrackRow;
    const glm::dvec2 corner = pages.corner(key), last(shared::kTrackRow - 1);
    return {glm::ivec2(glm::clamp(glm::floor((print.low - beyond - corner) / side), glm::dvec2(0),
                                  last + 1.0)),
            glm::ivec2(glm::clamp(glm::floor((print.high + beyond - corner) / side), glm::dvec2(-1),
                                  last))};
}

bool meets(const Print& print, glm::dvec2 low, glm::dvec2 high) {
    return print.high.x >= low.x && print.low.x <= high.x && print.high.y >= low.y &&
           print.low.y <= high.y;
}

} // namespace

/// Blocks that have come to rest: what is left of their bends is nothing (steps_to_rest), and they
/// cost nothing from here on. With k = 0 bends stay.
void Tracks::settle(std::int64_t number) {
    for (Pages::Page& page : pages_.slots()) {
        if (!page.used || page.busy_until < 0 || spec_.recovery_per_s2 <= 0) {
            continue;
        }
        for (Block& block : page.blocks) {
            if (block.place >= 0 && block.busy_until < number) {
                lay_to_rest(block);
                page.shown = false;
            }
        }
    }
}

void Tracks::lay_to_rest(Block& block) {
    free_places_.push_back(block.place);
    --places_used_;
    block = {};
    table_changed_ = true;
}

/// A place in the pool of what moves, set to nothing; of a block that is nearest to rest where all
/// are taken. -1: none is nearer to it than `until`.
int Tracks::take_place(std::int64_t until) {
    const int most = spec_.pages * kMovingBlocksAPage;
    if (free_places_.empty() && places_ever_ < most) {
        free_places_.push_back(places_ever_++);
        pass_.reserve(0, places_ever_);
    }
    if (free_places_.empty()) {
        Pages::Page* of_page = nullptr;
        Block* nearest = nullptr;
        for (const int slot : pages_.in_order()) {
            Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
            for (Block& block : page.blocks) {
                if (block.place >= 0 && block.busy_until < until &&
                    (nearest == nullptr || block.busy_until < nearest->busy_until)) {
                    nearest = &block;
                    of_page = &page;
                }
            }
        }
        ++stilled_;
        if (nearest == nullptr) {
            return -1;
        }
        lay_to_rest(*nearest);
        of_page->shown = false;
    }
    const int place = free_places_.back();
    free_places_.pop_back();
    ++places_used_;
    table_changed_ = true;
    return place;
}

void Tracks::wake(const std::vector<Print>& prints, std::int64_t number, bool full) {
    std::vector<PageKey> kept;
    for (const Print& print : prints) {
        const double beyond = full ? kWakeBeyond_m : 0;
        const PageKey low = pages_.key_at(print.low - beyond),
                      high = pages_.key_at(print.high + beyond);
        for (int z = low.y; z <= high.y; ++z) {
            for (int x = low.x; x <= high.x; ++x) {
                const bool there = std::find(kept.begin(), kept.end(), PageKey(x, z)) != kept.end();
                if (!there && kept.size() >= pages_.slots().size()) {
                    ++refused_;
                    continue;
                }
                const int slot = bring({x, z}, kept);
                if (slot < 0) {
                    continue;
                }
                if (!there) {
                    kept.emplace_back(x, z);
                }
                if (full) {
                    wake_blocks(slot, print, number + settle_steps_);
                }
            }
        }
    }
}

void Tracks::wake_blocks(int slot, const Print& print, std::int64_t until) {
    Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
    const BlockRange range = blocks_of(pages_, page.key, print, kWakeBeyond_m);
    for (int z = range.low.y; z <= range.high.y; ++z) {
        for (int x = range.low.x; x <= range.high.x; ++x) {
            Block& block = page.blocks[static_cast<std::size_t>(z * shared::kTrackRow + x)];
            if (block.place < 0) {
                block.place = take_place(until);
                if (block.place < 0) {
                    continue;
                }
                pass_.clear_block(block.place);
            }
            block.busy_until = std::max(block.busy_until, until);
            page.busy_until = std::max(page.busy_until, until);
        }
    }
}

/// Place in the pool of what moves of a block beside a page's, which may be another page's; -1: at
/// rest.
int Tracks::place_of(PageKey key, glm::ivec2 block) const {
    constexpr int kRow = shared::kTrackRow;
    const glm::ivec2 over(block.x < 0       ? -1
                          : block.x >= kRow ? 1
                                            : 0,
                          block.y < 0       ? -1
                          : block.y >= kRow ? 1
                                            : 0);
    const int slot = pages_.slot_of(key + over);
    block -= over * kRow;
    return slot < 0 ? -1
                    : pages_.slots()[static_cast<std::size_t>(slot)]
                          .blocks[static_cast<std::size_t>(block.y * kRow + block.x)]
                          .place;
}

TrackPass::Work Tracks::work_of(const std::vector<Print>& prints, std::int64_t number) const {
    constexpr int kRow = shared::kTrackRow;
    TrackPass::Work work;
    for (const int slot : pages_.in_order()) {
        const Pages::Page& page = pages_.slots()[static_cast<std::size_t>(slot)];
        const glm::dvec2 corner = pages_.corner(page.key);
        const bool met = std::any_of(prints.begin(), prints.end(), [&](const Print& print) {
            return meets(print, corner, corner + pages_.side_m());
        });
        if (!met && page.busy_until < number) {
            continue;
        }
        std::array<std::vector<const Print*>, shared::kTrackBlocks> touching;
        for (const Print& print : prints) {
            const BlockRange range = blocks_of(pages_, page.key, print, 0);
            for (int z = range.low.y; z <= range.high.y; ++z) {
                for (int x = range.low.x; x <= range.high.x; ++x) {
                    touching[static_cast<std::size_t>(z * kRow + x)].push_back(&print);
                }
            }
        }
        for (int n = 0; n < shared::kTrackBlocks; ++n) {
            const Block& block = page.blocks[static_cast<std::size_t>(n)];
            const auto& touched = touching[static_cast<std::size_t>(n)];
            const bool moves = block.place >= 0 && block.busy_until >= number;
            if (!moves && touched.empty()) {
                continue;
            }
            const glm::ivec2 at(n % kRow, n / kRow);
            shared::TrackBlock out{};
            out.slot = slot;
            out.first_print = static_cast<int>(work.prints.size());
            out.prints = static_cast<int>(touched.size());
            out.first_cell = at * shared::kTrackBlock;
            out.own = block.place;
            out.beside = {place_of(page.key, at - glm::ivec2(1, 0)),
                          place_of(page.key, at + glm::ivec2(1, 0)),
                          place_of(page.key, at - glm::ivec2(0, 1)),
                          place_of(page.key, at + glm::ivec2(0, 1))};
            out.slope = page.slope;
            for (const Print* print : touched) {
                work.prints.push_back(print->from(corner));
            }
            (moves ? work.moving : work.resting).push_back(out);
        }
    }
    return work;
}

} // namespace sward::tracks
