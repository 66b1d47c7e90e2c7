// SPDX-License-Identifier: Apache-2.0
#include "terrain/detail.h"

#include <algorithm>
#include <cmath>

#include "shared/surface.h"

namespace sward::terrain {
namespace {

constexpr double kWidest_deg =
    20; // a wider view sees a level's cell as so few pixels as it ever did
constexpr double kPlainFocal_px = 600; // with it a cell is 11 to 22 pixels wide

double half_height(double fov_deg) {
    return std::tan(0.5 * fov_deg * 0.017453292519943295);
}

} // namespace

float Detail::least_reach(float nearest_m, float farthest_m) const {
    const auto reach = [this](float distance_m) {
        return shared::detail_reach(distance_m, start_m, zoom);
    };
    float least =
        std::min(reach(nearest_m),
                 reach(farthest_m)); // it rises, then may fall to twice the start, then rises
    if (nearest_m < 2 * start_m && 2 * start_m < farthest_m) {
        least = std::min(least, reach(2 * start_m));
    }
    return least;
}

Detail detail_of(double fov_deg, double focal_px, double blades_end_m) {
    const double narrow = half_height(kWidest_deg) / half_height(fov_deg);
    // By the square: a path that zooms in comes to the full detail soon, and without a jump.
    const double zoom =
        narrow > 1 ? std::clamp(focal_px / kPlainFocal_px, 1.0, narrow * narrow) : 1.0;
    return {static_cast<float>(blades_end_m), static_cast<float>(zoom)};
}

} // namespace sward::terrain
