// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "gl/texture.h"
#include "grass/grass_set.h"
#include "shared/shading.h"
#include "shared/wind.h"

namespace sward::shells {

/// The march as every pixel would see it that holds all blades of a patch: through the means of the
/// layers.
class MeanMarch {
public:
    /// Reads `set.march`, whose images may go afterwards.
    explicit MeanMarch(const grass::GrassSet& set);
    /// Radiance of the grass that is seen on level ground, over the share of the view that it
    /// takes. `to_eye`: unit, upwards. `wind`: velocity x, z (m/s); w: the grass's response.
    [[nodiscard]] glm::vec3 radiance(const shared::Light& light, const glm::vec4& wind,
                                     const glm::vec3& to_eye) const;

private:
    shared::MarchMedium medium_;
    shared::GrassAppearance look_{};                       ///< of the first species: sways for all
    std::array<glm::vec3, shared::kMarchLayers> albedo_{}; ///< mean
    std::array<float, shared::kMarchElevations> correction_{}; ///< of the columns' coarsest mip
};

/// What the march's light is multiplied by, so that its mean is that of rays through the blades
/// (the set's far light): of many blades shading knows second moments alone. RGBA16F array,
/// kAzimuths x kElevations, a channel for each of shared::kFarWinds winds. Columns: angle from the
/// direction to the eye to that to the sun, from x towards z, 0 .. 2 pi, repeating; rows: sine of
/// the view's elevation, 0..1. One layer; of a mesh, which faces any way, kSuns: sine of the sun's
/// height over the surface, -0.2 (no sunlight) .. 1.
class MarchLight {
public:
    static constexpr int kAzimuths = 32;
    static constexpr int kElevations = 24;
    static constexpr float kMost = 2; ///< factors are between its inverse and this
    static constexpr int kSuns = 6;

    /// Of a set without a march it is empty. `mesh`: that it is on.
    MarchLight(const grass::GrassSet& set, bool mesh);
    /// Computed when the light or the mean wind changes, in some ten milliseconds on the CPU; of a
    /// mesh in kSuns times that.
    void update(const shared::Light& light, const shared::WindField& wind);
    /// The same in parts, once a table is there: one wind of the next one a call, which takes the
    /// old one's place when it is whole. A sun that moves is so followed some frames late, and no
    /// frame waits for a whole table.
    void follow(const shared::Light& light, const shared::WindField& wind);
    void bind() const;

private:
    [[nodiscard]] bool is_of(const shared::Light& light, const shared::WindField& wind) const;
    /// The next table, in parts of one wind and one sun each; true when it is whole and drawn with.
    void begin(const shared::Light& light, const shared::WindField& wind);
    bool add_part();
    const grass::FarLight& far_light_;
    std::vector<MeanMarch> mean_; ///< one, or none
    shared::Light light_{};
    glm::vec4 wind_{0};
    int suns_; ///< layers
    gl::Texture table_;
    shared::Light next_light_{}; ///< of the table in the making
    shared::WindField next_wind_{};
    int parts_ = 0; ///< that it has
    std::vector<glm::vec4> next_;
};

/// The factors for one wind.
[[nodiscard]] std::vector<float> light_factors(const MeanMarch& mean, const grass::FarLight& truth,
                                               const shared::Light& light, const glm::vec4& wind);

} // namespace sward::shells
