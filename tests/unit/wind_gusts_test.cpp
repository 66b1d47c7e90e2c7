// SPDX-License-Identifier: Apache-2.0
// The gusts' synthesised spectrum, and the places and weights that wind_at() is made of.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shared/wind.h"
#include "wind/gust_spectrum.h"
#include "wind/state.h"

namespace sward {
namespace {

using shared::vec2;

double mean_square(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values) {
        sum += static_cast<double>(value) * static_cast<double>(value);
    }
    return sum / static_cast<double>(values.size());
}

TEST(GustSpectrum, IsFreeOfDivergenceAndOfUnitStrength) {
    const wind::GustSpectrum spectrum = wind::gust_spectrum(64, 4, 11);
    std::vector<float> u, v;
    for (const double turn : {0.0, 1.3, 40.0}) {
        spectrum.velocities({turn, -0.7 * turn, 0.31 * turn}, u, v);
        double divergence = 0, sum_u = 0, sum_v = 0;
        for (std::size_t y = 0; y < 64; ++y) {
            for (std::size_t x = 0; x < 64; ++x) {
                const std::size_t own = y * 64 + x;
                divergence = std::max(
                    divergence, std::abs(static_cast<double>(u[y * 64 + (x + 1) % 64] - u[own] +
                                                             v[(y + 1) % 64 * 64 + x] - v[own])));
                sum_u += static_cast<double>(u[own]);
                sum_v += static_cast<double>(v[own]);
            }
        }
        EXPECT_LT(divergence, 1e-5);
        EXPECT_NEAR(sum_u / 4096, 0, 1e-5);
        EXPECT_NEAR(sum_v / 4096, 0, 1e-5);
        // At phases 0 exactly; at others as far as a few large gusts average out.
        EXPECT_NEAR(mean_square(u) + mean_square(v), 2, turn == 0.0 ? 1e-4 : 1.2);
    }
}

TEST(GustSpectrum, SeedsDifferAndRepeat) {
    std::vector<float> a, b, c, v;
    wind::gust_spectrum(32, 3, 1).velocities({}, a, v);
    wind::gust_spectrum(32, 3, 1).velocities({}, b, v);
    wind::gust_spectrum(32, 3, 2).velocities({}, c, v);
    EXPECT_EQ(a, b);
    EXPECT_NE(a, c);
}

TEST(GustSpectrum, IsStrongestAtItsPeak) {
    const wind::GustSpectrum spectrum = wind::gust_spectrum(128, 8, 5);
    std::vector<float> u, v;
    spectrum.velocities({}, u, v);
    // Energy of v along x in bands of waves around the torus: v's own spectrum peaks near the
    // gusts'.
    const auto band = [&](int first, int last) {
        double energy = 0;
        for (int k = first; k <= last; ++k) {
            for (std::size_t y = 0; y < 128; ++y) {
                double c = 0, s = 0;
                for (std::size_t x = 0; x < 128; ++x) {
                    const double angle = 2 * 3.14159265358979 * k * static_cast<double>(x) / 128;
                    c += static_cast<double>(v[y * 128 + x]) * std::cos(angle);
                    s += static_cast<double>(v[y * 128 + x]) * std::sin(angle);
                }
                energy += c * c + s * s;
            }
        }
        return energy / (last - first + 1);
    };
    EXPECT_GT(band(5, 9), 5 * band(20, 24));
    EXPECT_LT(band(30, 60), 0.01 * band(5, 9)); // too short for the grid to carry
}

TEST(WindPlaces, TapsOfATileWrapAround) {
    for (const vec2 place : {vec2(0.1f, 0.2f), vec2(7.9f, 0.3f), vec2(3.5f, 7.5f),
                             vec2(-13.0f, 100.0f), vec2(8.0f, 8.0f)}) {
        const shared::WindTap tap = shared::wind_tile_tap(8, place);
        for (int i = 0; i < 4; ++i) {
            ASSERT_GE(tap.at[i], 0);
            ASSERT_LT(tap.at[i], 64);
        }
        EXPECT_EQ((tap.at.x + 1) % 8, tap.at.y % 8);
        EXPECT_EQ((tap.at.x / 8 + 1) % 8, tap.at.z / 8);
        ASSERT_GE(std::min(tap.within.x, tap.within.y), 0);
        ASSERT_LE(std::max(tap.within.x, tap.within.y), 1);
    }
    const shared::WindTap centre =
        shared::wind_tile_tap(8, {3.5f, 7.5f}); // the centre of cell (3, 7)
    EXPECT_EQ(centre.at.x, 7 * 8 + 3);
    EXPECT_EQ(centre.within, vec2(0, 0));
}

TEST(WindPlaces, TheWindowFadesToItsRim) {
    shared::WindField field{};
    field.window_per_m = 2;
    field.window_cells = 100;
    field.window_share = 1;
    field.window_rim = 10;
    EXPECT_EQ(shared::wind_window_share(field, {50, 50}), 1);
    EXPECT_EQ(shared::wind_window_share(field, {3, 50}), 0);
    EXPECT_EQ(shared::wind_window_share(field, {50, -400}), 0);
    EXPECT_NEAR(shared::wind_window_share(field, {50, 91}), 0.5, 1e-6);
    field.window_cells = 0;
    EXPECT_EQ(shared::wind_window_share(field, {50, 50}), 0);
}

TEST(WindState, SharesTimeBetweenItsTwoStates) {
    wind::StateTag tag;
    tag.step_s = 0.5;
    EXPECT_EQ(tag.share(0), 1); // the first state has no other
    tag.latest = 4;
    EXPECT_EQ(tag.share(1.5), 0);
    EXPECT_EQ(tag.share(1.75), 0.5);
    EXPECT_EQ(tag.share(2), 1);
    EXPECT_EQ(tag.share(-10), 0);
    EXPECT_EQ(tag.share(10), 1);
}

} // namespace
} // namespace sward
