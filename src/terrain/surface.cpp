// SPDX-License-Identifier: Apache-2.0
#include "terrain/surface.h"

#include <algorithm>
#include <cmath>

#include "shared/surface.h"

namespace sward::terrain {

Surface::Surface(scene::Heightfield elevation, double relief_m)
    : elevation_(std::move(elevation)), bounds_(elevation_), relief_m_(relief_m),
      range_(with_relief(bounds_.all())) {}

glm::dvec2 Surface::with_relief(glm::vec2 range) const {
    // Gradient noise stays below sqrt(1/2), and the octaves' weights sum up to 1.79; the rest is
    // what floats round.
    const double slack =
        1.27 * relief_m_ + 1e-3 + 1e-6 * std::max(std::abs(range.x), std::abs(range.y));
    return {range.x - slack, range.y + slack};
}

glm::dvec2 Surface::bounds(glm::dvec2 corner, double side) const {
    const glm::dvec2 middle = 0.5 * glm::dvec2(elevation_.width - 1, elevation_.height - 1);
    const glm::dvec2 low = corner / elevation_.spacing_m + middle;
    constexpr double kRounding = 1e-3; // posts: the surface is evaluated at places in floats
    return with_relief(
        bounds_.over(low - kRounding, low + side / elevation_.spacing_m + kRounding, elevation_));
}

float Surface::post(int i, int j) const {
    i = std::clamp(i, 0, elevation_.width - 1);
    j = std::clamp(j, 0, elevation_.height - 1);
    return elevation_.metres[static_cast<std::size_t>(j) * elevation_.width + i];
}

// Twin of surface_height() in shaders/terrain/clipmap_height.comp, float for float.
double Surface::height(double x, double z, double spacing_m) const {
    const glm::vec2 posts(static_cast<float>(elevation_.width - 1),
                          static_cast<float>(elevation_.height - 1));
    const glm::vec2 xz(static_cast<float>(x), static_cast<float>(z));
    const glm::vec2 at =
        glm::clamp(xz / glm::vec2(elevation_.spacing_m) + 0.5f * posts, glm::vec2(0), posts);
    const glm::vec2 base = glm::floor(at);
    const glm::vec2 f = at - base;
    glm::vec4 rows;
    for (int j = 0; j < 4; ++j) {
        glm::vec4 p;
        for (int i = 0; i < 4; ++i) {
            p[i] = post(static_cast<int>(base.x) + i - 1, static_cast<int>(base.y) + j - 1);
        }
        rows[j] = shared::catmull_rom(p, f.x);
    }
    return shared::catmull_rom(rows, f.y) +
           shared::relief_at(xz, static_cast<float>(relief_m_), static_cast<float>(spacing_m));
}

glm::vec3 Surface::normal(double x, double z) const {
    const double e = 0.5;
    const double dx = (height(x + e, z) - height(x - e, z)) / (2 * e);
    const double dz = (height(x, z + e) - height(x, z - e)) / (2 * e);
    return glm::normalize(glm::vec3(-dx, 1, -dz));
}

} // namespace sward::terrain
