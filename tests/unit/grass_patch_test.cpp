// SPDX-License-Identifier: Apache-2.0
// Presets, and the places and shapes of the blades that they ask for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "grass_fixture.h"
#include "texgen/patch/canopy.h"
#include "texgen/patch/patch.h"

namespace sward::texgen {
namespace {

using base::ExitCode;
using shared::BladeRecord;

TEST(Preset, RefusesNonsenseWithKeyValueAndRange) {
    struct Case {
        const char* text;
        ExitCode code;
        std::vector<std::string> says;
    };
    const std::vector<Case> cases = {
        {"name = \"a\"\n[patch]\ndensity_per_m = 5\n",
         ExitCode::kBadInput,
         {"p.toml:3", "density_per_m", "patch.density_per_m2"}},
        {"[blades]\nlength_m = [1, 2]\n", ExitCode::kBadInput, {"p.toml:1", "blades", "blade"}},
        {"[patch]\ndensity_per_m2 = -5\n",
         ExitCode::kBadInput,
         {"p.toml:2", "patch.density_per_m2", "-5", "1 to 1000000"}},
        {"[patch]\ndensity_per_m2 = nan\n", ExitCode::kBadInput, {"density_per_m2", "nan"}},
        {"[patch]\nside_m = inf\n", ExitCode::kBadInput, {"side_m", "inf"}},
        {"[patch]\ndensity_per_m2 = 50000\nside_m = 60\n",
         ExitCode::kOverLimit,
         {"blades", "200000"}},
        {"[texture]\nsize = 0\n", ExitCode::kBadInput, {"texture.size", "32 to 2048"}},
        {"[texture]\nsize = 16385\n", ExitCode::kBadInput, {"texture.size", "16385"}},
        {"[texture]\nsize = 300\n", ExitCode::kBadInput, {"texture.size", "power of two"}},
        {"[texture]\nsize = 512.5\n", ExitCode::kBadInput, {"texture.size", "whole"}},
        {"[texture]\nlayers = 2049\n", ExitCode::kBadInput, {"texture.layers", "2049"}},
        {"[texture]\nsize = 2048\nlayers = 256\n", ExitCode::kOverLimit, {"texture", "1024 MiB"}},
        {"[blade]\nlength_m = [0.4, 0.2]\n", ExitCode::kBadInput, {"blade.length_m", "rising"}},
        {"[blade]\nlength_m = 0.3\n", ExitCode::kBadInput, {"blade.length_m", "two"}},
        {"[blade]\nlength_m = [0.2, 3.0]\n", ExitCode::kBadInput, {"patch.side_m", "reach"}},
        {"[colour]\ntip = [0.1, 0.2, 1.5]\n", ExitCode::kBadInput, {"colour.tip", "0 to 1"}},
        {"name = \"../up\"\n", ExitCode::kBadInput, {"name", "../up"}},
        {"seed = \n", ExitCode::kBadInput, {"p.toml:1"}},
    };
    for (const Case& c : cases) {
        const auto [code, text] = error_of([&] { (void)parse_preset(c.text, "p.toml"); });
        EXPECT_EQ(code, c.code) << c.text << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        for (const std::string& part : c.says)
            EXPECT_NE(text.find(part), std::string::npos)
                << c.text << "'" << part << "' not in: " << text;
    }
}

TEST(Patch, RestCurveKeepsLengthAndAngles) {
    for (const double bend : {0.0, 1e-5, 0.3, 1.0, 2.2}) {
        const RestCurve curve = rest_curve(0.3, 0.2, bend, 0.7);
        double length = 0; // by summing chords
        for (int i = 0; i < 4096; ++i)
            length += glm::length(
                glm::dvec3(
                    shared::blade_curve(curve.v1, curve.v2, static_cast<float>(i + 1) / 4096)) -
                glm::dvec3(shared::blade_curve(curve.v1, curve.v2, static_cast<float>(i) / 4096)));
        EXPECT_NEAR(length, 0.3, 2e-5) << bend;
        EXPECT_NEAR(curve_length(curve.v1, curve.v2), 0.3, 1e-6) << bend;
        const shared::vec3 root = shared::blade_tangent(curve.v1, curve.v2, 0),
                           tip = shared::blade_tangent(curve.v1, curve.v2, 1);
        EXPECT_NEAR(std::acos(root.y), 0.2, 1e-4);
        EXPECT_NEAR(std::acos(tip.y), 0.2 + bend, 1e-4);
    }
}

TEST(Patch, VariantsAgreeAlongEdgesAndDifferInside) {
    const Preset preset = small_meadow();
    const Patch patch = small_patch();
    ASSERT_EQ(patch.variants(), 3);
    EXPECT_EQ(patch.variant(0).size(), 1200u);
    const double border = border_width(preset);
    std::size_t same_inside = 0, inside = 0, at_border = 0;
    for (int v = 1; v < patch.variants(); ++v) {
        ASSERT_EQ(patch.variant(v).size(), patch.variant(0).size());
        for (std::size_t i = 0; i < patch.variant(0).size(); ++i) {
            const BladeRecord &a = patch.variant(0)[i], &b = patch.variant(v)[i];
            const bool same = std::memcmp(&a, &b, sizeof a) == 0;
            const auto touches_rim = [&](const BladeRecord& r) {
                const Outline o = outline_of(r, patch.looks);
                return std::min(o.low.x, o.low.z) < 0.02 * patch.side_m ||
                       std::max(o.high.x, o.high.z) > 0.98 * patch.side_m;
            };
            const auto rooted_in_rim = [&](const BladeRecord& r) {
                return std::min({r.root.x, r.root.y, 2 - r.root.x, 2 - r.root.y}) < border * 0.999;
            };
            if (touches_rim(a) || touches_rim(b) || rooted_in_rim(a) || rooted_in_rim(b)) {
                EXPECT_TRUE(same) << "blade " << i << " of variant " << v;
                ++at_border;
            } else {
                ++inside;
                same_inside += same;
            }
        }
    }
    EXPECT_GT(at_border, 500u);
    EXPECT_GT(inside, 500u);
    EXPECT_LT(static_cast<double>(same_inside),
              0.45 * static_cast<double>(inside)); // whole tufts near the rim are shared
}

TEST(Patch, RanksAndSeedsHaveEqualCountsAndAreIndependent) {
    const Patch patch = small_patch();
    for (int v = 0; v < patch.variants(); ++v) {
        const auto blades = patch.variant(v);
        std::vector<int> rank(256), seed(256), joint(64);
        double product = 0;
        float last = 0;
        for (const BladeRecord& b : blades) {
            EXPECT_EQ(b.root.z, shared::unorm8_to_unit(std::floor(b.root.z * 256) / 255.0f));
            ++rank[static_cast<std::size_t>(b.root.z * 256)];
            ++seed[static_cast<std::size_t>(b.root.w * 256)];
            ++joint[static_cast<std::size_t>(b.root.z * 8) * 8 +
                    static_cast<std::size_t>(b.root.w * 8)];
            product += (b.root.z - 0.5) * (b.root.w - 0.5) * 12;
            EXPECT_GE(b.root.z, last);
            last = b.root.z;
        }
        const auto [low, high] = std::ranges::minmax(rank);
        EXPECT_LE(high - low, 1);
        const auto [seed_low, seed_high] = std::ranges::minmax(seed);
        EXPECT_LE(seed_high - seed_low, 1);
        EXPECT_LT(std::abs(product / static_cast<double>(blades.size())), 0.01);
        const double expected = static_cast<double>(blades.size()) / 64;
        for (const int n : joint)
            EXPECT_NEAR(n, expected, 0.3 * expected);
    }
}

/// Mean distance to the nearest other point on the torus.
double spacing(const std::vector<shared::vec2>& points, double side) {
    double sum = 0;
    for (const shared::vec2& p : points) {
        double least = 1e9;
        for (const shared::vec2& q : points)
            if (&p != &q)
                least = std::min(least, std::hypot(nearest_image(p.x - q.x, side),
                                                   nearest_image(p.y - q.y, side)));
        sum += least;
    }
    return sum / static_cast<double>(points.size());
}

TEST(Patch, EveryRankPrefixIsSpreadMoreEvenlyThanChance) {
    const Patch patch = small_patch();
    std::mt19937 random(1);
    constexpr int kTrials = 8;
    for (const double share : {0.05, 0.1, 0.25, 0.5}) {
        double mean = 0; // a prefix of 60 blades is too few to ask more than a little of each
        for (int v = 0; v < patch.variants(); ++v) {
            std::vector<shared::vec2> all;
            for (const BladeRecord& b : patch.variant(v))
                all.emplace_back(b.root.x, b.root.y);
            const auto count = static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size()));
            const double ranked = spacing({all.begin(), all.begin() + count}, 2);
            double chance = 0;
            for (int trial = 0; trial < kTrials; ++trial) {
                std::ranges::shuffle(all, random);
                chance += spacing({all.begin(), all.begin() + count}, 2) / kTrials;
            }
            EXPECT_GT(ranked, 1.05 * chance) << "variant " << v << ", share " << share;
            mean += ranked / chance / patch.variants();
        }
        EXPECT_GT(mean, 1.2) << share;
    }
}

TEST(Patch, IsTheSameAtAnyThreadCount) {
    const Patch one = generate_patch(small_meadow(), 1), four = generate_patch(small_meadow(), 4);
    ASSERT_EQ(one.blades.size(), four.blades.size());
    EXPECT_EQ(
        std::memcmp(one.blades.data(), four.blades.data(), one.blades.size() * sizeof(BladeRecord)),
        0);
}

} // namespace
} // namespace sward::texgen
