// SPDX-License-Identifier: Apache-2.0
// Arrows, sources and obstacles on the CPU: what wind_force_at() wants, when arrows start, what a
// footprint covers.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "base/error.h"
#include "wind/force_list.h"
#include "wind/solid_list.h"
#include "wind/tile_bins.h"

namespace sward::wind {
namespace {

using shared::vec2;
using shared::WindForce;
using Source = scene::WindSource;

scene::WindArrow arrow(const std::string& id, const std::string& parent, glm::dvec2 root,
                       glm::dvec2 tip, double strength) {
    scene::WindArrow a;
    a.id = id, a.parent = parent, a.root = root, a.tip = tip, a.strength_mps = strength,
    a.radius_m = 2;
    return a;
}

Source source(Source::Kind kind, double strength, double radius) {
    Source s;
    s.kind = kind;
    s.strength_mps = strength;
    s.radius_m = radius;
    return s;
}

ForceList list_of(std::vector<scene::WindArrow> arrows, std::vector<Source> sources,
                  Paths paths = {}) {
    scene::WindSpec spec;
    spec.arrows = std::move(arrows);
    spec.sources = std::move(sources);
    return {spec, std::move(paths), [](double, double) { return 100.0; }};
}

WindForce only_force(const ForceList& list, double time_s = 0) {
    const auto forces = list.at(time_s, {0, 0}, 0.5);
    EXPECT_EQ(forces.size(), 1u);
    return forces.at(0);
}

TEST(ArrowTimes, AChildWaitsForItsParentsGust) {
    // 10 m at 5 m/s, then 6 m at 3 m/s; children stand before their parents in the file.
    auto trunk = arrow("trunk", "", {0, 0}, {10, 0}, 5);
    trunk.start_s = 1;
    const std::vector<scene::WindArrow> arrows = {
        arrow("leaf", "branch", {10, 6}, {12, 8}, 2), arrow("branch", "trunk", {10, 0}, {10, 6}, 3),
        trunk, arrow("other", "trunk", {10, 0}, {10, -9}, 4)};
    const auto spans = arrow_spans(arrows);
    EXPECT_DOUBLE_EQ(spans[2].start_s, 1);
    EXPECT_DOUBLE_EQ(spans[1].start_s, 3);
    EXPECT_DOUBLE_EQ(spans[3].start_s, 3);
    EXPECT_DOUBLE_EQ(spans[0].start_s, 5);
    EXPECT_EQ(spans[0].end_s, scene::kForever);
}

TEST(ArrowTimes, OwnTimesNarrowAndEndsTravelToo) {
    auto trunk = arrow("a", "", {0, 0}, {10, 0}, 5);
    trunk.end_s = 4;
    auto late = arrow("late", "a", {10, 0}, {20, 0}, 5);
    late.start_s = 2.5;
    auto early = arrow("early", "a", {10, 0}, {20, 0}, 5);
    early.start_s = 0.5;
    early.end_s = 3;
    const auto spans = arrow_spans({trunk, late, early});
    EXPECT_DOUBLE_EQ(spans[1].start_s, 2.5);
    EXPECT_DOUBLE_EQ(spans[1].end_s, 6) << "the gust ends two seconds later than at the root";
    EXPECT_DOUBLE_EQ(spans[2].start_s, 2);
    EXPECT_DOUBLE_EQ(spans[2].end_s, 3);
}

TEST(ArrowTimes, AParentWithoutStrengthSendsNothingOn) {
    const auto list =
        list_of({arrow("a", "", {0, 0}, {1, 0}, 0), arrow("b", "a", {1, 0}, {2, 0}, 3)}, {});
    EXPECT_TRUE(list.at(1e6, {0, 0}, 0.5).empty());
}

TEST(ArrowTimes, LongChainsNeedNoStack) {
    std::vector<scene::WindArrow> arrows;
    for (int i = 99999; i >= 0; --i)
        arrows.push_back(
            arrow(std::to_string(i), i ? std::to_string(i - 1) : "", {i, 0}, {i + 1, 0}, 1));
    EXPECT_DOUBLE_EQ(arrow_spans(arrows).front().start_s, 99999);
}

TEST(Forces, AnArrowPushesAtItsTipAlongItself) {
    const ForceList list = list_of({arrow("a", "", {1, 1}, {4, 5}, 10)}, {});
    const WindForce force = only_force(list);
    const auto at_tip = shared::wind_force_at(force, vec2(4, 5));
    EXPECT_NEAR(at_tip.target.x, 6, 1e-5);
    EXPECT_NEAR(at_tip.target.y, 8, 1e-5);
    EXPECT_GT(at_tip.rate, 5);
    EXPECT_EQ(shared::wind_force_at(force, vec2(6.01, 5)).rate, 0) << "past its radius of 2 m";
    EXPECT_EQ(shared::wind_force_at(force, vec2(1, 1)).rate, 0) << "its root";
    EXPECT_EQ(at_tip.outflow, vec2(0));
    EXPECT_TRUE(relaxes(force));
    EXPECT_FALSE(brings_air(force));
}

TEST(Forces, RelaxingNeverPassesTheTarget) {
    for (const float step : {0.001f, 0.02f, 0.1f, 10.f})
        for (const float rate : {0.f, 0.5f, 60.f, 1e6f}) {
            float speed = -30;
            for (int i = 0; i < 2000; ++i) {
                const float next = shared::relaxed(speed, rate * 8, rate, step);
                EXPECT_GE(next, speed);
                EXPECT_LE(next, 8.0001f);
                speed = next;
            }
        }
    EXPECT_NEAR(shared::relaxed(0, 60 * 8 - 60 * 8, 120, 0.1f), 0, 1e-6) << "two that meet head on";
    EXPECT_EQ(shared::relaxed(3, 0, 0, 0.1f), 3);
}

/// Divergence of a force's outflow by central differences.
double divergence(const WindForce& force, glm::dvec2 at) {
    const double h = 0.01;
    const auto flow = [&](double x, double z) {
        return glm::dvec2(shared::wind_force_at(force, vec2(x, z)).outflow);
    };
    return (flow(at.x + h, at.y).x - flow(at.x - h, at.y).x + flow(at.x, at.y + h).y -
            flow(at.x, at.y - h).y) /
           (2 * h);
}

TEST(Forces, ARotorBlowsOutwardsInARing) {
    Source rotor = source(Source::Kind::kRotor, 0, 5);
    rotor.strength_mps.reset();
    rotor.mass_kg = 2200;
    rotor.height_m = 3;
    const WindForce force = only_force(list_of({}, {rotor}));
    // Momentum theory: v = sqrt(m g / (2 rho pi R^2)) = 10.59 m/s, twice that far below.
    EXPECT_NEAR(rotor_outwash(rotor, 0).speed_mps, 21.18, 0.05);
    EXPECT_NEAR(force.speed_mps, 21.1, 0.1);
    const float ring = force.radius_m;
    EXPECT_NEAR(ring, 5.3, 0.1);
    const auto radial = [&](double r) {
        return shared::wind_force_at(force, vec2(r * 0.6, r * 0.8)).outflow;
    };
    EXPECT_NEAR(glm::length(radial(ring)), force.speed_mps, 0.01);
    EXPECT_NEAR(radial(ring).x / radial(ring).y, 0.75, 1e-4);
    EXPECT_LT(glm::length(radial(0.1)), 1) << "calm below the hub";
    EXPECT_LT(glm::length(radial(0.8 * ring)), glm::length(radial(ring)));
    EXPECT_NEAR(glm::length(radial(2.5 * ring)) * 2.5, force.speed_mps * 1.398, 0.05) << "1 / r";
    EXPECT_EQ(glm::length(radial(force.reach_m * 1.01)), 0);
    EXPECT_GT(divergence(force, {1, 0}), 1) << "air comes down inside";
    EXPECT_LT(divergence(force, {0.75 * force.reach_m, 0}), 0) << "and leaves far out";
    EXPECT_FALSE(relaxes(force)) << "it adds to the wind, it does not brake it";
    EXPECT_TRUE(brings_air(force));
}

TEST(Forces, HeightWeakensAndWidensTheOutwash) {
    const Source rotor = source(Source::Kind::kRotor, 20, 5);
    const Outwash low = rotor_outwash(rotor, 1), high = rotor_outwash(rotor, 60),
                  far = rotor_outwash(rotor, 600);
    EXPECT_NEAR(low.speed_mps, 20, 0.1);
    EXPECT_LT(high.speed_mps, 0.75 * low.speed_mps);
    EXPECT_NEAR(far.speed_mps * far.radius_m, low.speed_mps * low.radius_m, 1e-9)
        << "momentum of a plane of air is kept";
    EXPECT_NEAR(far.speed_mps, 20 * 42.43 / 600, 0.02) << "1 / height";
    // On a path above the datum the ground's height, 100 m here, is taken off.
    Paths paths;
    paths["p"].keys = {{0, {0, 103, 0}, 0, 0}};
    paths["p"].agl = false;
    Source carried = rotor;
    carried.where.path = "p";
    EXPECT_NEAR(only_force(list_of({}, {carried}, paths)).speed_mps,
                rotor_outwash(rotor, 3).speed_mps, 1e-4);
}

TEST(Forces, ACycloneTurnsAndDrawsIn) {
    Source cyclone = source(Source::Kind::kCyclone, 30, 8);
    cyclone.inflow = 0.25;
    for (const bool clockwise : {false, true}) {
        cyclone.clockwise = clockwise;
        const WindForce force = only_force(list_of({}, {cyclone}));
        const auto east =
            shared::wind_force_at(force, vec2(8, 0)); // z is south: clockwise blows south here
        EXPECT_NEAR(east.target.y, clockwise ? 30 : -30, 0.01);
        EXPECT_NEAR(east.target.x, -7.5, 0.01);
        EXPECT_NEAR(east.outflow.x, -7.5, 0.01);
        EXPECT_EQ(east.outflow.y, 0);
        EXPECT_GT(east.rate, 0.5);
        EXPECT_LT(divergence(force, {1, 1}), -0.5) << "an updraft in the core";
        EXPECT_NEAR(glm::length(shared::wind_force_at(force, vec2(0.8, 0)).target),
                    30 * 0.1756 * 1.03, 0.2)
            << "the core turns like a solid";
    }
}

TEST(Forces, AWaveTravels) {
    Source wave = source(Source::Kind::kWave, 4, 100);
    wave.where.yaw_deg = 90; // east
    wave.wavelength_m = 15;
    wave.travel_mps = 6;
    const ForceList list = list_of({}, {wave});
    const auto flow = [&](double t, double x) {
        return shared::wind_force_at(only_force(list, t), vec2(x, 3)).outflow;
    };
    double most = 0;
    for (double x = 0; x < 15; x += 0.5) {
        EXPECT_NEAR(flow(0, x).x, flow(1.5, x + 9).x, 2e-3);
        EXPECT_NEAR(flow(0, x).x, flow(0, x + 15).x, 1e-3) << "its wavelength";
        EXPECT_NEAR(flow(0, x).y, 0, 1e-5);
        most = std::max(most, std::abs(static_cast<double>(flow(0, x).x)));
    }
    EXPECT_GT(most, 2.5);
    EXPECT_LE(most, 4);
    const ForceList late = list_of({}, {wave});
    EXPECT_NEAR(flow(0, 1).x,
                shared::wind_force_at(only_force(late, 1e6 * 2.5), vec2(1, 3)).outflow.x, 1e-2)
        << "a million periods later no phase is lost";
}

TEST(Forces, AWakeFollowsItsVehicle) {
    Paths paths;
    paths["road"].keys = {{0, {0, 0, 0}, 90, 0}, {10, {200, 0, 0}, 90, 0}};
    Source wake;
    wake.kind = Source::Kind::kWake;
    wake.where.path = "road";
    wake.radius_m = 1;
    wake.length_m = 20;
    const ForceList list = list_of({}, {wake}, paths);
    const WindForce force = only_force(list, 5); // at x = 100, 20 m/s
    const auto at = [&](double x, double z) { return shared::wind_force_at(force, vec2(x, z)); };
    EXPECT_NEAR(at(99.5, 0).target.x, 20 * std::pow(1.125, -2.0 / 3), 0.01);
    EXPECT_LT(at(92, 0).target.x, 0.6 * 20);
    EXPECT_GT(at(92, 0).rate, at(92, 2).rate);
    EXPECT_EQ(at(102, 0).rate, 0) << "ahead of it";
    EXPECT_EQ(at(79, 0).rate, 0) << "past its length";
    EXPECT_TRUE(list.at(20, {0, 0}, 0.5).empty()) << "it has stopped";
}

TEST(Forces, AJetIsAStripAlongItsYaw) {
    Source jet = source(Source::Kind::kJet, 20, 1);
    jet.where.place = {5, 5};
    jet.where.yaw_deg = 180; // south
    jet.length_m = 6;
    const WindForce force = only_force(list_of({}, {jet}));
    EXPECT_NEAR(shared::wind_force_at(force, vec2(5, 8)).target.y, 20, 1e-4);
    EXPECT_GT(shared::wind_force_at(force, vec2(5, 10)).rate, 0);
    EXPECT_EQ(shared::wind_force_at(force, vec2(5, 12.1)).rate, 0);
    EXPECT_EQ(shared::wind_force_at(force, vec2(6.1, 8)).rate, 0);
}

TEST(Forces, SourcesKeepTheirTimes) {
    Source fan = source(Source::Kind::kFan, 5, 2);
    fan.start_s = 1;
    fan.end_s = 2;
    const ForceList list = list_of({}, {fan});
    EXPECT_TRUE(list.at(0.99, {0, 0}, 0.5).empty());
    EXPECT_EQ(list.at(1, {0, 0}, 0.5).size(), 1u);
    EXPECT_TRUE(list.at(2, {0, 0}, 0.5).empty());
}

TEST(Forces, NothingActsOutsideItsBounds) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> anywhere(-60, 60);
    Paths paths;
    paths["road"].keys = {{0, {0, 0, 0}, 0, 0}, {10, {100, 0, 60}, 0, 0}};
    std::vector<Source> sources;
    for (const auto kind : {Source::Kind::kRotor, Source::Kind::kJet, Source::Kind::kWake,
                            Source::Kind::kCyclone, Source::Kind::kWave, Source::Kind::kFan}) {
        sources.push_back(source(kind, 9, 3));
        sources.back().where.yaw_deg = 33;
        sources.back().length_m = 12;
        sources.back().height_m = 4;
    }
    sources[2].where.path = "road";
    for (const WindForce& force :
         list_of({arrow("a", "", {0, 0}, {7, 3}, 4)}, sources, paths).at(1, {0, 0}, 0.5)) {
        const glm::vec4 bounds = force_bounds(force);
        int outside = 0, acting = 0;
        for (int i = 0; i < 20000; ++i) {
            const vec2 at(anywhere(random), anywhere(random));
            const auto push = shared::wind_force_at(force, at);
            const bool acts = push.rate > 0 || push.outflow != vec2(0);
            const bool in =
                at.x >= bounds.x && at.y >= bounds.y && at.x <= bounds.z && at.y <= bounds.w;
            outside += acts && !in ? 1 : 0;
            acting += acts ? 1 : 0;
        }
        EXPECT_EQ(outside, 0) << force.kind;
        EXPECT_GT(acting, 20) << force.kind;
    }
}

TEST(Tiles, HoldWhatTouchesThem) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> place(-20, 80), size(0, 15);
    std::vector<glm::vec4> bounds;
    for (int i = 0; i < 60; ++i) {
        const glm::vec2 corner(place(random), place(random));
        bounds.emplace_back(corner, corner + glm::vec2(size(random), size(random)));
    }
    bounds.emplace_back(-1e9f, -1e9f, 1e9f, 1e9f);
    const int cells = 120;
    const TileBins bins = bin_tiles(bounds, cells, 0.5);
    EXPECT_EQ(bins.tiles.size(), 64u) << "the last one covers everything";
    std::size_t entries = 0;
    for (const glm::ivec4& tile : bins.tiles) {
        std::vector<bool> has(bounds.size(), false);
        for (int i = tile.z; i < tile.z + tile.w; ++i) {
            const std::uint32_t item = bins.items[static_cast<std::size_t>(i)];
            has[item] = true;
            EXPECT_TRUE(i == tile.z || item > bins.items[static_cast<std::size_t>(i) - 1])
                << "in one order";
        }
        entries += static_cast<std::size_t>(tile.w);
        const glm::vec2 least = glm::vec2(tile) * 8.0f, most = least + 8.0f;
        for (std::size_t i = 0; i < bounds.size(); ++i) {
            const bool meets = bounds[i].x <= most.x && bounds[i].z >= least.x &&
                               bounds[i].y <= most.y && bounds[i].w >= least.y;
            EXPECT_TRUE(has[i] || !meets) << tile.x << " " << tile.y << " " << i;
        }
    }
    EXPECT_EQ(entries, bins.items.size());
    EXPECT_LT(entries, 64u * 12) << "not everything in every tile";
    EXPECT_TRUE(bin_tiles(std::vector<glm::vec4>{{90, 0, 95, 5}, {0, -9, 5, -2}}, cells, 0.5)
                    .tiles.empty());
}

