// SPDX-License-Identifier: Apache-2.0
// What a frame selects on the CPU: bands by projected size, tiles of blades, shells and slices.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "blades/blade_tiles.h"
#include "gl/synthetic.h"
#include "lod/lod.h"
#include "shared/bindings.h"
#include "shared/hash.h"
#include "shared/tile_lie.h"
#include "shells/far_instances.h"
#include "shells/far_shares.h"

namespace sward {
namespace {

constexpr lod::Projection kView{900, 0.006, 0.004, 4};

void expect_ordered(const lod::Bands& bands, int levels) {
    EXPECT_LT(bands.handover.x, bands.handover.y);
    EXPECT_EQ(bands.far[0].x, bands.handover.x); // what blades hand on, level 0 takes over
    EXPECT_EQ(bands.far[0].y, bands.handover.y);
    for (std::size_t k = 0; k < static_cast<std::size_t>(levels); ++k) {
        EXPECT_LT(bands.far[k].x, bands.far[k].y) << k;
        EXPECT_LE(bands.far[k].y, bands.far[k].z) << k;
        EXPECT_LT(bands.far[k].z, bands.far[k].w) << k;
        if (k > 0) {
            EXPECT_EQ(bands.far[k].x, bands.far[k - 1].z) << k;
            EXPECT_EQ(bands.far[k].y, bands.far[k - 1].w) << k;
        }
    }
}

TEST(Bands, AreOrderedAndChained) {
    for (int levels = 1; levels <= 4; ++levels) {
        for (const double focal : {50.0, 900.0, 20000.0}) {
            expect_ordered(lod::bands({}, {focal, 0.006, 0.004, levels}, {}), levels);
        }
    }
}

TEST(Bands, ScaleWithFocalLength) {
    const lod::Bands one = lod::bands({}, kView, {});
    lod::Projection tele = kView;
    tele.focal_px *= 3;
    const lod::Bands three = lod::bands({}, tele, {});
    EXPECT_NEAR(three.handover.y, 3 * one.handover.y, 1e-3f);
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(three.far[k].w, 3 * one.far[k].w, 1e-2f);
    }
    // A blade is blade_start_px wide where the band starts.
    EXPECT_NEAR(kView.focal_px * kView.blade_width_m / one.handover.x,
                lod::Settings{}.blade_start_px, 1e-4);
    EXPECT_NEAR(kView.focal_px * kView.blade_width_m / one.handover.y,
                lod::Settings{}.blade_gone_px, 1e-4);
}

TEST(Bands, OverridesHold) {
    scene::LodSpec lod;
    lod.handover_start_m = 6;
    lod.handover_end_m = 15;
    lod.far_end_m = 333;
    const lod::Bands bands = lod::bands({}, kView, lod);
    EXPECT_EQ(bands.handover, glm::vec2(6, 15));
    EXPECT_EQ(bands.far[3].w, 333.0f);
    expect_ordered(bands, 4);
}

TEST(Bands, OddOverridesStayOrdered) {
    for (const auto& [start, end, far] : {std::tuple{500.0, -1.0, -1.0},
                                          {-1.0, 0.5, -1.0},
                                          {-1.0, -1.0, 3.0},
                                          {2.0, 2.0, 2.0},
                                          {0.1, 4000.0, 5000.0}}) {
        scene::LodSpec lod;
        const auto given = [](double x) { return x < 0 ? std::nullopt : std::optional(x); };
        lod.handover_start_m = given(start);
        lod.handover_end_m = given(end);
        lod.far_end_m = given(far);
        SCOPED_TRACE(testing::Message() << start << " " << end << " " << far);
        expect_ordered(lod::bands({}, kView, lod), 4);
    }
}

// ---- blade_tiles

/// Looks to -z from `eye` with 90 degrees each way; reversed depth does not matter to the frustum.
glm::mat4 wide_view(glm::vec3 eye) {
    glm::mat4 projection(0);
    projection[0][0] = projection[1][1] = 1;
    projection[2][3] = -1;
    projection[3][2] = 0.05f;
    glm::mat4 view(1);
    view[3] = glm::vec4(-eye, 1);
    return projection * view;
}

class BladeTiles : public testing::Test {
protected:
    BladeTiles() : set_(tests::synthetic_set()), surface_(tests::hilly_field(), 0.5) {
        query_.anchor = {64, 300, -128};
        const glm::dvec3 eye(70.3, surface_.height(70.3, -120.9) + 1.7, -120.9);
        query_.eye = glm::vec3(eye - query_.anchor);
        query_.band = {4, 9};
    }
    /// Blades that the list hands to the cull pass: tile corner and index in the set.
    using Blades = std::set<std::tuple<float, float, std::uint32_t>>;
    Blades listed(const blades::TileList& list) const {
        Blades out;
        for (const glm::uvec2& item : list.items) {
            const shared::BladeTile& tile = list.tiles[item.x];
            for (std::uint32_t b = item.y; b < std::min(item.y + CULL_GROUP, tile.end); ++b) {
                EXPECT_TRUE(out.emplace(tile.corner.x, tile.corner.y, b).second)
                    << "a blade listed twice";
            }
        }
        return out;
    }
    /// Is the blade's root near, and in view by a metre at least?
    bool wanted(glm::dvec2 world, const shared::BladeRecord& blade, const glm::mat4& clip) const {
        const glm::vec3 root(glm::dvec3(world.x, surface_.height(world.x, world.y), world.y) -
                             query_.anchor);
        const glm::vec4 p = clip * glm::vec4(root, 1);
        return shared::handover_may_be_near(blade.root.z, glm::distance(root, query_.eye),
                                            query_.band, query_.mode) &&
               std::abs(p.x) < p.w && std::abs(p.y) < p.w;
    }
    void expect_complete(const blades::TileList& list, const glm::mat4& clip) const {
        const Blades in_list = listed(list);
        EXPECT_EQ(list.considered, in_list.size());
        const glm::dvec2 eye(query_.anchor.x + query_.eye.x, query_.anchor.z + query_.eye.z);
        const glm::ivec2 middle(glm::floor(eye / static_cast<double>(set_.side_m)));
        std::size_t near = 0;
        for (int n = 0; n < 17 * 17; ++n) {
            const glm::ivec2 tile = middle + glm::ivec2(n % 17, n / 17) - 8;
            const auto variant =
                static_cast<std::size_t>(shared::tile_variant(tile, set_.variants));
            const glm::dvec2 corner = glm::dvec2(tile) * static_cast<double>(set_.side_m);
            const glm::vec2 place(corner - glm::dvec2(query_.anchor.x, query_.anchor.z));
            for (std::uint32_t b = set_.variant_begin[variant]; b < set_.variant_begin[variant + 1];
                 ++b) {
                const shared::BladeRecord blade =
                    shared::lay_blade(shared::tile_lie(tile), set_.blades[b], set_.side_m);
                if (wanted(corner + glm::dvec2(blade.root), blade, clip)) {
                    ++near;
                    EXPECT_TRUE(in_list.count({place.x, place.y, b}))
                        << "tile " << tile.x << "," << tile.y << " blade " << b;
                }
            }
        }
        EXPECT_GT(near, 500u); // or the test shows nothing
    }
    grass::GrassSet set_;
    terrain::Surface surface_;
    blades::TileQuery query_;
};

TEST_F(BladeTiles, LeaveOutNoBladeThatCouldBeNear) {
    for (const int mode : {shared::kHandoverRank, shared::kHandoverOff, shared::kHandoverHard,
                           shared::kHandoverFade}) {
        query_.mode = mode;
        const glm::mat4 clip = wide_view(query_.eye);
        expect_complete(select_tiles(set_, surface_, terrain::Frustum(clip), query_), clip);
    }
}

TEST_F(BladeTiles, LeaveOutNoBladeSeenFromAbove) {
    query_.eye.y += 5;
    glm::mat4 down = wide_view(query_.eye);
    down = glm::mat4({1, 0, 0, 0}, {0, 0, 0, -1}, {0, 1, 0, 0}, {0, 0, 0.05f, 0});
    glm::mat4 view(1);
    view[3] = glm::vec4(-query_.eye, 1);
    const glm::mat4 clip = down * view;
    query_.band = {6, 12};
    expect_complete(select_tiles(set_, surface_, terrain::Frustum(clip), query_), clip);
}

TEST_F(BladeTiles, ComeNearestFirstAndCountWhatTheyHold) {
    const auto list = select_tiles(set_, surface_, terrain::Frustum(wide_view(query_.eye)), query_);
    ASSERT_FALSE(list.tiles.empty());
    EXPECT_LT(list.considered, 289u * 300u / 4); // far from everything around
    std::uint32_t tile_before = 0;
    for (const glm::uvec2& item : list.items) {
        EXPECT_GE(item.x, tile_before); // tiles in order
        tile_before = item.x;
    }
    const glm::vec2 eye(query_.eye.x, query_.eye.z);
    const auto gap = [&](const shared::BladeTile& tile) {
        const glm::vec2 low = tile.corner - eye;
        return glm::length(glm::max(glm::max(low, -low - set_.side_m), glm::vec2(0)));
    };
    for (const shared::BladeTile& tile : list.tiles) {
        EXPECT_LE(gap(tile), query_.band.y);
    }
    EXPECT_LE(gap(list.tiles.front()), gap(list.tiles.back()));
}

TEST_F(BladeTiles, FromHighAboveThereAreNone) {
    query_.eye.y += 200;
    EXPECT_TRUE(select_tiles(set_, surface_, terrain::Frustum(wide_view(query_.eye)), query_)
                    .items.empty());
}

// ---- far_instances

terrain::VisibleBlock block_at(glm::vec2 corner, float cell) {
    return {corner, cell, 0, -0.05f, 0.05f, 0};
}

class FarInstances : public testing::Test {
protected:
    FarInstances()
        : set_(tests::synthetic_set()), bands_(lod::bands({}, {300, 0.006, 0.03, 3}, {})) {
        query_.eye = query_.lod_eye = {1.3f, 1.7f, -2.2f};
        query_.patch_offset = {0.75f, 1.25f};
        query_.shares = shells::fitted_shares(set_);
    }
    shells::FarList select(const std::vector<terrain::VisibleBlock>& blocks) const {
        return select_far(set_, blocks, bands_, query_);
    }

