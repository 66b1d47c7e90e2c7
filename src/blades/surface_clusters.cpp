// SPDX-License-Identifier: Apache-2.0
// Equal-count compact clusters (J3). The paper balances a k-means; medians of a box's longest side
// give runs of exactly one size in n log n, and as compact.
#include <algorithm>
#include <cmath>

#include "blades/surface_placement.h"

namespace sward::blades {

namespace {

constexpr int kMortonBits = 10; // a side

std::uint32_t spread(std::uint32_t x) {
    x &= 0x3ffu;
    x = (x | (x << 16)) & 0x30000ffu;
    x = (x | (x << 8)) & 0x300f00fu;
    x = (x | (x << 4)) & 0x30c30c3u;
    return (x | (x << 2)) & 0x9249249u;
}

class Splitter {
public:
    Splitter(const std::vector<glm::vec3>& places, std::size_t size)
        : places_(places), size_(size), order_(places.size()) {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            order_[i] = static_cast<std::uint32_t>(i);
        }
    }

    std::vector<std::uint32_t> run() {
        std::vector<std::pair<std::size_t, std::size_t>> todo = {{0, order_.size()}};
        while (!todo.empty()) {
            const auto [first, last] = todo.back();
            todo.pop_back();
            const std::size_t runs = (last - first + size_ - 1) / size_;
            const auto [low, high] = box(first, last);
            if (runs <= 1) {
                sort_morton(first, last, low, high);
                continue;
            }
            const glm::vec3 side = high - low;
            const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
            const std::size_t middle = first + size_ * (runs / 2);
            std::nth_element(at(first), at(middle), at(last),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return places_[a][axis] != places_[b][axis]
                                            ? places_[a][axis] < places_[b][axis]
                                            : a < b;
                             });
            todo.emplace_back(middle, last); // the near half first, so that neighbours in the list
                                             // are neighbours in space
            todo.emplace_back(first, middle);
        }
        return std::move(order_);
    }

private:
    std::vector<std::uint32_t>::iterator at(std::size_t i) {
        return order_.begin() + static_cast<std::ptrdiff_t>(i);
    }

    [[nodiscard]] std::pair<glm::vec3, glm::vec3> box(std::size_t first, std::size_t last) const {
        glm::vec3 low(places_.empty() ? glm::vec3(0) : places_[order_[first]]), high = low;
        for (std::size_t i = first; i < last; ++i) {
            low = glm::min(low, places_[order_[i]]);
            high = glm::max(high, places_[order_[i]]);
        }
        return {low, high};
    }

    void sort_morton(std::size_t first, std::size_t last, glm::vec3 low, glm::vec3 high) {
        const glm::vec3 scale =
            static_cast<float>((1 << kMortonBits) - 1) / glm::max(high - low, glm::vec3(1e-12f));
        const auto code = [&](std::uint32_t i) {
            const glm::uvec3 cell((places_[i] - low) * scale);
            return spread(cell.x) | (spread(cell.y) << 1) | (spread(cell.z) << 2);
        };
        std::vector<std::pair<std::uint32_t, std::uint32_t>> coded;
        coded.reserve(last - first);
        for (std::size_t i = first; i < last; ++i) {
            coded.emplace_back(code(order_[i]), order_[i]);
        }
        std::sort(coded.begin(), coded.end());
        for (std::size_t i = first; i < last; ++i) {
            order_[i] = coded[i - first].second;
        }
    }

    const std::vector<glm::vec3>& places_;
    std::size_t size_;
    std::vector<std::uint32_t> order_;
};

} // namespace

std::vector<std::uint32_t> balanced_order(const std::vector<glm::vec3>& places, std::size_t size) {
    return Splitter(places, size).run();
}

} // namespace sward::blades