void add_box(scene::Mesh& mesh, glm::vec3 least, glm::vec3 most) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? most.x : least.x, i & 2 ? most.y : least.y,
                                    i & 4 ? most.z : least.z);
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : quads) {
        const auto corner = [&](int i) { return first + static_cast<std::uint32_t>(q[i]); };
        mesh.triangles.push_back({corner(0), corner(1), corner(2)});
        mesh.triangles.push_back({corner(0), corner(2), corner(3)});
    }
}

bool print_covers(const Footprint& print, glm::dvec2 at) {
    const int x = static_cast<int>(std::floor((at.x - print.corner_m.x) / print.bit_m));
    const int z = static_cast<int>(std::floor((at.y - print.corner_m.y) / print.bit_m));
    return x >= 0 && z >= 0 && x < print.width && z < print.height && print.at(x, z);
}

TEST(Footprints, FillWhatAHeightCuts) {
    scene::Mesh mesh;
    add_box(mesh, {-4, 0, -2}, {4, 3, 2}); // a house
    add_box(mesh, {2, 0, -6}, {7, 2, 1});  // a wing that reaches into it, lower
    const Footprint low = footprint_of(mesh, 1, 0.5), high = footprint_of(mesh, 2.5, 0.5);
    EXPECT_TRUE(print_covers(low, {0, 0}));
    EXPECT_TRUE(print_covers(low, {3, 0})) << "where both are";
    EXPECT_TRUE(print_covers(low, {6, -5}));
    EXPECT_FALSE(print_covers(low, {0, -5}));
    EXPECT_FALSE(print_covers(low, {5, 2}));
    EXPECT_TRUE(print_covers(high, {0, 0}));
    EXPECT_FALSE(print_covers(high, {6, -5})) << "above the wing";
    EXPECT_TRUE(footprint_of(mesh, 4, 0.5).words.empty());
    // Area: within half a cell of the outline is covered too.
    double area = 0;
    for (int row = 0; row < high.height; ++row)
        for (int column = 0; column < high.width; ++column)
            area += high.at(column, row) ? high.bit_m * high.bit_m : 0;
    EXPECT_NEAR(area, 8.5 * 4.5 - (1 - std::numbers::pi / 4) * 0.25, 0.7);
}