    grass::GrassSet set_;
    lod::Bands bands_;
    shells::FarQuery query_;
};

TEST_F(FarInstances, EverySlicePlaneOfABlockIsThereOnce) {
    query_.alone = true;
    const std::vector<terrain::VisibleBlock> blocks = {
        block_at({8, 8}, 0.5f), block_at({12, 8}, 0.5f), block_at({-24, -4}, 1.0f)};
    const auto list = select(blocks);
    std::map<std::pair<int, int>, int> count; // of axis and block
    for (const shared::FarInstance& slice : list.slices[0]) {
        const auto& block = blocks[static_cast<std::size_t>(slice.block)];
        const int axis = slice.axis;
        EXPECT_GE(slice.place_m, block.corner[axis]);
        EXPECT_LT(slice.place_m, block.corner[axis] + 8 * block.cell);
        ++count[{axis, slice.block}];
        // The plane shows the image of its own place in the patch.
        const double in_patch = std::fmod(
            slice.place_m + query_.patch_offset[axis] + 1000.0 * set_.side_m, set_.side_m);
        const int slices = set_.levels[0].slice_count;
        const int expected = static_cast<int>(in_patch / set_.side_m * slices);
        EXPECT_EQ(slice.image, shared::slice_index(0, axis, expected, slices, shared::kPlaneId));
        EXPECT_EQ(slice.planes, shared::slice_index(1, axis, expected, slices, 0) -
                                    shared::slice_index(0, axis, expected, slices, 0));
    }
    EXPECT_EQ(count.size(), 6u);
    for (const auto& [key, n] : count) {
        const float side = 8 * blocks[static_cast<std::size_t>(key.second)].cell;
        EXPECT_EQ(n, static_cast<int>(
                         side / (set_.side_m / static_cast<float>(set_.levels[0].slice_count))));
    }
}

TEST_F(FarInstances, NeighboursShareNoPlaneAndLeaveNoGap) {
    query_.alone = true;
    const auto list =
        select({block_at({8, 8}, 0.5f), block_at({12, 8}, 0.5f), block_at({16, 8}, 0.5f)});
    std::set<float> planes;
    for (const shared::FarInstance& slice : list.slices[0]) {
        if (slice.axis == shared::kAxisX) {
            EXPECT_TRUE(planes.insert(slice.place_m).second) << slice.place_m;
        }
    }
    const float gap = set_.side_m / static_cast<float>(set_.levels[0].slice_count);
    ASSERT_EQ(planes.size(), 48u);
    for (auto it = std::next(planes.begin()); it != planes.end(); ++it) {
        EXPECT_NEAR(*it - *std::prev(it), gap, 1e-4f);
    }
}

TEST_F(FarInstances, ShellsLieAtTheMiddleOfTheirSlabsFromTheTopDown) {
    query_.alone = true;
    const auto list = select({block_at({8, 8}, 0.5f)});
    ASSERT_EQ(list.shells[0].size(), 4u);
    for (int n = 0; n < 4; ++n) {
        const shared::FarInstance& shell = list.shells[0][static_cast<std::size_t>(n)];
        EXPECT_NEAR(shell.place_m, (3.5f - static_cast<float>(n)) / 4 * set_.canopy_m, 1e-6f);
        EXPECT_EQ(shell.image, shared::layer_index(0, 3 - n, 4, shared::kPlaneId));
        EXPECT_EQ(shell.planes, shared::layer_index(1, 0, 4, 0));
    }
}

TEST_F(FarInstances, EveryDistanceHasTheLevelsThatShowBladesThere) {
    const float end = bands_.far[2].w;
    for (float d = 0.5f; d < 1.5f * end; d *= 1.04f) {
        const auto list = select({block_at({query_.eye.x + d, query_.eye.z}, 0.01f)});
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec4 band = bands_.far[k];
            const float there =
                glm::length(glm::vec2(d, query_.eye.y)); // to ground below the eye, about
            if (there > 1.1f * band.x + 0.5f && there < 0.9f * band.w) {
                EXPECT_FALSE(list.shells[k].empty()) << "level " << k << " at " << d;
            }
            if (there < 0.8f * band.x - 1.5f || there > 1.2f * band.w + 1.5f) {
                EXPECT_TRUE(list.shells[k].empty()) << "level " << k << " at " << d;
            }
        }
    }
}

