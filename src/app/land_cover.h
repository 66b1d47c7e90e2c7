// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "app/flow_overlay.h"
#include "render/world.h"
#include "scene/ground_cover.h"

namespace sward::app {

/// What lies at world x, z on ground of this normal.
using CoverAt = std::function<scene::GroundCover(glm::dvec2 place, glm::vec3 normal)>;
/// Keeps what it needs of a world that is to be given away.
[[nodiscard]] CoverAt cover_of(const render::World& world);

/// Of the ground that is drawn, over a metre.
[[nodiscard]] glm::dvec3 normal_at(const Land& land, glm::dvec2 place);

} // namespace sward::app