TEST(Footprints, KeepYardsAndThinWalls) {
    scene::Mesh yard;
    add_box(yard, {-10, 0, -10}, {10, 2, -9});
    add_box(yard, {-10, 0, 9}, {10, 2, 10});
    add_box(yard, {-10, 0, -10}, {-9, 2, 10});
    add_box(yard, {9, 0, -10}, {10, 2, 10});
    const Footprint print = footprint_of(yard, 1, 0.5);
    EXPECT_FALSE(print_covers(print, {0, 0}));
    EXPECT_TRUE(print_covers(print, {9.5, 9.5})) << "two walls overlap in the corner";
    scene::Mesh sheet; // one quad on edge: an open contour
    sheet.positions = {{-5, 0, -3}, {5, 0, 3}, {5, 2, 3}, {-5, 2, -3}};
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Footprint line = footprint_of(sheet, 1, 0.5);
    EXPECT_TRUE(print_covers(line, {0, 0}));
    EXPECT_TRUE(print_covers(line, {2.5, 1.5}));
    EXPECT_FALSE(print_covers(line, {3, 0}));
    EXPECT_FALSE(print_covers(line, {-3, 0}));
}

TEST(Footprints, LargeMeshesKeepABound) {
    scene::Mesh mesh;
    add_box(mesh, {-9e5f, 0, -9e5f}, {9e5f, 3, 9e5f});
    const Footprint print = footprint_of(mesh, 1, 0.05);
    EXPECT_LE(print.width, 4096);
    EXPECT_LE(print.height, 4096);
    EXPECT_TRUE(print_covers(print, {0, 0}));
}

