// SPDX-License-Identifier: Apache-2.0
// The march on the CPU, by the very functions that the shaders call: its path, its mean depth, its
// correction, its light, what slopes do to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grass_fixture.h"
#include "shared/march_light.h"
#include "shells/far_appearance.h"
#include "shells/march_light.h"
#include "texgen/far/march_fit.h"
#include "texgen/far/march_slope.h"

namespace sward::texgen {
namespace {

constexpr float kDegree = shared::kPi / 180;

shared::MarchPath path_down(const shared::MarchMedium& medium, float elevation_deg, float bend) {
    shared::MarchPath path;
    path.way = {std::cos(elevation_deg * kDegree), -std::sin(elevation_deg * kDegree), 0};
    path.bend = {0.6f, 0.8f, bend / medium.canopy_m, 0};
    path.bend.w = shared::march_bent_height(path, medium.canopy_m);
    path.from = {0.3f, path.bend.w, 0.7f};
    path.height = {path.bend.w, path.way.y, 0, -path.bend.w / path.way.y};
    return path;
}

shared::Light light_from(float elevation_deg, float azimuth_deg) {
    const float e = elevation_deg * kDegree, a = azimuth_deg * kDegree;
    shared::Light light{};
    light.to_sun = {std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a)};
    light.sun_extinction = shared::kSunExtinction;
    light.sun = {1, 0.95f, 0.85f};
    light.zenith = {0.15f, 0.2f, 0.3f};
    light.sky_extinction = shared::kSkyExtinction;
    light.horizon = {0.3f, 0.33f, 0.36f};
    return light;
}

TEST(March, RestHeightsUndoTheBend) {
    const shared::MarchMedium& medium = small_set().march.medium;
    for (const float bend : {0.0f, 0.4f, 0.9f}) {
        const shared::MarchPath path = path_down(medium, 30, bend);
        for (int i = 0; i <= 20; ++i) {
            const float y = medium.canopy_m * static_cast<float>(i) / 20;
            EXPECT_NEAR(shared::march_rest_height(path, shared::march_bent_height(path, y)), y,
                        1e-4f * medium.canopy_m)
                << bend;
        }
    }
}

TEST(March, DepthIsTheSumOfItsPartsHoweverItIsCut) {
    const shared::MarchMedium& medium = small_set().march.medium;
    for (const float elevation : {3.0f, 20.0f, 70.0f}) {
        const shared::MarchPath path = path_down(medium, elevation, 0.3f);
        shared::MarchWalk whole = shared::march_begin(path);
        const float depth = shared::march_advance(medium, path, whole, {1e9f, 1e9f, 1});
        shared::MarchWalk walk = shared::march_begin(path);
        float sum = 0;
        for (int i = 1; i <= 37; ++i)
            sum += shared::march_advance(
                medium, path, walk,
                {path.height.w * static_cast<float>(i) / 37 + (i == 37 ? 1.0f : 0.0f), 1e9f, 1});
        EXPECT_NEAR(sum, depth, 1e-3f * depth) << elevation;
        EXPECT_FALSE(shared::march_inside(path, walk));
    }
}

TEST(March, ColumnsStepsSeeWhatTheMeanFieldSees) {
    const shared::MarchMedium& medium = small_set().march.medium;
    for (const float elevation : {5.0f, 30.0f, 80.0f}) {
        const shared::MarchPath path = path_down(medium, elevation, 0);
        shared::MarchPlan plan = shared::march_look(medium, path, {0.01f, 100, 1});
        plan.kind = shared::kMarchColumns;
        shared::march_settle(medium, plan);
        shared::MarchWalk whole = shared::march_begin(path), walk = whole;
        const float depth = shared::march_advance(medium, path, whole, {1e9f, 1e9f, 1});
        float sum = 0;
        int steps = 0;
        for (; steps < shared::kMarchSteps && shared::march_inside(path, walk); ++steps)
            sum += shared::march_column(medium, path, plan, walk, {static_cast<float>(steps), 1})
                       .depth;
        EXPECT_NEAR(1 - std::exp(-sum), 1 - std::exp(-depth), 0.01f) << elevation;
        EXPECT_LE(steps, plan.steps + shared::kMarchLayers)
            << elevation; // each ends at an equal part, or where its layer does
    }
}

TEST(March, LightOfTheCoarsestColumnsIsTheMeasure) {
    const std::vector<float>& table = small_set().march.correction;
    ASSERT_EQ(table.size(), grass::kMarchCorrections);
    const std::size_t row = (shared::kMarchColumns * shared::kMarchMips + shared::kMarchMips - 1) *
                            shared::kMarchElevations;
    for (std::size_t e = 0; e < shared::kMarchElevations; ++e) {
        EXPECT_NEAR(table[(row + e) * grass::kMarchFactors + 1], 1, 0.03f)
            << e; // at mip 9.5, past the last that was fitted
        EXPECT_NEAR(table[(row + e) * grass::kMarchFactors + 3], 1, 0.03f) << e;
    }
    for (const float factor : table)
        EXPECT_TRUE(factor > 0 && factor < 8) << factor;
}

TEST(March, FactorsMakeItAsBrightAsRaysThroughTheBlades) {
    const grass::GrassSet& set = small_set();
    const shells::MeanMarch mean(set);
    const shared::Light light = light_from(35, 70);
    constexpr int kAzimuths = shells::MarchLight::kAzimuths,
                  kRows = shells::MarchLight::kElevations;
    for (const glm::vec4& wind : {glm::vec4(0, 0, 0, 0.02f), glm::vec4(5, -3, 0, 0.02f)}) {
        const std::vector<float> factors = shells::light_factors(mean, set.far_light, light, wind);
        const std::vector<glm::vec4> truth = shells::canopy_table(set.far_light, light, wind);
        ASSERT_EQ(factors.size(), static_cast<std::size_t>(kAzimuths * kRows));
        float most = 0;
        for (std::size_t i = 0; i < factors.size(); ++i) {
            const float sine = std::max(static_cast<float>(i / kAzimuths) / (kRows - 1), 0.02f),
                        flat = std::sqrt(std::max(1 - sine * sine, 0.0f));
            const float heading =
                70 * kDegree - 2 * shared::kPi * static_cast<float>(i % kAzimuths) / kAzimuths;
            const glm::vec3 marched = mean.radiance(
                light, wind, {flat * std::cos(heading), sine, flat * std::sin(heading)});
            const glm::vec3 wanted = glm::vec3(truth[i]) + glm::vec3(truth[i + factors.size()]);
            const glm::vec3 luminance(0.2126f, 0.7152f, 0.0722f);
            EXPECT_NEAR(factors[i] * glm::dot(marched, luminance), glm::dot(wanted, luminance),
                        0.01f * glm::dot(wanted, luminance))
                << i;
            most = std::max(most, std::abs(factors[i] - 1));
        }
        EXPECT_LT(most, 0.4f); // repairs a closure, not a fault
        EXPECT_GT(most, 0.01f);
    }
}

TEST(March, WhatIsSeenUphillLeansTowardTheEye) {
    const auto& slopes = small_set().march.medium.slopes;
    for (int row = 1; row < 8; ++row) { // 5 to 35 degrees
        EXPECT_LT(slopes[row].x, slopes[row].y) << row;
        EXPECT_LT(slopes[row].y, slopes[row].z) << row;
    }
    EXPECT_GT(slopes[0].z, 0.05f);
    EXPECT_LT(slopes[0].w, 0.01f); // and is no higher up
    EXPECT_NEAR(slopes[0].y, 0, 0.05f);
}

TEST(March, GroundThatRisesChangesTheLight) {
    const shared::MarchMedium& medium = small_set().march.medium;
    const shared::Light light = light_from(40, 180);
    const glm::vec3 to_eye(-1, 0, 0); // the eye stands to the west, before the sun
    const auto radiance = [&](float rise) {
        shared::GrassSums sums = shared::march_nothing();
        shared::march_gather(sums, light, 0.8f, {{0.1f, 0.2f, 0.05f}, {0, 0.85f, 0}, 0.6f, 1});
        shared::march_stand(medium, sums, light, {5, rise, 0.8f}, to_eye);
        return shared::march_radiance(medium, light, sums, to_eye).y;
    };
    EXPECT_LT(radiance(0.5f),
              0.97f * radiance(0)); // blades lean toward the sun too, and take less of its light
    EXPECT_GT(radiance(-0.5f), radiance(0.5f));
}

} // namespace
} // namespace sward::texgen
