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

    /// Density, height, dryness and asphalt at places of the world, of what is `width` metres wide.
    std::vector<glm::vec4> read(const std::vector<glm::dvec2>& places, double width) {
        std::vector<glm::vec4> inputs;
        for (const glm::dvec2 place : places)
            inputs.emplace_back(glm::vec2(place - glm::dvec2(world_.anchor.x, world_.anchor.z)), static_cast<float>(width), 0);
        return run_probe(shaders_, {"lib/ground.glsl", "lib/land_ground.glsl"},
                         "    b = vec4(mask_density(a.xy, a.z), land_height(a.xy, a.z), land_dryness(a.xy, a.z), grounds_at(a.xy, a.z).asphalt);", inputs);
    }
    /// The mean over a square of `side` metres.
    glm::vec4 mean(glm::dvec2 middle, double side, double width) {
        constexpr int kAlong = 96;
        std::vector<glm::dvec2> places;
        for (int n = 0; n < kAlong * kAlong; ++n)
            places.push_back(middle + side * (glm::dvec2(n % kAlong + 0.5, n / kAlong + 0.5) / double(kAlong) - 0.5));
        glm::vec4 sum(0);
        for (const glm::vec4& found : read(places, width))
            sum += found;
        return sum / static_cast<float>(kAlong * kAlong);
    }
    const ShaderCopy shaders_;
    SmallWorld world_;
};

TEST_F(Land, BordersAgreeBetweenTiers) {
    for (const glm::dvec2 middle : {glm::dvec2(-20, 18.9), glm::dvec2(-20, 22), glm::dvec2(10, -30)}) {
        const glm::vec4 blades = mean(middle, 6, 0.001);
        for (const double width : {0.05, 0.3, 1.0}) {
            const glm::vec4 pixels = mean(middle, 6, width);
            EXPECT_NEAR(pixels.x, blades.x, 0.03) << middle.x << ", width " << width;
            EXPECT_NEAR(pixels.w, blades.w, 0.03) << middle.x << ", width " << width;
        }
    }
}

TEST_F(Land, NothingStandsOnARoad) {
    std::vector<glm::dvec2> places;
    for (int n = 0; n < 4000; ++n)
        places.emplace_back(-50 + 0.01 * n, 17 + 6.5 * ((n * 619) % 4000) / 4000.0);
    int between = 0;
    for (const glm::vec4& found : read(places, 0.002)) {
        EXPECT_NEAR(found.x + found.w, 1, 0.02) << "grass or asphalt, and never both";
        between += found.w > 0.05f && found.w < 0.95f ? 1 : 0;
    }
    EXPECT_LT(between, 80) << "crisp near the eye";
    // Far away the strip is unbroken: every place of it has its share.
    places.clear();
    for (int n = 0; n < 200; ++n)
        places.emplace_back(-55 + 0.3 * n, 20.25);
    for (const glm::vec4& found : read(places, 8))
        EXPECT_NEAR(found.w, 3.0 / 8, 0.12);
}

TEST_F(Land, HeightAndDrynessAreTheClasss) {
    const auto found = read({{-90, -40}, {-20, -40}, {-20, 18.2}}, 0.01);
    EXPECT_NEAR(found[0].y, 1.6, 0.01);
    EXPECT_NEAR(found[0].z, 0.6, 0.01);
    EXPECT_NEAR(found[1].y, 0.4, 0.01);
    EXPECT_NEAR(found[1].z, -0.2, 0.01);
    EXPECT_NEAR(found[2].y, 0.4, 0.02) << "beside a road, too";
    EXPECT_NEAR(mean({-60, -60}, 40, 8).z, 0.2, 0.02) << "from afar the mean";
}

} // namespace
} // namespace sward::tests