class Solids : public testing::Test {
protected:
    void add(scene::WindObstacle::Kind kind, glm::dvec2 place, glm::dvec2 size, double yaw = 0) {
        scene::WindObstacle obstacle;
        obstacle.kind = kind;
        obstacle.where.place = place;
        obstacle.where.yaw_deg = yaw;
        obstacle.size = size;
        scene_.wind.obstacles.push_back(obstacle);
    }
    scene::Scene scene_;
    Meshes meshes_;
};

TEST_F(Solids, BoxesTurnAndCirclesAreRound) {
    add(scene::WindObstacle::Kind::kBox, {10, 20}, {8, 2}, 90); // its width now runs north-south
    add(scene::WindObstacle::Kind::kCircle, {0, 0}, {3, 3});
    const SolidList list(scene_, meshes_);
    const auto solids = list.at(0, {-100, -100});
    EXPECT_TRUE(covers(solids[0], {110, 123.9}, list.words()));
    EXPECT_FALSE(covers(solids[0], {112, 120}, list.words()));
    EXPECT_TRUE(covers(solids[1], {102.1, 102.1}, list.words()));
    EXPECT_FALSE(covers(solids[1], {102.2, 102.2}, list.words()));
    const glm::vec4 bounds = solid_bounds(solids[0]);
    EXPECT_NEAR(bounds.x, 109, 1e-4);
    EXPECT_NEAR(bounds.w, 124, 1e-4);
}

