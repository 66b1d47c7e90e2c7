// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "shared/types.h"

namespace sward::grass {

struct TextureArray;

/// A value of the far light table.
struct FarSample {
    shared::vec3 sun{0}; ///< mean radiance of the grass that the view meets, per unit of Light::sun
                         ///< (irradiance / pi)
    shared::vec3 sky{0}; ///< the same per unit of the sky's radiance
    float coverage = 0;  ///< share of the view's rays that meet grass before the ground
    float height = 0;    ///< mean height at rest of what they meet, 0 ground .. 1 top of the canopy
};

/// What the whole canopy looks like from far away, by everything that its shading is not linear in:
/// what rays through the blades meet, through the one shading function. Radiance under any sun and
/// sky: sun * Light::sun + sky * sky radiance. Horizontal angles are measured from the direction to
/// the eye, from x towards z; a canopy is even in all directions, so the table for the mirrored
/// angles is the mirrored table, and lean azimuths end at 180 degrees.
struct FarLight {
    std::vector<float>
        leans; ///< bend intensities (bend_arc), rising from 0; at rest the azimuths do not differ
    std::vector<float>
        lean_azimuths_deg; ///< of where the grass leans, 0 toward the eye .. 180 away, rising
    std::vector<float> elevations_deg;     ///< of the view, falling: those of GrassSet::far
    std::vector<float> sun_elevations_deg; ///< rising
    int sun_azimuths =
        0; ///< even steps from 0: the sun behind the viewer, half of them: against the light
    std::vector<FarSample> samples; ///< by at()

    [[nodiscard]] std::size_t images() const {
        return leans.size() * lean_azimuths_deg.size() * elevations_deg.size();
    }
    /// Number of a (lean, lean azimuth, view elevation).
    [[nodiscard]] std::size_t image(std::size_t lean, std::size_t azimuth,
                                    std::size_t elevation) const {
        return (lean * lean_azimuths_deg.size() + azimuth) * elevations_deg.size() + elevation;
    }
    [[nodiscard]] std::size_t at(std::size_t image, std::size_t sun_elevation,
                                 std::size_t sun_azimuth) const {
        return (image * sun_elevations_deg.size() + sun_elevation) *
                   static_cast<std::size_t>(sun_azimuths) +
               sun_azimuth;
    }
};

inline constexpr std::size_t kMaxLightSteps = 64; ///< of one axis
inline constexpr float kMaxReflectance =
    1000; ///< of a sample's sun and sky: far above anything that grass does

/// RGBA32F, sun azimuths wide and sun elevations tall; image 2 i: sun (rgb), coverage; image 2 i +
/// 1: sky, height. No mips.
[[nodiscard]] TextureArray encode_far_light(const FarLight& light);

/// Fills the samples of a light whose axes are known. Every texel is checked; `name` is for
/// messages. Throws base::Error(kBadInput).
void decode_far_light(const TextureArray& array, const std::filesystem::path& name,
                      FarLight& light);

} // namespace sward::grass
