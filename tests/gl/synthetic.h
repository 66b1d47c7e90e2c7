// SPDX-License-Identifier: Apache-2.0
// Small worlds made in the test: terrain flat or hilly, a grass set of some hundred blades with
// images of noise.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "grass/grass_set.h"
#include "render/renderer.h"
#include "scene/heightfield.h"
#include "shared/blade.h"
#include "shared/shading.h"
#include "support/even_march.h"

namespace sward::tests {

inline shared::GrassAppearance grass_look() {
    return {{0.05f, 0.09f, 0.02f},
            0.07f,
            {0.08f, 0.15f, 0.03f},
            0.45f,
            {0.21f, 0.17f, 0.08f},
            0.45f,
            {1.0f, 1.0f, 0.06f, 18.0f},
            {0.5f, 0.4f, 0.1f},
            0.0f,
            {2.0f, 1.0f, 1.0f, 1.0f}};
}

inline shared::Light daylight(glm::vec3 to_sun) {
    return {to_sun,
            shared::kSunExtinction,
            {3.6f, 3.4f, 3.0f},
            0,
            {0.22f, 0.42f, 0.85f},
            shared::kSkyExtinction,
            {0.82f, 0.96f, 1.12f},
            0};
}

inline scene::Heightfield flat_field(float metres) {
    return {9, 9, {250, 250}, std::vector<float>(81, metres), {}};
}

/// Hills of up to 60 m a few hundred metres apart.
inline scene::Heightfield hilly_field() {
    scene::Heightfield field{65, 65, {30, 30}, {}, {}};
    for (int j = 0; j < field.height; ++j) {
        for (int i = 0; i < field.width; ++i) {
            field.metres.push_back(300 +
                                   30 * std::sin(0.35f * static_cast<float>(i)) *
                                       std::cos(0.27f * static_cast<float>(j)) +
                                   10 * std::sin(0.9f * static_cast<float>(i + j)));
        }
    }
    return field;
}

inline scene::DensityMask even_mask(float density) {
    return {2, 2, std::vector<float>(4, density)};
}

inline float unit_at(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    return static_cast<float>(base::hash_unit(a, b, c));
}

/// Texels of noise: half of them covered, ranks and seeds of all values, roots near the texel.
inline grass::TextureArray noise_images(int width, int height, int images) {
    grass::TextureArray array{width, height, images, {}};
    for (int mip = 0; (std::max(width, height) >> mip) > 0; ++mip) {
        const int texels = std::max(1, width >> mip) * std::max(1, height >> mip);
        auto& bytes = array.mips.emplace_back();
        for (int image = 0; image < images; ++image) {
            for (int t = 0; t < texels; ++t) {
                const float n = unit_at(static_cast<std::uint64_t>(image / 2),
                                        static_cast<std::uint64_t>(t), 1);
                const auto byte = [&](std::uint64_t salt) {
                    return static_cast<std::uint8_t>(255.99f *
                                                     unit_at(static_cast<std::uint64_t>(image / 2),
                                                             static_cast<std::uint64_t>(t), salt));
                };
                if (image % 2 == shared::kPlaneId) {
                    bytes.insert(bytes.end(), {static_cast<std::uint8_t>(n < 0.5f ? 255 : 0),
                                               byte(2), byte(3), byte(4)});
                } else {
                    bytes.insert(bytes.end(),
                                 {static_cast<std::uint8_t>(108 + byte(5) / 6),
                                  static_cast<std::uint8_t>(108 + byte(6) / 6), 128, 128});
                }
            }
        }
    }
    return array;
}

/// A blade that leans by up to 20 degrees and bends further; rank by its number, so that a variant
/// is sorted.
inline shared::BladeRecord synthetic_blade(std::uint64_t variant, int n, int count, float side) {
    const auto random = [&](std::uint64_t salt) {
        return unit_at(variant * 100000 + static_cast<std::uint64_t>(n), salt, 77);
    };
    const float length = 0.15f + 0.12f * random(0), azimuth = 6.2831853f * random(1),
                lean = 0.35f * random(2), turn = 0.6f * random(3);
    const auto toward = [&](float angle) {
        return glm::vec3(std::sin(angle) * std::cos(azimuth), std::cos(angle),
                         std::sin(angle) * std::sin(azimuth));
    };
    const glm::vec3 v1 = toward(lean) * 0.5f * length;
    const glm::vec3 v2 = v1 + toward(lean + turn) * 0.5f * length;
    float curve = 0;
    for (int i = 0; i < 64; ++i) {
        curve += glm::distance(shared::blade_curve(v1, v2, static_cast<float>(i) / 64),
                               shared::blade_curve(v1, v2, static_cast<float>(i + 1) / 64));
    }
    const float rank =
        (std::floor(256.0f * static_cast<float>(n) / static_cast<float>(count)) + 0.5f) / 256;
    const float seed = (std::floor(256.0f * random(4)) + 0.5f) / 256;
    return {{side * random(5), side * random(6), rank, seed},
            glm::vec4(v1, 0.002f + 0.002f * random(7)),
            glm::vec4(v2, 0.3f + 0.5f * random(8)),
            {6.2831853f * random(9), curve, 0, 0}};
}

/// (i + shift) * canopy / layers for every layer, or edge.
inline std::vector<float> even_heights(int count, float canopy, float shift) {
    const int layers = shift > 0 ? count : count - 1;
    std::vector<float> heights;
    for (int i = 0; i < count; ++i) {
        heights.push_back((static_cast<float>(i) + shift) * canopy / static_cast<float>(layers));
    }
    return heights;
}

/// Light of the rows' elevations that rises with the sun and falls against it and with the bend.
inline grass::FarLight synthetic_light(const std::vector<grass::FarRow>& rows) {
    grass::FarLight light{{0, 0.5f}, {0, 90, 180}, {}, {-5, 10, 90}, 4, {}};
    for (const grass::FarRow& row : rows) {
        light.elevations_deg.push_back(row.elevation_deg);
    }
    for (std::size_t image = 0; image < light.images(); ++image) {
        const grass::FarRow& row = rows[image % rows.size()];
        const float bent = image < light.images() / 2 ? 1.0f : 0.7f;
        for (std::size_t s = 0; s < light.sun_elevations_deg.size(); ++s) {
            for (int azimuth = 0; azimuth < light.sun_azimuths; ++azimuth) {
                const float against = azimuth == 2 ? 0.8f : 1.0f;
                light.samples.push_back(
                    {glm::vec3(0.06f, 0.09f, 0.03f) * (bent * against * static_cast<float>(s)),
                     glm::vec3(0.05f, 0.08f, 0.02f) * bent, row.coverage, row.height});
            }
        }
    }
    return light;
}

inline grass::GrassSet synthetic_set(int blades_a_variant = 300) {
    grass::GrassSet set;
    set.name = "synthetic";
    set.side_m = 2;
    set.canopy_m = 0.28f;
    set.offset_range_m = 0.15f;
    set.variants = 2;
    set.density_per_m2 = static_cast<float>(blades_a_variant) / 4;
    for (int variant = 0; variant < set.variants; ++variant) {
        set.variant_begin.push_back(static_cast<std::uint32_t>(set.blades.size()));
        for (int n = 0; n < blades_a_variant; ++n) {
            set.blades.push_back(synthetic_blade(static_cast<std::uint64_t>(variant), n,
                                                 blades_a_variant, set.side_m));
        }
    }
    set.variant_begin.push_back(static_cast<std::uint32_t>(set.blades.size()));
    for (int k = 0; k < 3; ++k) {
        const int size = 64 >> k, layers = 4 >> k, slices = 8 >> k;
        set.levels.push_back(
            {layers, even_heights(layers + 1, set.canopy_m, 0),
             even_heights(layers, set.canopy_m, 0.5f), slices,
             noise_images(size, size, set.variants * layers * shared::kPlanes),
             noise_images(size, size / 4, set.variants * 2 * slices * shared::kPlanes)});
    }
    for (const float elevation : {90.0f, 45.0f, 10.0f}) {
        grass::FarRow row;
        row.elevation_deg = elevation;
        row.coverage = 1 - elevation / 150;
        row.height = row.along = 0.6f;
        row.coarse_shares.assign(set.levels.size() - 1, 1.0f);
        set.far.push_back(row);
    }
    set.far_light = synthetic_light(set.far);
    set.species.push_back({"grass", "blade", 1, grass_look()});
    set.march = even_march(set.side_m, set.canopy_m, set.variants);
    return set;
}

} // namespace sward::tests
