// SPDX-License-Identifier: Apache-2.0
#include "tracks/track_mask.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/angles.h"
#include "base/error.h"
#include "tracks/tracks.h"

namespace sward::tracks {

namespace {

constexpr int kSide = shared::kTrackCells;

struct Area {
    glm::dvec2 low{0}, size{0}; ///< m
};

float texel(const scene::DensityMask& mask, int x, int y) {
    x = std::clamp(x, 0, mask.width - 1);
    y = std::clamp(y, 0, mask.height - 1);
    const float value =
        mask.density[static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
                     static_cast<std::size_t>(x)];
    return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 0.0f;
}

/// `at`: 0..1 over the mask.
float between(const scene::DensityMask& mask, glm::dvec2 at) {
    const glm::dvec2 place = at * glm::dvec2(mask.width, mask.height) - 0.5,
                     low = glm::floor(place);
    const glm::vec2 part(place - low);
    const auto x = static_cast<int>(low.x), y = static_cast<int>(low.y);
    return glm::mix(glm::mix(texel(mask, x, y), texel(mask, x + 1, y), part.x),
                    glm::mix(texel(mask, x, y + 1), texel(mask, x + 1, y + 1), part.x), part.y);
}

float nearest(const scene::DensityMask& mask, glm::dvec2 at) {
    return texel(mask, static_cast<int>(std::floor(at.x * mask.width)),
                 static_cast<int>(std::floor(at.y * mask.height)));
}

Area area_of(const scene::TrackSpec& spec, const Masks& masks) {
    if (spec.mask_size_m.x > 0) {
        return {spec.mask_place - 0.5 * spec.mask_size_m, spec.mask_size_m};
    }
    return masks.lying.size_m.x > 0 ? Area{masks.lying.first_m, masks.lying.size_m}
                                    : Area{-0.5 * masks.terrain_m, masks.terrain_m};
}

} // namespace

scene::Image painted(const scene::TrackSpec& spec, const Masks& masks) {
    const Area area = area_of(spec, masks);
    const double page_m = spec.cell_m * kSide;
    const glm::dvec2 first = glm::floor(area.low / page_m),
                     last = glm::ceil((area.low + area.size) / page_m);
    const glm::dvec2 cells = (last - first) * static_cast<double>(kSide);
    if (!(cells.x <= Tracks::kMostSide) || !(cells.y <= Tracks::kMostSide)) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("{}: found a mask of {:.0f} x {:.0f} m, expected at most {} "
                                      "cells of {} m a side (tracks.mask_size_m)",
                                      masks.name, area.size.x, area.size.y, Tracks::kMostSide,
                                      spec.cell_m));
    }
    scene::Image out;
    out.channels = {"pressed.X", "pressed.Y"};
    out.width = static_cast<int>(cells.x);
    out.height = static_cast<int>(cells.y);
    out.metadata[kPictureKey] = fmt::format("{} {:.0f} {:.0f}", spec.cell_m, first.x, first.y);
    out.texels.assign(
        2 * static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height), 0.0f);
    std::size_t texel_at = 0;
    for (int z = 0; z < out.height; ++z) {
        for (int x = 0; x < out.width; ++x, texel_at += 2) {
            const glm::dvec2 at =
                (first * page_m + (glm::dvec2(x, z) + 0.5) * spec.cell_m - area.low) / area.size;
            if (at.x < 0 || at.y < 0 || at.x >= 1 || at.y >= 1) {
                continue;
            }
            const float lying = between(masks.lying, at);
            const double yaw = masks.way.width > 0
                                   ? 2 * 180 * static_cast<double>(nearest(masks.way, at))
                                   : spec.mask_way_deg;
            const glm::vec2 way = lying * glm::vec2(base::Heading(yaw).ahead());
            out.texels[texel_at] = way.x;
            out.texels[texel_at + 1] = way.y;
        }
    }
    return out;
}

} // namespace sward::tracks
