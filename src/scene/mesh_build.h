// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/mesh.h"

namespace sward::scene {

/// Adds a flat four-sided face; its front is where the corners run against the clock. Every face has corners of its own. One without area is left out.
void add_quad(Mesh& mesh, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);
/// The same, its front away from `middle`: for convex bodies.
void add_outward(Mesh& mesh, const glm::dvec3& middle, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

} // namespace sward::scene