TEST_F(Solids, MoveAndTurnWithTheirPath) {
    scene_.paths["p"].keys = {{0, {0, 0, 0}, 0, 0}, {9, {90, 0, 0}, 90, 0}};
    add(scene::WindObstacle::Kind::kBox, {0, -5}, {4, 2}); // 5 m ahead of the path's point
    scene_.wind.obstacles[0].where.path = "p";
    const SolidList list(scene_, meshes_);
    const auto start = list.at(0.1, {0, 0}), later = list.at(4.5, {0, 0});
    EXPECT_NEAR(start[0].place.y, -5, 0.01);
    // Yaw 45 at 45 m: ahead is north-east. 10 degrees a second turn it.
    EXPECT_NEAR(later[0].place.x, 45 + 5 * std::sqrt(0.5), 0.01);
    EXPECT_NEAR(later[0].place.y, -5 * std::sqrt(0.5), 0.01);
    EXPECT_NEAR(later[0].turn_rad_s, 10 * std::numbers::pi / 180, 1e-3);
    EXPECT_NEAR(later[0].velocity.x, 10 + 5 * std::sqrt(0.5) * 10 * std::numbers::pi / 180, 0.01);
    // Every point moves as the body does: place a second later by the velocity field.
    const double dt = 1e-3;
    const auto next = list.at(4.5 + dt, {0, 0});
    const vec2 own(1.5f, -0.5f);
    const auto world = [&](const shared::WindSolid& s) {
        return vec2(s.place.x + s.heading.x * own.x - s.heading.y * own.y,
                    s.place.y + s.heading.y * own.x + s.heading.x * own.y);
    };
    EXPECT_NEAR(glm::distance(shared::solid_frame(later[0], world(later[0])), own), 0, 1e-5);
    const vec2 moved = (world(next[0]) - world(later[0])) / static_cast<float>(dt);
    const vec2 told = shared::solid_velocity(later[0], world(later[0]));
    EXPECT_NEAR(moved.x, told.x, 0.05);
    EXPECT_NEAR(moved.y, told.y, 0.05);
}

