// SPDX-License-Identifier: Apache-2.0
#include "tracks/pages.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sward::tracks {

int Pages::slot_of(PageKey key) const {
    const auto found = slot_of_.find({key.y, key.x});
    return found == slot_of_.end() ? -1 : found->second;
}

int Pages::open(PageKey key) {
    const auto free =
        std::find_if(slots_.begin(), slots_.end(), [](const Page& page) { return !page.used; });
    if (free == slots_.end()) {
        return -1;
    }
    const int slot = static_cast<int>(free - slots_.begin());
    *free = Page{};
    free->used = true;
    free->key = key;
    slot_of_[{key.y, key.x}] = slot;
    return slot;
}

void Pages::close(int slot) {
    Page& page = slots_[static_cast<std::size_t>(slot)];
    slot_of_.erase({page.key.y, page.key.x});
    page = {};
}

void Pages::clear() {
    slot_of_.clear();
    std::fill(slots_.begin(), slots_.end(), Page{});
}

int Pages::least_needed(std::span<const glm::dvec2> places, std::int64_t step,
                        std::span<const PageKey> kept) const {
    int worst = -1;
    std::pair<bool, double> worst_at{false, -1};
    for (const auto& [unused, slot] : slot_of_) {
        const Page& page = slots_[static_cast<std::size_t>(slot)];
        if (std::find(kept.begin(), kept.end(), page.key) != kept.end()) {
            continue;
        }
        double nearest = std::numeric_limits<double>::max();
        const glm::dvec2 low = corner(page.key);
        for (const glm::dvec2& place : places) {
            nearest =
                std::min(nearest, glm::distance(place, glm::clamp(place, low, low + side_m_)));
        }
        const std::pair<bool, double> at{page.busy_until < step, nearest};
        if (worst < 0 || at > worst_at) {
            worst = slot;
            worst_at = at;
        }
    }
    return worst;
}

PageKey Pages::key_at(glm::dvec2 xz) const {
    return PageKey(glm::floor(xz / side_m_));
}

std::vector<int> Pages::in_order() const {
    std::vector<int> out;
    for (const auto& [key, slot] : slot_of_) {
        out.push_back(slot);
    }
    return out;
}

int Pages::table_size() const {
    int size = 64;
    while (size < 4 * static_cast<int>(slots_.size())) {
        size *= 2;
    }
    return size;
}

std::vector<glm::ivec4> Pages::table() const {
    const int mask = table_size() - 1;
    std::vector<glm::ivec4> out(static_cast<std::size_t>(mask) + 1, {0, 0, -1, 0});
    for (const auto& [key, slot] : slot_of_) {
        const PageKey page(key.second, key.first);
        int at = shared::track_hash(page) & mask;
        while (out[static_cast<std::size_t>(at)].z >= 0) {
            at = (at + 1) & mask;
        }
        const auto& blocks = slots_[static_cast<std::size_t>(slot)].blocks;
        const bool moves = std::any_of(blocks.begin(), blocks.end(),
                                       [](const Block& block) { return block.place >= 0; });
        out[static_cast<std::size_t>(at)] = {page.x, page.y, slot, moves ? 1 : 0};
    }
    for (const Page& page : slots_) {
        for (std::size_t n = 0; n < page.blocks.size(); n += 4) {
            out.emplace_back(page.blocks[n].place, page.blocks[n + 1].place,
                             page.blocks[n + 2].place, page.blocks[n + 3].place);
        }
    }
    return out;
}

} // namespace sward::tracks
