// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "gl/texture.h"
#include "grass/grass_set.h"
#include "shared/shading.h"
#include "shared/wind.h"

namespace sward::shells {

/// The march as every pixel would see it that holds all blades of a patch: through the means of the layers.
class MeanMarch {
public:
    /// Reads `set.march`, whose images may go afterwards.
    explicit MeanMarch(const grass::GrassSet& set);
    /// Radiance of the grass that is seen on level ground, over the share of the view that it takes. `to_eye`: unit, upwards. `wind`: velocity x, z (m/s)
    /// and the grass's response (WindField::mean).
    [[nodiscard]] glm::vec3 radiance(const shared::Light& light, const glm::vec4& wind, const glm::vec3& to_eye) const;

private:
    shared::MarchMedium medium_;
    shared::GrassAppearance look_{};                            ///< of the first species: sways for all
    std::array<glm::vec3, shared::kMarchLayers> albedo_{};      ///< mean
    std::array<float, shared::kMarchElevations> correction_{}; ///< of the columns' coarsest mip
};

/// What the march's light is multiplied by, so that its mean is that of rays through the blades (the set's far light): of many blades shading knows
/// second moments alone. R16F, kAzimuths x kElevations, a layer for each of shared::kFarWinds winds. Columns: angle from the
/// direction to the eye to that to the sun, from x towards z, 0 .. 2 pi, repeating; rows: sine of the view's elevation, 0..1.
class MarchLight {
public:
    static constexpr int kAzimuths = 32;
    static constexpr int kElevations = 24;
    static constexpr float kMost = 2; ///< factors are between its inverse and this

    /// Of a set without a march it is empty.
    explicit MarchLight(const grass::GrassSet& set);
    /// Computed when the light or the mean wind changes, in some ten milliseconds on the CPU.
    void update(const shared::Light& light, const shared::WindField& wind);
    /// The same in parts, once a table is there: a layer of the next one a call, which takes the old one's place when it is whole. A sun that
    /// moves is so followed some frames late, and no frame waits for a whole table.
    void follow(const shared::Light& light, const shared::WindField& wind);
    void bind() const;

private:
    void upload(const std::vector<float>& texels);
    const grass::FarLight& far_light_;
    std::vector<MeanMarch> mean_; ///< one, or none
    shared::Light light_{};
    glm::vec4 wind_{0};
    gl::Texture table_;
    shared::Light next_light_{}; ///< of the table in the making
    shared::WindField next_wind_{};
    std::vector<float> next_;
};

/// The texels of one wind's layer.
[[nodiscard]] std::vector<float> light_factors(const MeanMarch& mean, const grass::FarLight& truth, const shared::Light& light, const glm::vec4& wind);

} // namespace sward::shells
