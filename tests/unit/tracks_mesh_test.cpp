// SPDX-License-Identifier: Apache-2.0
// Meshes that press the grass: their undersides, strips, what hovers, stands, is tipped or absurd
// (methods.md C4).
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "shared/track_map.h"
#include "tracks/print_list.h"
#include "tracks/track_twin.h"
#include "tracks/tracks.h"

namespace sward::tests {
namespace {

using glm::dvec3;
using glm::vec3;
using tracks::TrackTwin;

constexpr double kCanopy_m = 0.3, kStep_s = 1.0 / 60;
constexpr int kSide = shared::kTrackCells;

/// A closed box from `low` to `high`, appended.
void add_box(scene::Mesh& mesh, vec3 low, vec3 high) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t n = 0; n < 8; ++n) {
        mesh.positions.emplace_back((n & 1) ? high.x : low.x, (n & 2) ? high.y : low.y,
                                    (n & 4) ? high.z : low.z);
    }
    constexpr std::uint32_t kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                            {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (const auto& face : kFaces) {
        mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
        mesh.triangles.push_back({first + face[0], first + face[2], first + face[3]});
    }
}

scene::Mesh ball(float radius) {
    constexpr std::uint32_t kRound = 48, kDown = 24;
    scene::Mesh mesh;
    for (std::uint32_t down = 0; down <= kDown; ++down) {
        for (std::uint32_t round = 0; round < kRound; ++round) {
            const float a = shared::kPi * static_cast<float>(down) / kDown,
                        b = 2 * shared::kPi * static_cast<float>(round) / kRound;
            mesh.positions.push_back(
                radius * vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)));
            const std::uint32_t own = down * kRound + round,
                                next = down * kRound + (round + 1) % kRound;
            if (down < kDown) {
                mesh.triangles.push_back({own, next, own + kRound});
                mesh.triangles.push_back({next, next + kRound, own + kRound});
            }
        }
    }
    return mesh;
}

/// A frame at a place, turned as yaw is (0 north, positive to the east).
glm::dmat4 frame_at(dvec3 place, double yaw_deg = 0) {
    const double yaw = yaw_deg * 3.14159265358979323846 / 180;
    return {{std::cos(yaw), 0, std::sin(yaw), 0},
            {0, 1, 0, 0},
            {-std::sin(yaw), 0, std::cos(yaw), 0},
            {place, 1}};
}

struct Yard {
    explicit Yard(
        const scene::Mesh& mesh, tracks::Ground ground = [](double, double) { return 0.0; })
        : list(spec, {}, kCanopy_m, std::move(ground)), rules(tracks::rules_of(spec, kCanopy_m)) {
        const scene::Mesh* const one = &mesh;
        list.set_meshes({&one, 1});
        field.maps = list.maps();
    }
    void step(const glm::dmat4& now, const glm::dmat4& before, glm::vec2 slope = {0, 0}) {
        const tracks::Body body{0, now, before};
        std::vector<shared::TrackPrint> prints;
        for (const tracks::Print& print : list.at(1, kStep_s, {{}, {&body, 1}})) {
            prints.push_back(print.from({0, 0}));
        }
        field.step(rules, prints, slope);
    }
    [[nodiscard]] float pressed(int x, int z) const {
        return glm::length(field.pressed[static_cast<std::size_t>(z * kSide + x)]);
    }
    /// Cells that lie in a row from `x0` on.
    [[nodiscard]] int lying_in_column(int x) const {
        int count = 0;
        for (int z = 0; z < kSide; ++z) {
            count += pressed(x, z) > 0.3f ? 1 : 0;
        }
        return count;
    }

    scene::TrackSpec spec;
    tracks::PrintList list;
    shared::TrackRules rules;
    TrackTwin field;
};

/// Least and most cells across the strip that a mesh leaves on its way east, at any yaw of its own.
glm::ivec2 strip(const scene::Mesh& mesh, double speed, double yaw_deg) {
    Yard yard(mesh);
    for (double x = 9; x < 21; x += speed * kStep_s) {
        yard.step(frame_at({x + speed * kStep_s, 0, 16.1}, yaw_deg),
                  frame_at({x, 0, 16.1}, yaw_deg));
    }
    glm::ivec2 found(kSide, 0);
    for (int x = 46; x < 74; ++x) {
        found = {std::min(found.x, yard.lying_in_column(x)),
                 std::max(found.y, yard.lying_in_column(x))};
    }
    return found;
}