TEST_F(FarInstances, NoneBeforeTheHandOverUnlessAlone) {
    query_.eye.y = query_.lod_eye.y = 0.4f; // the ground at the feet is nearer than the band
    const terrain::VisibleBlock feet = block_at({query_.eye.x - 0.1f, query_.eye.z - 0.1f}, 0.02f);
    for (const auto& shells : select({feet}).shells) {
        EXPECT_TRUE(shells.empty());
    }
    query_.alone = true;
    EXPECT_FALSE(select({feet}).shells[0].empty());
}

TEST_F(FarInstances, AForcedLevelIsTheOnlyOne) {
    query_.forced_level = 1;
    const auto list = select({block_at({2, 2}, 0.5f), block_at({40, 2}, 0.5f)});
    EXPECT_TRUE(list.shells[0].empty() && list.shells[2].empty() && list.slices[0].empty());
    EXPECT_EQ(list.shells[1].size(), 2u * 2u);
}

TEST_F(FarInstances, AFamilySeenEdgeOnIsLeftOutButNeverOneThatShows) {
    query_.alone = true;
    // Due south of the eye, narrow and far: the slices across x show next to nothing there.
    const auto far = select({block_at({query_.eye.x - 0.4f, query_.eye.z + 300}, 0.1f),
                             block_at({query_.eye.x + 0.5f, query_.eye.z + 300}, 0.1f)});
    for (const auto& level : far.slices) {
        for (const shared::FarInstance& slice : level) {
            EXPECT_EQ(slice.axis, shared::kAxisZ);
        }
    }
    // Around the eye every family shows.
    const auto around = select({block_at({query_.eye.x - 2, query_.eye.z - 2}, 0.5f)});
    std::set<int> axes;
    for (const shared::FarInstance& slice : around.slices[0]) {
        axes.insert(slice.axis);
    }
    EXPECT_EQ(axes.size(), 2u);
}

} // namespace
} // namespace sward
