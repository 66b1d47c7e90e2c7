// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "grass/grass_set.h"
#include "shared/blade_physics.h"

namespace sward::blades {

/// A sphere as a step meets it, anchor-relative (m): its place at the step's end and radius; its
/// place at the start. 32 bytes.
struct StepSphere {
    glm::vec4 now_radius{0};
    glm::vec4 before{0};
};
static_assert(sizeof(StepSphere) == 32);

/// One step of one blade, J4 to J6: the twin of shaders/blades/physics.comp. `root`
/// anchor-relative, `wind` x and z in m/s. Returns the new state.
[[nodiscard]] glm::vec4 step_blade(const shared::BladeStep& rules, const shared::BladeBody& body,
                                   glm::vec3 root, glm::vec2 wind,
                                   std::span<const StepSphere> spheres, glm::vec4 state);

/// Bend per m/s, 1 / (m/s), at which the far tier's warp moves the tips of a set's blades as J4
/// does at rest: the least sum of squared differences between the mean tips, over their squares,
/// over winds of 2 to 40 m/s that come from all around. `sample`: blades that are run, spread over
/// the set. A set without blades answers as grass of middling stiffness.
[[nodiscard]] double fit_response(const grass::GrassSet& set, int sample = 256);

/// Mean shift downwind and fall (m) of the tips of a set's blades at a wind's speed: J4 run to
/// rest, and the far tier's warp.
struct MeanTip {
    glm::dvec2 simulated{0}, warped{0};
};
[[nodiscard]] MeanTip mean_tip(const grass::GrassSet& set, double speed_mps, double response,
                               int sample);

} // namespace sward::blades
