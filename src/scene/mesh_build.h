// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/mesh.h"

namespace sward::scene {

/// A flat four-sided face; its front is where the corners run against the clock.
struct Quad {
    glm::dvec3 a, b, c, d;
};

/// Every face has corners of its own. One without area is left out.
void add_quad(Mesh& mesh, const Quad& face);
/// The same, its front away from `middle`: for convex bodies.
void add_outward(Mesh& mesh, const glm::dvec3& middle, const Quad& face);

} // namespace sward::scene
