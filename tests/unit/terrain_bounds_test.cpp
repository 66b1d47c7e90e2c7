// SPDX-License-Identifier: Apache-2.0
// Bounds of the ground are never too narrow and seldom too wide; mips of a mask keep areas.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "terrain/mask_mips.h"
#include "terrain/surface.h"

namespace sward::terrain {
namespace {

scene::Heightfield field_of(int width, int height, glm::dvec2 spacing,
                            const std::function<double(int, int)>& value) {
    scene::Heightfield field;
    field.width = width;
    field.height = height;
    field.spacing_m = spacing;
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i)
            field.metres.push_back(static_cast<float>(value(i, j)));
    return field;
}

/// Least and greatest of a grid of samples.
glm::dvec2 sampled(const Surface& surface, glm::dvec2 corner, double side, double spacing) {
    glm::dvec2 range(1e30, -1e30);
    constexpr int kSteps = 24;
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            const double h =
                surface.height(corner.x + side * i / kSteps, corner.y + side * j / kSteps, spacing);
            range = {std::min(range.x, h), std::max(range.y, h)};
        }
    return range;
}

TEST(Bounds, AreNeverTooNarrow) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    const std::vector<glm::ivec2> sizes = {{2, 2}, {3, 2}, {37, 53}, {200, 64}};
    for (const glm::ivec2 size : sizes) {
        const Surface surface(
            field_of(size.x, size.y, {7, 11}, [&](int, int) { return 100 * unit(random); }), 0.5);
        const glm::dvec2 extent = surface.elevation().extent_m();
        for (int n = 0; n < 300; ++n) {
            const double side =
                std::exp(std::log(0.5) + unit(random) * std::log(3 * std::max(extent.x, extent.y)));
            const glm::dvec2 corner =
                (glm::dvec2(unit(random), unit(random)) - 0.55) * extent * 1.1;
            const glm::dvec2 truth = sampled(surface, corner, side, 0.5),
                             bounds = surface.bounds(corner, side);
            ASSERT_LE(bounds.x, truth.x) << side;
            ASSERT_GE(bounds.y, truth.y) << side;
            ASSERT_LE(surface.range().x, truth.x);
            ASSERT_GE(surface.range().y, truth.y);
        }
    }
}

TEST(Bounds, SeeATowerBetweenTheSamples) {
    const Surface surface(field_of(801, 801, {1, 1},
                                   [](int i, int j) {
                                       return i >= 394 && i <= 406 && j >= 390 && j <= 402 ? 60 : 0;
                                   }),
                          0);
    for (const double side : {16.0, 32.0, 64.0, 256.0, 2048.0})
        EXPECT_GE(surface.bounds({-0.4 * side, -0.6 * side}, side).y, 60) << side;
    EXPECT_LT(surface.bounds({40, 40}, 64).y, 0.1) << "and nothing beside it";
    EXPECT_LT(surface.range().y, 85);
}

TEST(Bounds, AreTightOnSlopes) {
    const Surface surface(
        field_of(101, 101, {30, 30}, [](int i, int j) { return 6.0 * i + 3.0 * j; }), 0);
    for (const double side : {4.0, 32.0, 128.0, 512.0}) {
        const glm::dvec2 bounds = surface.bounds({-100, -200}, side),
                         truth = sampled(surface, {-100, -200}, side, 0.5);
        const double slack = side < 100 ? 0.1 : 0.75 * (truth.y - truth.x);
        EXPECT_NEAR(bounds.x, truth.x, slack) << side;
        EXPECT_NEAR(bounds.y, truth.y, slack) << side;
    }
}

TEST(MaskMips, KeepAreasAndPlaces) {
    const std::vector<glm::ivec2> sizes = {{37, 21}, {64, 32}, {1, 9}, {5, 1}, {100, 75}};
    for (const glm::ivec2 start : sizes) {
        std::vector<float> texels;
        for (int j = 0; j < start.y; ++j)
            for (int i = 0; i < start.x; ++i)
                texels.push_back(static_cast<float>((i + 0.5) / start.x)); // a ramp from 0 to 1
        glm::ivec2 size = start;
        for (int mip = 1; mip < mip_count(start); ++mip) {
            texels = next_mip(texels, size);
            ASSERT_EQ(size, glm::max(start >> mip, glm::ivec2(1)));
            ASSERT_EQ(texels.size(),
                      static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
            EXPECT_NEAR(std::accumulate(texels.begin(), texels.end(), 0.0) / double(texels.size()),
                        0.5, 1e-5);
            for (int i = 0; i < size.x; ++i)
                EXPECT_NEAR(texels[static_cast<std::size_t>(i)], (i + 0.5) / size.x, 0.02)
                    << start.x << " mip " << mip;
        }
        EXPECT_EQ(size, glm::ivec2(1));
    }
}

} // namespace
} // namespace sward::terrain
