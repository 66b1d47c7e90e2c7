// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/texture.h"
#include "grass/grass_set.h"
#include "shared/shading.h"
#include "shared/wind.h"

namespace sward::shells {

/// A piece of grass at rest that stands for many.
struct RestPart {
    std::size_t species = 0;
    shared::vec3 albedo{0}, upright{0}; ///< upright: its tangent
    float y = 0;                        ///< metres
    float area = 0;                     ///< relative
};

/// Radiance and coverage of the whole canopy for the ground beyond the shells, by azimuth between eye and sun (0..pi) and by
/// sine of the view's elevation (0..1): RGBA, kAzimuths x kElevations. The blades of the set, through the one shading function,
/// weighted by how much of each the eye sees; coverage and mean height from the set's rays (GrassSet::far).
class FarAppearance {
public:
    static constexpr int kAzimuths = 24;
    static constexpr int kElevations = 24;

    /// Reads the set's blades, or the textures of one that has none, here and not later.
    explicit FarAppearance(const grass::GrassSet& set);
    /// Computed when the light or the mean wind changes, in some milliseconds on the CPU.
    void update(const shared::Light& light, const shared::WindField& wind);
    void bind() const;

private:
    const grass::GrassSet& set_;
    std::vector<RestPart> rest_;
    shared::Light light_{};
    glm::vec4 wind_{0};
    gl::Texture table_;
};

/// Coverage (x) and mean height of hits over the canopy's (y) at a sine of elevation, between the set's rows.
[[nodiscard]] glm::vec2 far_row_at(const grass::GrassSet& set, float sine);

/// Share of the slices at a view elevation (radians), likewise.
[[nodiscard]] float slice_share_at(const grass::GrassSet& set, float elevation);

/// Share of the shells' blades that far levels 0 to 3 show at a view elevation (radians), linear between the set's rows.
[[nodiscard]] glm::vec4 shell_share_at(const grass::GrassSet& set, float elevation);

} // namespace sward::shells
