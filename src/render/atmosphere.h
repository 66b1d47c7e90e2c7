// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "shared/air.h"
#include "shared/shading.h"

namespace sward::render {

/// Light of a sun through clear air: molecules, haze and ozone round a sphere; single scattering as
/// an integral, the rest after Hillaire 2020
/// ("A Scalable and Production Ready Sky and Atmosphere Rendering Technique"). docs/methods.md has
/// what is ours in it. Three colours.
class Atmosphere {
public:
    /// `visibility_km` by Koschmieder, over the lowest ground. Makes its tables: some 20 ms.
    explicit Atmosphere(double visibility_km);

    struct Day {
        shared::Light light{};
        shared::Air air{}; ///< extinctions over the lowest ground: see thinned()
    };
    /// For a sun in this direction (unit, y up). Kept for as long as the sun stands still; some 0.5
    /// ms where it does not.
    const Day& at(const glm::dvec3& to_sun);
    /// The air for an eye so high over the lowest ground (m).
    [[nodiscard]] static shared::Air thinned(shared::Air air, double height_m);
    /// Share of the sun's light that comes through to a height (m) from where it stands so high
    /// (sine over the level), 0 behind the Earth.
    [[nodiscard]] glm::dvec3 sunlight(double height_m, double sine) const;

private:
    struct Scattered {
        glm::dvec3 molecules{0}, haze{0}, many{0};
    };
    /// What a ray from near the ground gathers, of a sun of irradiance 1.
    [[nodiscard]] Scattered gather(const glm::dvec3& way, const glm::dvec3& to_sun) const;
    [[nodiscard]] glm::dvec3 many(double height_m, double sine) const;
    [[nodiscard]] glm::dvec3 bounce(double height_m, double sine) const;
    [[nodiscard]] Day day(const glm::dvec3& to_sun) const;

    glm::dvec3 haze_scattering_, haze_extinction_; ///< 1/m on the ground
    std::vector<glm::dvec3> sunlight_, many_;
    glm::dvec3 last_sun_{0};
    Day last_;
};

} // namespace sward::render
