// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "shared/wind.h"

namespace sward::wind {

/// The wind of a scene: a mean wind with gust fronts that travel with it. The same answer as every shader's wind_at().
class Wind {
public:
    /// `response`: bend of the grass per m/s, 1 / (m/s).
    Wind(const scene::WindSpec& spec, double response);

    /// Constants for shaders whose xz are relative to `anchor` (world metres), at `time_s`.
    [[nodiscard]] shared::WindField field(glm::dvec2 anchor, double time_s) const;
    /// Velocity (m/s; x east, z south) at world x, z.
    [[nodiscard]] glm::dvec2 at(double x, double z, double time_s) const;

private:
    struct Wave {
        glm::dvec2 k{0, 0};   // rad/m
        double omega = 0;     // rad/s
        double phase = 0;     // rad
        double amplitude = 0; // sum over all is 1
    };
    glm::dvec2 mean_;
    double gust_;
    double response_;
    Wave waves_[shared::kGustWaves];
};

} // namespace sward::wind
