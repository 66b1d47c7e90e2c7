// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "app/feed_links.h"
#include "shared/surface.h"

namespace sward::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The texel under a place; a bounded mask has no grass outside.
class MaskCover {
public:
    MaskCover(const scene::DensityMask& mask, glm::dvec2 extent)
        : width_(mask.width), height_(mask.height), first_(mask.first_m), size_(mask.size_m),
          bounded_(mask.bounded) {
        if (size_.x <= 0 || size_.y <= 0) { // spread over all of the posts
            size_ = extent;
            first_ = -0.5 * extent;
        }
        share_.reserve(mask.density.size());
        for (const float density : mask.density)
            share_.push_back(
                static_cast<std::uint8_t>(std::lround(255 * std::clamp(density, 0.0f, 1.0f))));
    }

    [[nodiscard]] double at(glm::dvec2 place) const {
        const glm::dvec2 texel = glm::floor((place - first_) / size_ * glm::dvec2(width_, height_));
        if (bounded_ && (texel.x < 0 || texel.y < 0 || texel.x >= width_ || texel.y >= height_))
            return 0;
        const auto column = static_cast<std::size_t>(std::clamp(texel.x, 0.0, width_ - 1.0));
        const auto row = static_cast<std::size_t>(std::clamp(texel.y, 0.0, height_ - 1.0));
        return share_[row * static_cast<std::size_t>(width_) + column] / 255.0;
    }

private:
    int width_, height_;
    glm::dvec2 first_, size_;
    bool bounded_;
    std::vector<std::uint8_t> share_;
};

} // namespace

GrassShare grass_share_of(const render::World& world) {
    if (!world.scene.terrain.surface.empty()) // a mesh has no ground below
        return [](glm::dvec2, glm::vec3) { return kNone; };
    const glm::dvec2 extent = world.elevation.extent_m();
    const auto outside = [extent](glm::dvec2 place) {
        return !(std::abs(place.x) <= extent.x / 2 && std::abs(place.y) <= extent.y / 2);
    };
    if (world.mask.width < 1)
        return [outside](glm::dvec2 place, glm::vec3 normal) {
            return outside(place) ? kNone : double(shared::slope_density(normal, glm::vec2(place)));
        };
    return [outside, cover = std::make_shared<MaskCover>(world.mask, extent)](
               glm::dvec2 place, glm::vec3) { return outside(place) ? kNone : cover->at(place); };
}

} // namespace sward::app
