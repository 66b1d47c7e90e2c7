// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gl/texture.h"
#include "grass/grass_set.h"
#include "shared/shading.h"
#include "shared/wind.h"

namespace sward::shells {

/// Radiance and coverage of the whole canopy for the ground beyond the shells, by azimuth between eye and sun (0..pi) and by
/// sine of the view's elevation (0..1): RGBA, kAzimuths x kElevations. The blades of the set, through the one shading function,
/// weighted by how much of each the eye sees; coverage and mean height from the set's rays (GrassSet::far).
class FarAppearance {
public:
    static constexpr int kAzimuths = 24;
    static constexpr int kElevations = 24;

    explicit FarAppearance(const grass::GrassSet& set) : set_(set) {}
    /// Computed when the light or the mean wind changes, in some milliseconds on the CPU.
    void update(const shared::Light& light, const shared::WindField& wind);
    void bind() const;

private:
    const grass::GrassSet& set_;
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
