// SPDX-License-Identifier: Apache-2.0
// A landcover as the tiers read it: at a border near and far agree, edges are crisp, and nothing stands on a road.
#include <algorithm>

#include "gl/fixture.h"

namespace sward::tests {
namespace {

constexpr int kSide = 512; // texels of 0.5 m
constexpr double kFirst_m = -128;

/// Dry grass 1.6 times as high west of x = -60, a lawn to x = 10, then water; across both a road of 3 m along x at z = 20.25.
scene::DensityMask fields() {
    scene::DensityMask mask;
    mask.width = mask.height = kSide;
    mask.first_m = glm::dvec2(kFirst_m);
    mask.size_m = glm::dvec2(kSide * 0.5);
    mask.highest = 1.6;
    mask.heights = true;
    for (int n = 0; n < kSide * kSide; ++n) {
        const double x = kFirst_m + (n % kSide + 0.5) * 0.5, z = kFirst_m + (n / kSide + 0.5) * 0.5;
        const double road = std::clamp(0.5 + (1.5 - std::abs(z - 20.25)) / 0.5, 0.0, 1.0);
        const double water = x > 10 ? 1 - road : 0, grass = 1 - road - water;
        const double height = x < -60 ? 1.6 : 0.4, dryness = x < -60 ? 0.6 : -0.2;
        mask.density.push_back(static_cast<float>(grass));
        for (const double part : {grass * height / scene::kLandMostHeight, 0.5 + 0.5 * dryness, water, road, 0.0, 0.0, 0.0, 1 - grass})
            mask.land.push_back(static_cast<std::uint8_t>(std::lround(255 * part)));
    }
    return mask;
}

class Land : public GlTest {
protected:
    Land() : world_(flat_field(40), 0, fields(), {0, 41.5, 0}) {}

    /// Density, height, dryness and asphalt at places of the world, of what is as wide as z says.
    std::vector<glm::vec4> read(const std::vector<glm::dvec3>& places) {
        std::vector<glm::vec4> inputs;
        for (const glm::dvec3& place : places)
            inputs.emplace_back(glm::vec2(glm::dvec2(place) - glm::dvec2(world_.anchor.x, world_.anchor.z)), static_cast<float>(place.z), 0);
        return run_probe(shaders_, {"lib/ground.glsl", "lib/land_ground.glsl"},
                         "    b = vec4(mask_density(a.xy, a.z), land_height(a.xy, a.z), land_dryness(a.xy, a.z), grounds_at(a.xy, a.z).asphalt);", inputs);
    }
    /// The means over a rectangle, of each width.
    std::vector<glm::vec4> means(glm::dvec2 middle, glm::dvec2 size, const std::vector<double>& widths) {
        constexpr int kAlong = 64;
        std::vector<glm::dvec3> places;
        for (const double width : widths)
            for (int n = 0; n < kAlong * kAlong; ++n)
                places.emplace_back(middle + size * (glm::dvec2(n % kAlong + 0.5, n / kAlong + 0.5) / double(kAlong) - 0.5), width);
        std::vector<glm::vec4> sums(widths.size(), glm::vec4(0));
        const auto found = read(places);
        for (std::size_t n = 0; n < found.size(); ++n)
            sums[n / (kAlong * kAlong)] += found[n] / static_cast<float>(kAlong * kAlong);
        return sums;
    }
    const ShaderCopy shaders_;
    SmallWorld world_;
};

TEST_F(Land, BordersAgreeBetweenTiers) {
    struct Border {
        glm::dvec2 middle, size;
    };
    // 3 m across each, of which a half is the other's whatever the width.
    for (const Border& border : {Border{{-20, 18.75}, {24, 3}}, Border{{-20, 21.75}, {24, 3}}, Border{{10, -30}, {3, 24}}}) {
        const std::vector<double> widths = {0.001, 0.05, 0.3, 1.0};
        const std::vector<glm::vec4> found = means(border.middle, border.size, widths);
        for (std::size_t n = 1; n < widths.size(); ++n) {
            EXPECT_NEAR(found[n].x, found[0].x, 0.03) << border.middle.x << ", width " << widths[n];
            EXPECT_NEAR(found[n].w, found[0].w, 0.03) << border.middle.x << ", width " << widths[n];
        }
        EXPECT_NEAR(found[0].x, 0.5, 0.03);
    }
}

TEST_F(Land, NothingStandsOnARoad) {
    std::vector<glm::dvec3> places;
    for (int n = 0; n < 4000; ++n)
        places.emplace_back(-50 + 0.01 * n, 17 + 6.5 * ((n * 619) % 4000) / 4000.0, 0.002);
    int between = 0;
    for (const glm::vec4& found : read(places)) {
        EXPECT_NEAR(found.x + found.w, 1, 0.02) << "grass or asphalt, and never both";
        between += found.w > 0.05f && found.w < 0.95f ? 1 : 0;
    }
    EXPECT_LT(between, 80) << "crisp near the eye";
    // Far away the strip is unbroken: every place of it has its share.
    places.clear();
    for (int n = 0; n < 200; ++n)
        places.emplace_back(-55 + 0.3 * n, 20.25, 8);
    for (const glm::vec4& found : read(places))
        EXPECT_NEAR(found.w, 3.0 / 8, 0.12);
}

TEST_F(Land, HeightAndDrynessAreTheClasss) {
    const auto found = read({{-90, -40, 0.01}, {-20, -40, 0.01}, {-20, 18.2, 0.01}});
    EXPECT_NEAR(found[0].y, 1.6, 0.01);
    EXPECT_NEAR(found[0].z, 0.6, 0.01);
    EXPECT_NEAR(found[1].y, 0.4, 0.01);
    EXPECT_NEAR(found[1].z, -0.2, 0.01);
    EXPECT_NEAR(found[2].y, 0.4, 0.02) << "beside a road, too";
    EXPECT_NEAR(means({-60, -60}, {40, 40}, {8})[0].z, 0.2, 0.02) << "from afar the mean";
}

} // namespace
} // namespace sward::tests
