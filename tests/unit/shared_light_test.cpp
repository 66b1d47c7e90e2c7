// SPDX-License-Identifier: Apache-2.0
// Light: shading stays finite whatever it is given, tone and sRGB rise, the far table interpolates.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "gl/synthetic.h"
#include "shared/shading.h"
#include "shared/tone.h"
#include "shells/far_appearance.h"
#include "shells/far_shares.h"

namespace sward {
namespace {

using shared::GrassPoint;
using shared::Light;
using shared::vec2;
using shared::vec3;
using shared::vec4;

bool usable(const vec3& radiance) {
    return std::isfinite(radiance.x) && std::isfinite(radiance.y) && std::isfinite(radiance.z) &&
           radiance.x >= 0 && radiance.y >= 0 && radiance.z >= 0;
}

TEST(Tone, MapRisesAndStaysWithinZeroAndOne) {
    float before = -1;
    for (float l = 0; l < 10; l += 0.01f) {
        const float here = shared::tone_map(vec3(l)).x;
        EXPECT_GE(here, before);
        EXPECT_LE(here, 1.0f);
        before = here;
    }
    EXPECT_GT(shared::tone_map(vec3(20)).x, 0.98f); // white in the end
    EXPECT_GT(shared::tone_map(vec3(0.18f)).x, 0.05f);
    EXPECT_EQ(shared::tone_map(vec3(0)), vec3(0));
    EXPECT_EQ(shared::tone_map(vec3(-1)), vec3(0));
    const vec3 colour = shared::tone_map(vec3(0.3f, 0.6f, 0.15f));
    EXPECT_GT(colour.y, colour.x); // the order of the channels stays
    EXPECT_GT(colour.x, colour.z);
}

TEST(Tone, SrgbHasItsKnownValuesAndIsMonotone) {
    EXPECT_EQ(shared::srgb_encode_one(0), 0);
    EXPECT_NEAR(shared::srgb_encode_one(1), 1, 1e-6f);
    EXPECT_NEAR(shared::srgb_encode_one(0.18f), 0.4614f, 1e-4f);
    EXPECT_NEAR(shared::srgb_encode_one(0.0031308f), 0.04045f, 1e-5f);
    float before = -1;
    for (float x = 0; x <= 1; x += 0.0005f) {
        const float here = shared::srgb_encode_one(x);
        EXPECT_GT(here, before);
        before = here;
    }
}

TEST(Shading, GrassIsFiniteAndNonNegativeForExtremeInputs) {
    const shared::GrassAppearance look = tests::grass_look();
    std::mt19937 random(3);
    std::uniform_real_distribution<float> signed_unit(-1, 1);
    const auto direction = [&] {
        return glm::normalize(vec3(signed_unit(random), signed_unit(random), signed_unit(random)) +
                              vec3(1e-4f));
    };
    for (int n = 0; n < 20000; ++n) {
        const Light light = tests::daylight(direction());
        const vec3 tangent =
            n % 3 == 0 ? light.to_sun : direction(); // along the sun: no diffuse, no NaN
        const vec3 to_eye = n % 5 == 0 ? light.to_sun : direction();
        const GrassPoint point{vec3(n % 7 == 0 ? 0.0f : 1.0f), tangent, 1.5f * signed_unit(random),
                               signed_unit(random)};
        EXPECT_TRUE(usable(shade_grass(look, light, point, to_eye))) << n;
        EXPECT_TRUE(
            usable(shade_soil(light, vec3(0.2f), direction(), 0.5f + 0.5f * signed_unit(random))))
            << n;
    }
}

TEST(Shading, LookingStraightAgainstTheSunIsFinite) {
    const Light light = tests::daylight(glm::normalize(vec3(0.3f, 0.6f, 0.2f)));
    const vec3 away = -light.to_sun; // the half vector vanishes
    EXPECT_TRUE(usable(
        shade_grass(tests::grass_look(), light, {vec3(0.1f), vec3(0, 1, 0), 0.5f, 0.6f}, away)));
}

TEST(Shading, SunlightFadesDownTheCanopyAndBehindTheHill) {
    const Light light = tests::daylight(glm::normalize(vec3(0.5f, 0.7f, 0)));
    for (float h = 0; h < 1; h += 0.1f) {
        EXPECT_LT(canopy_sun(light, h, 0.7f), canopy_sun(light, h + 0.1f, 0.7f));
        EXPECT_LT(canopy_sky(light, h), canopy_sky(light, h + 0.1f));
    }
    EXPECT_NEAR(canopy_sun(light, 1, 0.7f), 1, 1e-6f);
    EXPECT_NEAR(canopy_sky(light, 1), 1, 1e-6f);
    EXPECT_EQ(canopy_sun(light, 1, -0.1f), 0);
    EXPECT_LT(canopy_sun(light, 0.5f, 0.3f), canopy_sun(light, 0.5f, 0.9f)); // a longer path
}

TEST(Sway, CalmChangesNothingAndGalesStayWithinReason) {
    const shared::GrassAppearance look = tests::grass_look();
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    const float grey =
        glm::dot(glm::mix(look.root, look.tip, 0.75f), vec3(0.2126f, 0.7152f, 0.0722f));
    float lowest = 2, highest = 0, farthest = 0;
    for (int n = 0; n < 5000; ++n) {
        const auto direction = [&](float up) {
            const float azimuth = 2 * shared::kPi * unit(random), flat = std::sqrt(1 - up * up);
            return vec3(flat * std::cos(azimuth), up, flat * std::sin(azimuth));
        };
        const vec3 sun = direction(0.02f + 0.97f * unit(random)), to_eye = direction(unit(random));
        const vec2 calm = canopy_sway(look, vec3(0, 1, 0), sun, to_eye);
        EXPECT_NEAR(calm.x, 1, 1e-5f);
        EXPECT_NEAR(calm.y, 1, 1e-5f);
        const vec3 turn = direction(unit(random));
        const vec2 bent = canopy_sway(look, turn, sun, to_eye);
        // The mean over the blades keeps within kSwayRange of the calm one's.
        const Light light = tests::daylight(sun);
        const float shadow =
            canopy_sun(light_in_sway(light, {1, bent.y}), shared::kSeenHeight, sun.y) /
            canopy_sun(light, shared::kSeenHeight, sun.y);
        const float kept = bent.x * shadow * std::exp(-shared::kSwayLoss * (1 - turn.y)) *
                           mean_sunlit(look, grey, turn, sun, to_eye) /
                           mean_sunlit(look, grey, vec3(0, 1, 0), sun, to_eye);
        EXPECT_LE(std::abs(std::log(kept)), 1.001f * shared::kSwayRange);
        farthest = std::max(farthest, std::abs(std::log(kept)));
        EXPECT_GT(bent.x, 0.2f);
        EXPECT_LT(bent.x, 5.0f);
        EXPECT_GT(bent.y, 0.3f);
        EXPECT_LT(bent.y, 3.5f);
        lowest = std::min(lowest, bent.y);
        highest = std::max(highest, bent.y);
    }
    EXPECT_GT(farthest, 0.9f * shared::kSwayRange);
    EXPECT_LT(lowest, 0.7f); // both ways, or the term does nothing
    EXPECT_GT(highest, 1.4f);
}

TEST(Sway, BladesAcrossTheLightShadowAndAlongItLetThrough) {
    const shared::GrassAppearance look = tests::grass_look();
    const vec3 sun = glm::normalize(vec3(1, 0.8f, 0)), to_eye = glm::normalize(vec3(0, 0.4f, 1));
    const vec2 along = canopy_sway(look, sun, sun, to_eye);
    const vec2 across = canopy_sway(look, glm::normalize(vec3(-0.8f, 1, 0)), sun, to_eye);
    EXPECT_LT(along.y, 1);
    EXPECT_GT(across.y, 1);
    EXPECT_GT(along.x, across.x);
    const Light light = tests::daylight(sun);
    EXPECT_GT(canopy_sun(light_in_sway(light, along), 0.3f, sun.y), canopy_sun(light, 0.3f, sun.y));
    EXPECT_LT(canopy_sun(light_in_sway(light, across), 0.3f, sun.y),
              canopy_sun(light, 0.3f, sun.y));
    EXPECT_EQ(light_in_sway(light, vec2(1)).sun, light.sun);
    EXPECT_EQ(light_in_sway(light, vec2(1)).to_sun, light.to_sun);
}

TEST(Shading, ABladesColourIsItsOwnAndWithinReason) {
    const shared::GrassAppearance look = tests::grass_look();
    const auto at = [&](float rank, float seed) {
        return blade_albedo(look, vec2(rank, seed) / 256.0f, 0.5f, 1);
    };
    EXPECT_EQ(at(0.5f, 10.5f), at(0.5f, 10.5f));
    EXPECT_NE(at(0.5f, 10.5f), at(1.5f, 10.5f));
    EXPECT_NE(at(0.5f, 10.5f), at(0.5f, 11.5f));
    for (int n = 0; n < 256; ++n) {
        for (const float v : {0.0f, 0.5f, 1.0f}) {
            const vec3 albedo =
                blade_albedo(look, vec2(static_cast<float>(n) + 0.5f, 99.5f) / 256.0f, v, 1);
            EXPECT_TRUE(usable(albedo));
            EXPECT_LT(albedo.x + albedo.y + albedo.z, 1.5f);
        }
    }
}

TEST(Shading, MeanColourIsTheSameAtEveryDetail) {
    const shared::GrassAppearance look = tests::grass_look();
    for (const float v : {0.1f, 0.5f, 0.9f, 1.0f}) {
        vec3 mean[3] = {vec3(0), vec3(0), vec3(0)};
        for (int n = 0; n < 65536; ++n) {
            const vec2 own = (vec2(n % 256, n / 256) + 0.5f) / 256.0f;
            for (int i = 0; i < 3; ++i) {
                mean[i] += blade_albedo(look, own, v, 0.5f * static_cast<float>(i)) / 65536.0f;
            }
        }
        EXPECT_EQ(blade_albedo(look, vec2(0.1f, 0.7f), v, 0),
                  blade_albedo(look, vec2(0.6f, 0.2f), v, 0));
        for (int i = 1; i < 3; ++i) {
            EXPECT_LT(glm::length(mean[i] - mean[0]), 0.01f * glm::length(mean[0]))
                << v << " detail " << 0.5f * static_cast<float>(i);
        }
    }
    EXPECT_EQ(shared::colour_detail(0), 0);
    EXPECT_EQ(shared::colour_detail(1), 1);
}

TEST(FarTable, CoverageRunsSmoothlyThroughTheRowsAndHoldsBelow) {
    grass::GrassSet set = tests::synthetic_set(); // 90, 45 and 10 degrees
    const Light light = tests::daylight(glm::normalize(vec3(0.5f, 0.7f, 0)));
    const auto texels = shells::canopy_table(set.far_light, light, {0, 0, 0, 0.1f});
    constexpr int last = shells::FarAppearance::kElevations - 1;
    const auto coverage = [&](int row) {
        return texels[static_cast<std::size_t>(row * shells::FarAppearance::kAzimuths)].a;
    };
    EXPECT_FLOAT_EQ(coverage(0), set.far[2].coverage);
    EXPECT_FLOAT_EQ(coverage(3), set.far[2].coverage); // sine 0.13 is below 10 degrees
    EXPECT_EQ(coverage(last), set.far[0].coverage);
    EXPECT_NEAR(coverage(16), set.far[1].coverage, 0.01f); // sine 0.696, beside 45 degrees
    for (int row = 4; row < last; ++row) {
        EXPECT_GT(coverage(row - 1), coverage(row) - 1e-6f) << row;
        EXPECT_LT(coverage(row - 1) - coverage(row), 0.1f) << row;
    }
}

TEST(FarTable, PublishedSharesAreWholeShellsAndSlicesNearGrazing) {
    const shared::FarShares shares = shells::published_shares();
    const auto row = [](float degrees) {
        return static_cast<int>(degrees / 90 * shared::kShareSteps);
    };
    EXPECT_EQ(shares.steps[row(90)].shells, glm::vec4(1));
    EXPECT_EQ(shares.steps[row(0)].shells, glm::vec4(1));
    EXPECT_EQ(shares.steps[row(0)].slices, 1);
    EXPECT_NEAR(shares.steps[row(15)].slices, 1 - std::sin(shared::kPi / 12), 1e-6f);
    EXPECT_EQ(shares.steps[row(30)].slices, 0);
    const grass::GrassSet set = tests::synthetic_set();
    const shared::FarShares fitted = shells::fitted_shares(set);
    EXPECT_EQ(fitted.steps[row(45)].shells, shells::shell_share_at(set, shared::kPi / 4));
}

TEST(FarTable, ShellSharesInterpolateByLevel) {
    grass::GrassSet set = tests::synthetic_set();
    for (std::size_t i = 0; i < set.far.size(); ++i) { // 90, 45 and 10 degrees
        set.far[i].shell_share = 1 - 0.4f * static_cast<float>(i);
        set.far[i].coarse_shares = {0.5f, 0.1f * static_cast<float>(i)};
    }
    constexpr float kDegree = shared::kPi / 180;
    EXPECT_NEAR(shells::shell_share_at(set, 90 * kDegree)[0], 1, 1e-6f);
    EXPECT_NEAR(shells::shell_share_at(set, 45 * kDegree)[0], 0.6f, 1e-5f);
    EXPECT_NEAR(shells::shell_share_at(set, 0)[0], 0.2f, 1e-6f); // held below the last row
    EXPECT_NEAR(shells::shell_share_at(set, 67.5f * kDegree)[2], 0.05f, 1e-5f);
    EXPECT_NEAR(shells::shell_share_at(set, 20 * kDegree)[1], 0.5f, 1e-6f);
}

} // namespace
} // namespace sward
