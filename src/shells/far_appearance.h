// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gl/texture.h"
#include "grass/grass_set.h"
#include "shared/shading.h"
#include "shared/wind.h"

namespace sward::shells {

/// The canopy as the ground beyond the shells wears it, from the set's far light: RGBA, kAzimuths x
/// kElevations, two layers for each of shared::kFarWinds winds, so that gusts are seen to run over
/// far hills. Even layers: radiance by sunlight on flat ground, coverage. Odd ones: radiance by
/// skylight, mean height (0..1) of what is seen. Columns: angle from the direction to the eye to
/// that to the sun, from x towards z, 0 .. 2 pi, repeating; rows: sine of the view's elevation,
/// 0..1.
class FarAppearance {
public:
    static constexpr int kAzimuths = 32;
    static constexpr int kElevations = 24;

    explicit FarAppearance(const grass::GrassSet& set) : set_(set) {}
    /// Computed when the light or the mean wind changes, in a few milliseconds on the CPU.
    void update(const shared::Light& light, const shared::WindField& wind);
    void bind() const;

private:
    const grass::GrassSet& set_;
    shared::Light light_{};
    glm::vec4 wind_{0};
    gl::Texture table_;
};

/// The texels of one wind's two layers, layer-major: `wind` is its velocity x, z (m/s); w: the
/// grass's response.
[[nodiscard]] std::vector<glm::vec4>
canopy_table(const grass::FarLight& table, const shared::Light& light, const glm::vec4& wind);

} // namespace sward::shells
