// SPDX-License-Identifier: Apache-2.0
#include "shells/far_shares.h"

#include <algorithm>
#include <cmath>

namespace sward::shells {

namespace {

/// A value of the rows (falling elevation) at `place`, linear in what `place_of` makes of a row's
/// elevation in radians, held at both ends.
template<class PlaceOf, class Value>
auto between_rows(const std::vector<grass::FarRow>& rows, float place, PlaceOf place_of,
                  Value value) {
    const auto at = [&](const grass::FarRow& row) {
        return place_of(row.elevation_deg * shared::kPi / 180);
    };
    if (place >= at(rows.front())) {
        return value(rows.front());
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const float low = at(rows[i]);
        if (place >= low) {
            return glm::mix(value(rows[i]), value(rows[i - 1]),
                            (place - low) / (at(rows[i - 1]) - low));
        }
    }
    return value(rows.back());
}

} // namespace

float slice_share_at(const grass::GrassSet& set, float elevation) {
    return between_rows(
        set.far, elevation, [](float e) { return e; },
        [](const grass::FarRow& row) { return row.slice_share; });
}

glm::vec4 shell_share_at(const grass::GrassSet& set, float elevation) {
    const int levels = std::min(static_cast<int>(set.levels.size()), shared::kMaxFarLevels);
    return between_rows(
        set.far, elevation, [](float e) { return e; },
        [levels](const grass::FarRow& row) {
            glm::vec4 shares(1);
            for (int k = 0; k < levels; ++k) {
                shares[k] = row.share_at(k);
            }
            return shares;
        });
}

shared::FarShares fitted_shares(const grass::GrassSet& set) {
    shared::FarShares shares{};
    for (int i = 0; !set.far.empty() && i <= shared::kShareSteps; ++i) {
        const float elevation = 0.5f * shared::kPi * static_cast<float>(i) / shared::kShareSteps;
        shares.steps[i].shells = shell_share_at(set, elevation);
        shares.steps[i].slices = slice_share_at(set, elevation);
    }
    return shares;
}

shared::FarShares published_shares() {
    shared::FarShares shares{};
    for (int i = 0; i <= shared::kShareSteps; ++i) {
        const float elevation_deg = 90.0f * static_cast<float>(i) / shared::kShareSteps;
        const float alpha = 1 - std::sin(elevation_deg * shared::kPi /
                                         180); // 1 - cos(beta); a texel shows its blade or none, so
                                               // that it is a share of them
        shares.steps[i].shells = glm::vec4(1);
        shares.steps[i].slices = elevation_deg < kSlicesBelow_deg ? alpha : 0.0f;
    }
    return shares;
}

} // namespace sward::shells