TEST(TracksMesh, AnySpeedLeavesTheSameStripAndRailsLeaveNoGaps) {
    scene::Mesh box, rail;
    add_box(box, {-0.75f, 0.02f, -0.5f}, {0.75f, 0.8f, 0.5f});
    add_box(rail, {-0.02f, 0, -0.3f}, {0.02f, 0.1f, 0.3f}); // much narrower than a cell of 0.25 m
    for (const double yaw : {90.0, 40.0}) {
        for (const scene::Mesh* mesh : {&box, &rail}) {
            const glm::ivec2 slow = strip(*mesh, 14, yaw);
            EXPECT_GE(slow.x, 1) << yaw;
            EXPECT_LE(slow.y - slow.x, 1) << yaw;
            const glm::ivec2 fast = strip(*mesh, 50, yaw);
            EXPECT_GE(fast.x, 1) << yaw;
            EXPECT_LE(std::abs(fast.x - slow.x), 1) << yaw;
            EXPECT_LE(std::abs(fast.y - slow.y), 1) << yaw;
            if (mesh == &box && yaw == 90) {
                EXPECT_NEAR(slow.x, 6, 1); // 1.5 m
            } else if (mesh == &rail) {
                EXPECT_LE(slow.y, yaw == 90 ? 2 : 4);
            }
        }
    }
}

TEST(TracksMesh, ABallOfTrianglesPressesAsABallDoes) {
    Yard yard(ball(0.8f));
    shared::TrackPrint print{}, mesh{};
    print.now = print.before = mesh.now = mesh.before = {{16, 16}, {1, 0}};
    print.half_width_m = print.half_depth_m = 0.8f;
    print.underside_m = 0.05f;
    print.kind = shared::kPrintSphere;
    mesh.underside_m = 0.85f;
    mesh.kind = shared::kPrintMesh;
    mesh.map = 0;
    int met = 0;
    for (float x = 15; x < 17; x += 0.07f) {
        for (float z = 15; z < 17; z += 0.07f) {
            const auto a = shared::track_contact(yard.rules, print, {x, z});
            const auto b =
                shared::track_map_contact(yard.field.maps.data(), yard.rules, mesh, {x, z});
            if (a.touched == 1 && b.touched == 1) {
                ++met;
                EXPECT_NEAR(a.clearance, b.clearance, 0.04f) << x << " " << z;
                EXPECT_GT(glm::dot(a.way, b.way),
                          glm::distance(glm::vec2(x, z), {16, 16}) > 0.2f ? 0.85f : -1.0f)
                    << x << " " << z;
            } else if (a.touched != b.touched) {
                EXPECT_GT(std::max(a.clearance, b.clearance), kCanopy_m - 0.08) << x << " " << z;
            }
        }
    }
    EXPECT_GT(met, 200);
}

TEST(TracksMesh, SkidsThatHoverBrushTipsAndBetweenThemGrassStands) {
    scene::Mesh skids;
    add_box(skids, {-1.2f, 0, -1.5f}, {-1.0f, 0.1f, 1.5f});
    add_box(skids, {1.0f, 0, -1.5f}, {1.2f, 0.1f, 1.5f});
    add_box(skids, {-1, 1.0f, -2}, {1, 2.4f, 2}); // the cabin
    Yard low(skids), high(skids), over(skids);
    for (int n = 0; n < 30; ++n) {
        low.step(frame_at({16, 0, 16}), frame_at({16, 0, 16}));
        high.step(frame_at({16, 0.26, 16}), frame_at({16, 0.26, 16}));
        over.step(frame_at({16, 0.31, 16}), frame_at({16, 0.31, 16}));
    }
    EXPECT_GT(low.pressed(68, 64), 0.5f); // x = 17.1
    EXPECT_GT(low.pressed(59, 64), 0.5f);
    EXPECT_EQ(low.pressed(64, 64), 0.0f);
    EXPECT_EQ(high.pressed(68, 64), 0.0f);
    EXPECT_GT(glm::length(high.field.at(68, 64).theta), 0.1f);
    EXPECT_LT(glm::length(high.field.at(68, 64).theta), 0.8f);
    for (const shared::TrackCell& cell : over.field.cells) {
        ASSERT_EQ(cell.theta, glm::vec2(0));
    }
    for (int n = 0; n < 90; ++n) { // what stays holds its grass down
        low.step(frame_at({16, 0, 16}), frame_at({16, 0, 16}));
    }
    EXPECT_GT(glm::length(low.field.at(68, 64).theta), 0.9f);
}