TEST_F(Solids, ThinWallsAreACellThick) {
    scene_.wind.cell_m = 0.5;
    add(scene::WindObstacle::Kind::kBox, {0, 0}, {10, 0.02}, 30);
    add(scene::WindObstacle::Kind::kCircle, {20, 20}, {0.05, 0.05});
    const SolidList list(scene_, meshes_);
    const auto solids = list.at(0, {-0.13, -0.21});
    const auto hits = [&](std::size_t i) {
        int count = 0;
        for (int z = -40; z < 80; ++z)
            for (int x = -40; x < 80; ++x)
                count +=
                    covers(solids[i], (glm::vec2(glm::ivec2(x, z)) + 0.5f) * 0.5f, list.words())
                        ? 1
                        : 0;
        return count;
    };
    EXPECT_GE(hits(0), 17);
    EXPECT_GE(hits(1), 1);
}

TEST_F(Solids, MeshesNeedAHeightThatMeetsThem) {
    scene_.file = "scene.toml";
    add(scene::WindObstacle::Kind::kMesh, {50, 0}, {1, 1}, 90);
    scene_.wind.obstacles[0].mesh = "barn.glb";
    const auto message = [&] {
        try {
            const SolidList list(scene_, meshes_);
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ExitCode::kBadInput);
            return std::string(error.what());
        }
        return std::string("none");
    };
    EXPECT_EQ(message(), "scene.toml: wind.obstacle[0].mesh: found barn.glb, expected a mesh that "
                         "the host has loaded");
    add_box(meshes_["barn.glb"], {-4, 0, -1}, {4, 3, 1});
    scene_.wind.obstacles[0].height_m = 3.5;
    EXPECT_EQ(
        message(),
        "scene.toml: wind.obstacle[0].height_m: found 3.5, expected a height that meets the mesh, "
        "between 0 and 3 m");
    scene_.wind.obstacles[0].height_m = 1;
    const SolidList list(scene_, meshes_);
    const auto solids = list.at(0, {0, 0});
    EXPECT_TRUE(covers(solids[0], {50, 3.9}, list.words())) << "turned by 90 degrees";
    EXPECT_FALSE(covers(solids[0], {53, 0}, list.words()));
    const glm::vec4 bounds = solid_bounds(solids[0]);
    EXPECT_LT(bounds.x, 49);
    EXPECT_GT(bounds.w, 4);
}

} // namespace
} // namespace sward::wind
