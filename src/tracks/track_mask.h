// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/glm.hpp>

#include "scene/heightfield.h"
#include "scene/image.h"
#include "scene/track_spec.h"

namespace sward::tracks {

/// Masks of what lies at time 0.
struct Masks {
    const scene::DensityMask& lying; ///< share of stems
    const scene::DensityMask&
        way;                 ///< 0..1 for 0 to 360 degrees of yaw; width 0: the spec's one way
    glm::dvec2 terrain_m{0}; ///< the terrain's size, for masks that say nothing of theirs
    std::string name;        ///< for messages
};

/// A mowing pattern or a crop circle as a picture for Tracks::begin_with(): the masks at the middle
/// of every cell, the share between their pixels, the way from the nearest. Throws
/// Error(kOverLimit), beginning with the name, where it would have more than Tracks::kMostSide
/// cells a side.
[[nodiscard]] scene::Image painted(const scene::TrackSpec& spec, const Masks& masks);

} // namespace sward::tracks