TEST(TracksMesh, GrassLeansOutOverTheNearestRimOfWhatStands) {
    scene::Mesh corner; // an L, whose middle is no part of it
    add_box(corner, {-2, 0, -2}, {-1, 0.5f, 2});
    add_box(corner, {-2, 0, 1}, {2, 0.5f, 2});
    Yard yard(corner);
    yard.step(frame_at({16, 0, 16}), frame_at({16, 0, 16}));
    const auto theta = [&](double x, double z) {
        return yard.field.at(static_cast<int>(x / 0.25), static_cast<int>(z / 0.25)).theta;
    };
    EXPECT_GT(theta(14.9, 15).x, 0.9f);  // the inner side of the upright stroke
    EXPECT_LT(theta(14.1, 15).x, -0.9f); // its outer side
    EXPECT_LT(theta(17, 17.1).y, -0.9f); // the inner side of the foot
    EXPECT_GT(theta(17, 17.9).y, 0.9f);
    EXPECT_EQ(theta(17, 15), glm::vec2(0));
}

TEST(TracksMesh, TheGroundUnderAMeshCounts) {
    scene::Mesh plank;
    add_box(plank, {-0.3f, 0, -2}, {0.3f, 0.1f, 2});
    // The ground falls to the south by one in five: a level plank that lies on its middle hovers
    // 0.4 m over its south end, which is more than the canopy.
    Yard level(plank, [](double, double z) { return 0.2 * (16 - z); });
    level.step(frame_at({16, 0, 16}), frame_at({16, 0, 16}));
    EXPECT_GT(level.pressed(64, 58), 0.5f); // at z = 14.6: in the ground
    EXPECT_LT(level.pressed(64, 69), 0.1f); // at z = 17.4: 0.28 m over it
    glm::dmat4 laid = frame_at({16, 0, 16});
    laid[2] = {0, -0.2, 1, 0}; // along the slope
    Yard along(plank, [](double, double z) { return 0.2 * (16 - z); });
    along.step(laid, laid);
    EXPECT_GT(along.pressed(64, 58), 0.5f);
    EXPECT_GT(along.pressed(64, 69), 0.5f);
}

TEST(TracksMesh, AbsurdMeshesAndWaysHarmNothing) {
    scene::Mesh flat; // no area at all
    flat.positions = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    scene::Mesh huge;
    add_box(huge, {-5000, 0, -5000}, {5000, 10, 5000});
    const double nan = std::nan("");
    for (const scene::Mesh* mesh : {&flat, &huge}) {
        Yard yard(*mesh);
        EXPECT_LE(yard.field.maps.size(),
                  static_cast<std::size_t>(shared::kMostMapSide) * shared::kMostMapSide + 2);
        for (const dvec3 place :
             {dvec3(16, 0, 16), dvec3(nan, 0, 0), dvec3(1e30, 0, 1e30), dvec3(16, -900, 16)}) {
            yard.step(frame_at(place), frame_at(place));
            yard.step(frame_at(place), frame_at({1e6, 0, 16}));
        }
        glm::dmat4 none(0);
        yard.step(none, none);
        for (const shared::TrackCell& cell : yard.field.cells) {
            ASSERT_TRUE(std::isfinite(cell.theta.x) && std::isfinite(cell.omega.y));
            ASSERT_LE(glm::length(cell.theta), 1.001f);
        }
    }
    Yard small(flat);
    small.step(frame_at({16.1, 0, 16.1}), frame_at({16.1, 0, 16.1}));
    EXPECT_GT(small.pressed(64, 64), 0.3f); // a point counts as a cell
}

} // namespace
} // namespace sward::tests
