// SPDX-License-Identifier: Apache-2.0
// Living blades of the meadow: how they lean beside the far tier, where they stand at the
// hand-over, and their patches.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "blades/blade_twin.h"
#include "blades/pages.h"
#include "lod/lod.h"
#include "shared/bindings.h"
#include "texgen/patch/patch.h"
#include "texgen/preset/preset.h"

namespace sward {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

/// The meadow's blades; images are not needed.
const grass::GrassSet& meadow() {
    static const grass::GrassSet set = [] {
        const auto patch =
            texgen::generate_patch(texgen::load_preset(std::filesystem::path(SWARD_SOURCE_DIR) /
                                                       "texgen/presets/meadow.toml"),
                                   2);
        grass::GrassSet out;
        out.side_m = static_cast<float>(patch.side_m);
        out.variants = patch.variants();
        out.blades = patch.blades;
        out.variant_begin = patch.variant_begin;
        for (const shared::BladeRecord& blade : out.blades) {
            out.canopy_m = std::max({out.canopy_m, blade.v1.y, blade.v2.y});
        }
        return out;
    }();
    return set;
}

TEST(NearPose, MeanTipsOfBothTiersAgree) {
    const auto& set = meadow();
    const double response = blades::fit_response(set);
    EXPECT_GT(response, 0.05);
    EXPECT_LT(response, 0.4);
    double worst = 0, gentle = 0;
    for (const double speed : {1.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 30.0, 40.0}) {
        const auto tip =
            blades::mean_tip(set, speed, response, 600); // others than the fit has seen, too
        const double off = glm::length(tip.simulated - tip.warped) / set.canopy_m;
        std::printf("%4.0f m/s: simulated %.1f mm downwind, %.1f mm down; warped %.1f, %.1f; apart "
                    "%.2f %% of the canopy\n",
                    speed, 1e3 * tip.simulated.x, -1e3 * tip.simulated.y, 1e3 * tip.warped.x,
                    -1e3 * tip.warped.y, 100 * off);
        worst = std::max(worst, off);
        gentle = speed <= 10 ? std::max(gentle, off) : gentle;
    }
    EXPECT_LT(gentle, 0.02); // up to 10 m/s
    EXPECT_LT(worst, 0.04);
    // Half the response would not do.
    const auto wrong = blades::mean_tip(set, 10, 0.5 * response, 600);
    EXPECT_GT(glm::length(wrong.simulated - wrong.warped) / set.canopy_m, 0.04);
}

/// A blade's tip as blade.vert draws it at a distance. `fades`: own_pose_share or, to show what it
/// does, all of the own pose.
vec3 drawn_tip(const shared::BladeRecord& blade, vec4 state, vec2 wind, float response,
               float distance, vec2 band, bool fades) {
    const float canopy = meadow().canopy_m;
    vec3 v1(blade.v1), v2(blade.v2), own1, own2;
    shared::pose_blade(
        v1, v2, {blade.shape.y, canopy, response, shared::pose_share(blade.root.z, distance, band)},
        wind);
    shared::simulated_pose(shared::set_blade_shape(blade, canopy), state, own1, own2);
    return glm::mix(v2, own2, fades ? shared::own_pose_share(blade.root.z, distance, band) : 1.0f);
}

TEST(NearPose, AtTheSwapABladeStandsWhereItsShellImageDoes) {
    const auto& set = meadow();
    const float response = static_cast<float>(blades::fit_response(set)),
                focal_px = 935; // 1080 rows, 60 degrees
    const auto bands = lod::bands({}, {focal_px, 0.004, 0.004, 4}, {});
    const vec2 band(bands.handover);
    const shared::BladeStep rules = shared::plain_blade_step(1.0f / 60, set.canopy_m, response);
    double sum = 0, most = 0, most_unfaded = 0;
    int count = 0;
    for (const float speed : {0.0f, 2.0f, 5.0f, 10.0f, 20.0f}) {
        for (std::size_t n = 0; n < set.blades.size(); n += 37) {
            const shared::BladeRecord& blade = set.blades[n];
            const float way = 2.4f * static_cast<float>(n);
            const vec2 wind = speed * vec2(std::cos(way), std::sin(way));
            const auto body = shared::set_blade_body(rules, blade, vec3(0));
            vec4 state(0); // a ball has just passed over it
            for (int i = 0; i < 30; ++i) {
                const float x = -0.4f + 0.05f * static_cast<float>(i);
                const blades::StepSphere ball{{x, 0.25f, 0.1f, 0.25f}, {x - 0.05f, 0.25f, 0.1f, 0}};
                state = blades::step_blade(rules, body, vec3(0), wind, {&ball, 1}, state);
            }
            float distance = 0.5f * band.x; // out to where its first pixel turns to the shell
            while (shared::handover_near(blade.root.z, distance, band, 0.999f,
                                         shared::kHandoverRank)) {
                distance *= 1.001f;
            }
            const vec3 image =
                vec3(blade.v2) + shared::bend_offset(blade.v2.y, set.canopy_m, wind, response);
            const auto pixels = [&](vec3 tip) {
                return glm::distance(tip, image) * focal_px / distance;
            };
            const double off =
                pixels(drawn_tip(blade, state, wind, response, distance, band, true));
            sum += off;
            most = std::max(most, off);
            most_unfaded = std::max<double>(
                most_unfaded,
                pixels(drawn_tip(blade, state, wind, response, distance, band, false)));
            ++count;
        }
    }
    std::printf("%d swaps: %.4f pixels in the mean, %.4f at worst; with the own pose kept, %.1f\n",
                count, sum / count, most, most_unfaded);
    EXPECT_LE(sum / count, 0.5);
    EXPECT_LE(most, 2);
    EXPECT_GT(most_unfaded, 20);
}

TEST(NearPose, OwnPosesFadeSmoothly) {
    const vec2 band(3, 6);
    for (float rank = 0.002f; rank < 1; rank += 0.11f) {
        float before = 1;
        for (float distance = 0.05f; distance < 7; distance += 0.01f) {
            const float share = shared::own_pose_share(rank, distance, band);
            ASSERT_LE(share, before);
            ASSERT_LT(before - share, 0.02f);
            before = share;
        }
        ASSERT_EQ(before, 0.0f);
    }
    EXPECT_EQ(shared::simulated_share(1, {6.4f, 8}), 1.0f);
    EXPECT_EQ(shared::simulated_share(8, {6.4f, 8}), 0.0f);
}

TEST(NearPose, PatchesAreCompactAndHoldEveryBladeOnce) {
    const auto& set = meadow();
    const blades::MortonOrder order(set);
    std::vector<int> seen(set.blades.size(), 0);
    for (std::size_t v = 0; v + 1 < set.variant_begin.size(); ++v) {
        for (std::uint32_t n = set.variant_begin[v]; n < set.variant_begin[v + 1]; ++n) {
            ++seen[order.blades[n]];
            ASSERT_EQ(order.places[order.blades[n]], n - set.variant_begin[v]);
            ASSERT_TRUE(order.blades[n] >= set.variant_begin[v] &&
                        order.blades[n] < set.variant_begin[v + 1]);
        }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
    double area = 0;
    for (const vec4& box : order.boxes) {
        area += (box.z - box.x) * (box.w - box.y);
    }
    const double tiles = static_cast<double>(set.side_m) * set.side_m * set.variants;
    std::printf("%zu patches; their boxes cover %.2f times the ground\n", order.boxes.size(),
                area / tiles);
    EXPECT_LT(area / tiles, 3); // by rank each box would be the whole tile
}

TEST(NearPose, PagesHoldWhatIsNearAndNoMoreThanTheirBytes) {
    const auto& set = meadow();
    const terrain::Surface surface({9, 9, {250, 250}, std::vector<float>(81, 10), {}}, 0);
    blades::Pages pages(set, {});
    pages.update(surface, {0.7, 11.5, 0.3});
    EXPECT_EQ(pages.reach_m(), 8);
    EXPECT_EQ(pages.fresh().size(), pages.used());
    const std::size_t first = pages.used();
    EXPECT_GT(first, 50u);
    const int slot = pages.slot_of({1, 1});
    ASSERT_GE(slot, 0);
    pages.update(surface, {2.7, 11.5, 0.3});
    EXPECT_EQ(pages.slot_of({1, 1}), slot); // what stays keeps its place
    EXPECT_GT(pages.fresh().size(), 0u);
    EXPECT_LT(pages.fresh().size(), first / 2);
    blades::Pages small(set, {8, 3u << 20});
    small.update(surface, {0.7, 11.5, 0.3});
    EXPECT_LE(small.slots().size() * static_cast<std::size_t>(small.order().patches_a_page) *
                  CULL_GROUP * sizeof(vec4),
              3u << 20);
    EXPECT_LT(small.reach_m(), 8);
    EXPECT_GT(small.reach_m(), 2);
    blades::Pages none(set, {0, 64u << 20});
    none.update(surface, {0.7, 11.5, 0.3});
    EXPECT_EQ(none.used(), 0u);
    EXPECT_EQ(none.reach_m(), 0);
}

} // namespace
} // namespace sward
