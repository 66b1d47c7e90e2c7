// SPDX-License-Identifier: Apache-2.0
#include "terrain/surface.h"

#include <algorithm>
#include <cmath>

#include "shared/surface.h"

namespace sward::terrain {

Surface::Surface(scene::Heightfield elevation, double relief_m) : elevation_(std::move(elevation)), relief_m_(relief_m) {
    const auto [low, high] = std::minmax_element(elevation_.metres.begin(), elevation_.metres.end());
    // Catmull-Rom overshoots by at most an eighth of the range between neighbours; 5 % of the whole range is ample.
    const double slack = 0.05 * (*high - *low) + 2 * relief_m;
    range_ = {*low - slack, *high + slack};
}

float Surface::post(int i, int j) const {
    i = std::clamp(i, 0, elevation_.width - 1);
    j = std::clamp(j, 0, elevation_.height - 1);
    return elevation_.metres[static_cast<std::size_t>(j) * elevation_.width + i];
}

// Twin of surface_height() in shaders/terrain/clipmap_height.comp, float for float.
double Surface::height(double x, double z, double spacing_m) const {
    const glm::vec2 posts(static_cast<float>(elevation_.width - 1), static_cast<float>(elevation_.height - 1));
    const glm::vec2 xz(static_cast<float>(x), static_cast<float>(z));
    const glm::vec2 at = glm::clamp(xz / glm::vec2(elevation_.spacing_m) + 0.5f * posts, glm::vec2(0), posts);
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
