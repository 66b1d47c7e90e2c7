// SPDX-License-Identifier: Apache-2.0
// Tracks on the GPU against their C++ twin, over pages' rims, at any rate of pictures, out of the
// pool and back.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "gl/fixture.h"
#include "shared/track_seen.h"
#include "tracks/track_twin.h"
#include "tracks/tracks.h"

namespace sward::tests {
namespace {

using Tracks = GlTest;
using tracks::TrackTwin;

constexpr int kSide = shared::kTrackCells;

/// A wheel along a path east over level ground.
scene::Scene drive(double speed_mps, double from_x, double to_x, double z = 16) {
    scene::Scene scene;
    scene.paths["drive"].keys = {{0, {from_x, 0, z}, 90, 0},
                                 {std::abs(to_x - from_x) / speed_mps, {to_x, 0, z}, 90, 0}};
    scene::TrackSpec& spec = scene.tracks.emplace();
    spec.feet = {{scene::TrackFoot::Kind::kWheel, "drive", {0.8, 0}, {0.3, 0.35}, 0, 1},
                 {scene::TrackFoot::Kind::kBox, "drive", {-0.8, 0.2}, {0.4, 0.5}, 0.02, 1}};
    return scene;
}

struct Field {
    explicit Field(const scene::Scene& scene)
        : tracks(scene, 0.3, {[](double, double) { return 0.0; }, {}}) {}
    void advance(double time_s, glm::dvec3 eye = {0, 2, 0}) { tracks.advance(time_s, {&eye, 1}); }
    tracks::Tracks tracks;
};

TEST_F(Tracks, StepsEqualTheTwin) {
    const scene::Scene scene = drive(10, 4, 28);
    const shared::TrackRules rules = tracks::rules_of(*scene.tracks, 0.3);
    const tracks::PrintList list(*scene.tracks, scene.paths, 0.3,
                                 [](double, double) { return 0.0; });
    constexpr int kRow = shared::kTrackRow;
    tracks::TrackPass pass(1, shared::kTrackBlocks, 64);
    pass.reserve(1, shared::kTrackBlocks);
    TrackTwin twin;
    for (int n = 1; n <= 160; ++n) {
        tracks::TrackPass::Work work;
        for (const tracks::Print& print : list.at(n / 60.0, 1 / 60.0, {})) {
            work.prints.push_back(print.from({0, 0}));
        }
        for (int block = 0; block < shared::kTrackBlocks; ++block) {
            const int x = block % kRow, z = block / kRow;
            shared::TrackBlock entry{};
            entry.prints = static_cast<int>(work.prints.size());
            entry.first_cell = glm::ivec2(x, z) * shared::kTrackBlock;
            entry.own = block;
            entry.beside = {x > 0 ? block - 1 : -1, x < kRow - 1 ? block + 1 : -1,
                            z > 0 ? block - kRow : -1, z < kRow - 1 ? block + kRow : -1};
            entry.slope = {0.2f, -0.1f};
            work.moving.push_back(entry);
        }
        pass.step(rules, work);
        twin.step(rules, work.prints, {0.2f, -0.1f});
    }
    const std::vector<std::uint32_t> words = pass.get(0);
    tracks::PageContent content;
    for (int block = 0; block < shared::kTrackBlocks; ++block) {
        pass.get_block(block, content);
    }
    double most_theta = 0, most_omega = 0, most_pressed = 0, reached = 0;
    for (std::size_t n = 0; n < TrackTwin::kCount; ++n) {
        const shared::TrackCell& cell = twin.cells[n];
        const glm::ivec2 at(static_cast<int>(n) % shared::kTrackCells,
                            static_cast<int>(n) / shared::kTrackCells);
        const glm::vec4 bend = content.bends[static_cast<std::size_t>(
            shared::track_block_of(at) * shared::kTrackBlock * shared::kTrackBlock +
            shared::track_in_block(at))];
        most_theta = std::max<double>(most_theta, glm::length(glm::vec2(bend) - cell.theta));
        most_omega =
            std::max<double>(most_omega, glm::length(glm::vec2(bend.z, bend.w) - cell.omega) /
                                             (1 + glm::length(cell.omega)));
        most_pressed = std::max<double>(
            most_pressed, glm::length(shared::track_unpack(words[n]) - twin.pressed[n]));
        reached = std::max<double>(reached, glm::length(cell.theta));
    }
    EXPECT_LT(most_theta, 1e-4);
    EXPECT_LT(most_omega, 1e-4);
    EXPECT_LT(most_pressed, 1e-4);
    EXPECT_GT(reached, 0.05);
}

/// Bits of everything that lies or bends, by page.
std::vector<float> bits(const tracks::Tracks& tracks, double from_x, double to_x) {
    std::vector<float> out;
    for (double x = from_x; x < to_x; x += 3.1) {
        for (double z = 14; z < 18; z += 0.25) {
            const auto sample = tracks.at(x, z);
            out.insert(out.end(),
                       {sample.theta.x, sample.theta.y, sample.pressed.x, sample.pressed.y});
        }
    }
    return out;
}

TEST_F(Tracks, AnyRateOfPicturesGivesTheSameBits) {
    const scene::Scene scene = drive(20, -12, 12);
    std::vector<std::vector<float>> found;
    for (const double rate : {30.0, 60.0, 144.0}) {
        Field field(scene);
        for (int n = 0; n <= static_cast<int>(1.25 * rate); ++n) {
            field.advance(n / rate);
        }
        field.advance(1.25);
        found.push_back(bits(field.tracks, -12, 12));
    }
    EXPECT_EQ(found[0], found[1]);
    EXPECT_EQ(found[1], found[2]);
    EXPECT_GT(*std::max_element(found[0].begin(), found[0].end()), 0.5f);
}

TEST_F(Tracks, PagesJoinWithoutASeam) {
    // The same print in the middle of a page and on the corner of four: the waves around it are the
    // same.
    std::vector<tracks::Tracks::Sample> found[2];
    for (int n = 0; n < 2; ++n) {
        const double middle = n == 0 ? 16 : 32;
        scene::Scene scene;
        scene.tracks.emplace();
        tracks::Tracks field(
            scene, 0.3,
            {[](double, double) { return 0.0; },
             [=](double time_s, double) {
                 return time_s > 0.4 ? std::vector<tracks::Ball>{}
                                     : std::vector<tracks::Ball>{
                                           {{middle, 0.5, middle}, {middle, 0.5, middle}, 0.5}};
             }});
        const glm::dvec3 eye(16, 2, 16);
        for (int step = 1; step <= 32; ++step) {
            field.advance(step / 60.0, {&eye, 1});
        }
        for (double x = -2; x < 2; x += 0.25) {
            found[n].push_back(field.at(middle + x + 0.1, middle + 0.1));
            found[n].push_back(field.at(middle + 0.1, middle + x + 0.1));
        }
    }
    float most = 0;
    for (std::size_t n = 0; n < found[0].size(); ++n) {
        EXPECT_NEAR(found[0][n].theta.x, found[1][n].theta.x, 1e-5f);
        EXPECT_NEAR(found[0][n].theta.y, found[1][n].theta.y, 1e-5f);
        most = std::max(most, std::abs(found[0][n].theta.x));
    }
    EXPECT_GT(most, 0.1f);
}

TEST_F(Tracks, WhatIsDroppedComesBackToTheBit) {
    scene::Scene scene = drive(20, 0, 28);
    scene.tracks->pages = 3;
    scene.tracks->lasting_s = 40;
    scene.tracks->damping = 0.05;
    scene.tracks->recovery_per_s2 = 60; // rises in a second or two: less to step
    scene.paths["drive"].keys.push_back({4, {28, 5, 16}, 90, 0});
    Field stays(scene);
    // Another path far away takes the pool.
    scene::Scene busy = scene;
    busy.paths["away"].keys = {{0, {5000, 50, 16}, 90, 0},
                               {20, {5000, 50, 16}, 90, 0},
                               {21, {5000, 0, 16}, 90, 0},
                               {23, {5200, 0, 16}, 90, 0},
                               {24, {5200, 50, 16}, 90, 0}};
    busy.tracks->feet.push_back({scene::TrackFoot::Kind::kBox, "away", {0, 0}, {1, 1}, 0, 1});
    Field goes(busy);
    for (int n = 0; n <= 50; ++n) {
        stays.advance(n);
        goes.advance(n, n < 20 || n > 40 ? glm::dvec3(0, 2, 0) : glm::dvec3(5100, 2, 16));
        if (n == 30) {
            EXPECT_EQ(goes.tracks.pages().slot_of({0, 0}), -1);
            EXPECT_TRUE(goes.tracks.memory().has({0, 0}));
        }
    }
    EXPECT_GE(goes.tracks.pages().slot_of({0, 0}), 0);
    EXPECT_EQ(bits(stays.tracks, 1, 30), bits(goes.tracks, 1, 30));
    EXPECT_GT(glm::length(stays.tracks.at(20, 16.8).pressed), 0.2f);
    EXPECT_LT(glm::length(stays.tracks.at(20, 16.8).pressed), 0.5f); // 1/e in 40 s
}

TEST_F(Tracks, ALeapKeepsWhatLies) {
    scene::Scene scene = drive(10, 0, 30);
    scene.tracks->damping = 0.05;
    scene.tracks->recovery_per_s2 = 60;
    scene.paths["drive"].keys.push_back({4, {30, 5, 16}, 90, 0}); // it leaves the ground
    Field steps(scene), leaps(scene);
    for (int n = 0; n <= 80; ++n) {
        steps.advance(n);
    }
    leaps.advance(80);
    EXPECT_EQ(bits(steps.tracks, 1, 30), bits(leaps.tracks, 1, 30));
    EXPECT_LT(leaps.tracks.stepped_blocks(), steps.tracks.stepped_blocks());
}

TEST_F(Tracks, PagesAtRestAreNotStepped) {
    const scene::Scene base = drive(10, 0, 30);
    scene::Scene scene = base;
    scene.tracks->damping = 0.05;
    scene.tracks->recovery_per_s2 = 60;
    scene.paths["drive"].keys.push_back({4, {30, 5, 16}, 90, 0}); // it leaves the ground
    Field field(scene);
    field.advance(30);
    const std::uint64_t before = field.tracks.stepped_blocks();
    EXPECT_GT(before, 100u);
    field.advance(40);
    EXPECT_EQ(field.tracks.stepped_blocks(), before);
    EXPECT_GT(field.tracks.pages().used(), 0u);
}

TEST_F(Tracks, APictureBeginsTheNextSimulation) {
    const scene::Scene scene = drive(25, -20, 30);
    Field first(scene);
    first.advance(2.2);
    scene::Image picture = first.tracks.picture();
    ASSERT_GT(picture.width, 0);
    scene::Scene empty = scene;
    empty.tracks->feet.clear();
    Field second(empty);
    second.tracks.begin_with(picture, "t.exr");
    second.advance(0);
    for (double x = -19; x < 29; x += 1.3) {
        const auto a = first.tracks.at(x, 16.8), b = second.tracks.at(x, 16.8);
        EXPECT_NEAR(a.pressed.x, b.pressed.x, 1e-4f);
    }
    EXPECT_GT(second.tracks.at(5, 16.8).pressed.x, 0.5f);
    second.advance(5);
    second.advance(1); // back: begins with it again
    EXPECT_GT(second.tracks.at(5, 16.8).pressed.x, 0.5f);
    const auto refused = [&](scene::Image bad, const char* word) {
        try {
            second.tracks.begin_with(bad, "t.exr");
        } catch (const base::Error& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
            return;
        }
        ADD_FAILURE() << word;
    };
    scene::Image bad = picture;
    bad.metadata.clear();
    refused(bad, "no tracks");
    bad = picture;
    bad.metadata.begin()->second = "0.5 0 0";
    refused(bad, "cells of 0.5 m");
    bad = picture;
    bad.texels[7] = std::nanf("");
    refused(bad, "a value of nan");
    bad = picture;
    bad.channels = {"R", "G"};
    refused(bad, "no tracks");
}

TEST_F(Tracks, AbsurdBodiesHarmNothing) {
    scene::Scene scene;
    scene.tracks.emplace().pages = 8;
    const double nan = std::nan("");
    tracks::Tracks field(
        scene, 0.3,
        {[](double, double) { return 0.0; },
         [=](double time_s, double) {
             return std::vector<tracks::Ball>{
                 {{nan, 0, 0}, {0, 0, 0}, 1},
                 {{1e6 * time_s, 0.5, 0}, {1e6 * (time_s - 1 / 60.0), 0.5, 0}, 0.6},
                 {{0, 9999, 0}, {0, 9999, 0}, 10000},
                 {{1e30, 0, 1e30}, {1e30, 0, 1e30}, 1},
                 {{3, 0.1, 3}, {3, 0.1, 3}, 0}};
         }});
    const glm::dvec3 eye(0, 2, 0);
    for (int n = 1; n < 12; ++n) {
        field.advance(n / 60.0, {&eye, 1});
    }
    EXPECT_LE(field.pages().used(), 8u);
    EXPECT_GT(field.refused(), 0u);
    for (double x = 0; x < 30; x += 2) {
        const auto sample = field.at(x, 1);
        EXPECT_TRUE(std::isfinite(sample.theta.x) && std::isfinite(sample.pressed.y));
        EXPECT_LE(glm::length(sample.theta), 1.001f);
    }
}

} // namespace
} // namespace sward::tests
