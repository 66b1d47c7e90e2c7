// SPDX-License-Identifier: Apache-2.0
#include "terrain/sun_sweep.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "base/angles.h"

namespace sward::terrain {
namespace {

using base::kDegree;
constexpr double kHighest_deg = 89; // of a sun that still throws a shadow to a side
constexpr float kSoft_m = 0.5f;     // a shadow's rim is never narrower: posts know no more
constexpr float kNone_m = -1e6f;    // of a line that has met no land

} // namespace

SunSweep::SunSweep(const scene::Heightfield& elevation)
    : elevation_(elevation),
      step_((std::max(elevation.width, elevation.height) + kMostPosts - 1) / kMostPosts),
      width_((elevation.width - 1) / step_ + 1), height_((elevation.height - 1) / step_ + 1),
      seen_from_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
                 glm::packHalf2x16(glm::vec2(kFarBelow_m, kFarBelow_m + 1))) {}

void SunSweep::begin(const glm::dvec3& to_sun) {
    const double flat = std::max(std::hypot(to_sun.x, to_sun.z), 1e-6);
    const glm::dvec2 level = std::hypot(to_sun.x, to_sun.z) > 1e-6
                                 ? glm::dvec2(to_sun.x, to_sun.z) / flat
                                 : glm::dvec2(1, 0);
    const glm::dvec2 spacing = elevation_.spacing_m * static_cast<double>(step_),
                     in_posts = level / spacing;
    along_x_ = std::abs(in_posts.x) >= std::abs(in_posts.y);
    const double forth = along_x_ ? in_posts.x : in_posts.y,
                 aside = along_x_ ? in_posts.y : in_posts.x;
    from_end_ = forth > 0;
    rows_ = along_x_ ? width_ : height_;
    across_ = along_x_ ? height_ : width_;
    drift_ = static_cast<float>(aside / std::abs(forth));
    const double row_m = 1 / std::abs(forth), elevation_deg = std::atan2(to_sun.y, flat) / kDegree;
    const auto fall = [&](double deg) {
        return static_cast<float>(row_m * std::tan(std::clamp(deg, 0.0, kHighest_deg) * kDegree));
    };
    fall_ = fall(elevation_deg - kRadius_deg);
    widens_ = fall(elevation_deg + kRadius_deg) - fall_;
    const auto reach =
        static_cast<int>(std::ceil(std::abs(drift_) * static_cast<float>(rows_ - 1)));
    first_line_ = drift_ < 0 ? -reach : 0;
    lines_ = across_ + reach + 1;
    carried_.assign(static_cast<std::size_t>(lines_), {kNone_m, 0});
    row_ = 0;
}

std::size_t SunSweep::index(int along, int across) const {
    return static_cast<std::size_t>(along_x_ ? across * width_ + along : along * width_ + across);
}

/// Height between two posts of a row.
float SunSweep::post(int along, float across) const {
    const float inside = std::clamp(across, 0.0f, static_cast<float>(across_ - 1));
    const int low = static_cast<int>(inside), high = std::min(low + 1, across_ - 1);
    const auto at = [&](int side) {
        const int i = step_ * (along_x_ ? along : side), j = step_ * (along_x_ ? side : along);
        return elevation_
            .metres[static_cast<std::size_t>(j) * static_cast<std::size_t>(elevation_.width) +
                    static_cast<std::size_t>(i)];
    };
    const float low_m = at(low);
    return low_m + (inside - static_cast<float>(low)) * (at(high) - low_m);
}

bool SunSweep::advance(int rows) {
    for (const int end = std::min(row_ + rows, rows_); row_ < end; ++row_) {
        const int along = from_end_ ? rows_ - 1 - row_ : row_;
        const float shift =
            drift_ * static_cast<float>(
                         row_); // line at a post: the post's number and this, less first_line_
        for (int k = 0; k < across_; ++k) {
            const float line = static_cast<float>(k - first_line_) + shift;
            const auto low =
                static_cast<std::size_t>(std::clamp(line, 0.0f, static_cast<float>(lines_ - 2)));
            const float share = line - static_cast<float>(low),
                        ground = post(along, static_cast<float>(k));
            const Carried &a = carried_[low], &b = carried_[low + 1];
            const float whole =
                std::max(a.whole + share * (b.whole - a.whole) - ground, kFarBelow_m + 1);
            const float begins =
                std::max(whole - std::max(widens_ * (a.rows + share * (b.rows - a.rows)), kSoft_m),
                         kFarBelow_m);
            seen_from_[index(along, k)] = glm::packHalf2x16(glm::vec2(begins, whole));
        }
        for (int line = 0; line < lines_; ++line) {
            Carried& shadow = carried_[static_cast<std::size_t>(line)];
            const float ground = post(along, static_cast<float>(line + first_line_) - shift);
            shadow.rows = 1 + (shadow.whole > ground ? shadow.rows : 0);
            shadow.whole = std::max(shadow.whole, ground) - fall_;
        }
    }
    return row_ >= rows_;
}

glm::vec2 SunSweep::seen_from(int i, int j) const {
    return glm::unpackHalf2x16(
        seen_from_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(i)]);
}

} // namespace sward::terrain
