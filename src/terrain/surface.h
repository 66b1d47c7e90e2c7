// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "scene/heightfield.h"
#include "terrain/post_bounds.h"

namespace sward::terrain {

/// The ground on the CPU: what the clipmap holds, at any point. World metres from the terrain's
/// centre.
class Surface {
public:
    /// `relief_m`: amplitude of the procedural relief.
    Surface(scene::Heightfield elevation, double relief_m);

    /// Height above the datum at x, z as a grid of `spacing_m` holds it (finest by default).
    /// Outside the posts the rim's height goes on.
    [[nodiscard]] double height(double x, double z, double spacing_m = 0.5) const;
    [[nodiscard]] glm::vec3 normal(double x, double z) const;
    [[nodiscard]] const scene::Heightfield& elevation() const { return elevation_; }
    [[nodiscard]] double relief_m() const { return relief_m_; }
    /// Lowest and highest surface, relief included.
    [[nodiscard]] glm::dvec2 range() const { return range_; }
    /// Least and greatest height over the square of `side` metres whose north-west corner is
    /// `corner` (x, z), relief included. Never too narrow.
    [[nodiscard]] glm::dvec2 bounds(glm::dvec2 corner, double side) const;

private:
    [[nodiscard]] float post(int i, int j) const;
    [[nodiscard]] glm::dvec2 with_relief(glm::vec2 range) const;
    scene::Heightfield elevation_;
    PostBounds bounds_;
    double relief_m_;
    glm::dvec2 range_;
};

} // namespace sward::terrain
