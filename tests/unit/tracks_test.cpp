// SPDX-License-Identifier: Apache-2.0
// The continuum of tracks (methods.md C1 to C4) by its C++ twin, and the keys of a scene's
// [tracks].
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/scene.h"
#include "shared/track_seen.h"
#include "tracks/page_memory.h"
#include "tracks/pages.h"
#include "tracks/track_twin.h"
#include "tracks/tracks.h"

namespace sward::tests {
namespace {

using shared::TrackCell;
using shared::TrackRules;
using tracks::TrackTwin;

constexpr float kStep = shared::kTrackStep_s;
constexpr int kSide = shared::kTrackCells;

TrackRules plain_rules(float wave_mps, float damping, float k, float gain = 0) {
    scene::TrackSpec spec;
    spec.wave_mps = static_cast<double>(wave_mps);
    spec.damping = static_cast<double>(damping);
    spec.recovery_per_s2 = static_cast<double>(k);
    spec.wave_gain_m = static_cast<double>(gain);
    return tracks::rules_of(spec, 0.3);
}

/// A wall of bend from north to south, so that the wave is a plane one.
void raise_wall(TrackTwin& field, float middle, float width) {
    for (int z = 0; z < kSide; ++z) {
        for (int x = 0; x < kSide; ++x) {
            const float away = (static_cast<float>(x) - middle) / width;
            field.at(x, z).theta = {0.5f * std::exp(-0.5f * away * away), 0};
        }
    }
}

/// Where the half of the wave that runs east has its crest (cells).
double crest(TrackTwin& field, int from) {
    int best = from;
    for (int x = from; x < kSide - 1; ++x) {
        best = field.at(x, 64).theta.x > field.at(best, 64).theta.x ? x : best;
    }
    const double a = static_cast<double>(field.at(best - 1, 64).theta.x),
                 b = static_cast<double>(field.at(best, 64).theta.x),
                 c = static_cast<double>(field.at(best + 1, 64).theta.x);
    return best + 0.5 * (a - c) / (a - 2 * b + c);
}

TEST(Tracks, AFrontRunsAtItsSpeed) {
    for (const float speed : {1.0f, 4.0f, 8.0f}) {
        TrackRules rules = plain_rules(speed, 0.01f, 0);
        rules.cell_m = speed / 16; // so that it runs a few cells before damping has it
        TrackTwin field;
        raise_wall(field, 30, 4);
        const double cells_a_step = static_cast<double>(speed * kStep / rules.cell_m);
        const int early = static_cast<int>(16 / cells_a_step),
                  late = static_cast<int>(52 / cells_a_step);
        double first = 0;
        for (int n = 1; n <= late; ++n) {
            field.step(rules, {}, {0, 0});
            if (n == early) {
                first = crest(field, 38);
            }
        }
        const double measured = (crest(field, 60) - first) / (late - early) / cells_a_step;
        EXPECT_NEAR(measured, 1, 0.05) << speed << " m/s";
    }
}

TEST(Tracks, ATipBendsAsItsRootDidAWhileAgo) {
    constexpr float speed = 4;
    TrackRules rules = plain_rules(speed, 0.01f, 0);
    TrackTwin field;
    raise_wall(field, 30, 5);
    for (TrackCell& cell : field.cells) {
        cell.omega = {1, 0}; // what passed ran east
    }
    const auto theta = [&](float cells) {
        const auto x = static_cast<int>(cells);
        return glm::mix(field.at(x, 64).theta.x, field.at(x + 1, 64).theta.x,
                        cells - static_cast<float>(x));
    };
    for (const float share : {0.5f, 1.0f}) {
        const glm::vec2 ahead = shared::track_delay({0.1f, 0}, {1, 0}, share, {speed, 0});
        EXPECT_NEAR(ahead.x, share * shared::kDelay_s * speed, 1e-5f);
    }
    EXPECT_LT(shared::track_delay({-0.1f, 0}, {1, 0}, 1, {speed, 0}).x,
              0.6f * shared::kDelay_s * speed); // back up it is quicker
    EXPECT_LE(shared::track_delay({0.1f, 0}, {100, 0}, 1, {speed, 0}).x,
              speed * 0.5f * shared::kPi / 100 + 1e-5f);
    std::vector<float> root;
    for (int n = 0; n < 120; ++n) {
        field.step(rules, {}, {0, 0});
        root.push_back(theta(58));
        const int ago = static_cast<int>(shared::kDelay_s / kStep + 0.5f);
        if (n > 80) { // the wave is there
            EXPECT_NEAR(theta(58 + shared::kDelay_s * speed / rules.cell_m),
                        root[static_cast<std::size_t>(n - ago)], 0.02f)
                << n;
        }
    }
    EXPECT_GT(*std::max_element(root.begin() + 80, root.end()), 0.1f);
}

/// The energy that central damping takes from and never adds to: half of the changes' squares and
/// of bend times what draws it back.
double energy(TrackTwin& before, TrackTwin& now, const TrackRules& rules) {
    double sum = 0;
    for (int z = 0; z < kSide; ++z) {
        for (int x = 0; x < kSide; ++x) {
            const auto beside = [&](int bx, int bz) {
                const TrackCell& cell =
                    before.at(std::clamp(bx, 0, kSide - 1), std::clamp(bz, 0, kSide - 1));
                return glm::vec4(cell.theta, cell.omega);
            };
            TrackCell still = before.at(x, z);
            still.theta_step = still.omega_step = {0, 0};
            const glm::vec4 drawn =
                -shared::track_change(rules, still, beside(x - 1, z), beside(x + 1, z),
                                      beside(x, z - 1), beside(x, z + 1)) /
                (1 - 0.5f * rules.damping);
            const TrackCell& next = now.at(x, z);
            const glm::vec4 change(next.theta_step, next.omega_step), place(next.theta, next.omega);
            sum += 0.5 * static_cast<double>(glm::dot(change, change) + glm::dot(place, drawn));
        }
    }
    return sum;
}

TEST(Tracks, EnergyNeverGrows) {
    for (const float damping : {0.01f, 0.3f, 1.0f}) {
        for (const float k : {0.0f, 8.0f, 900.0f}) {
            TrackRules rules = plain_rules(1, damping, k);
            rules.wave_mps = rules.rate_wave_mps = rules.most_wave_mps; // at the very bound
            TrackTwin field;
            unsigned random = 1;
            for (TrackCell& cell : field.cells) {
                random = random * 1664525u + 1013904223u;
                const float x = static_cast<float>(random >> 8) / 16777216.0f - 0.5f;
                cell.theta = {0.2f * x, 0.1f * x * x};
                cell.omega = {0.1f * x, -0.1f * x};
            }
            double last = 1e30;
            for (int n = 0; n < 25; ++n) {
                TrackTwin before = field;
                field.step(rules, {}, {0, 0});
                const double now = energy(before, field, rules);
                ASSERT_LE(now, last * (1 + 1e-5))
                    << "step " << n << ", l " << damping << ", k " << k;
                last = now;
            }
        }
    }
}

TEST(Tracks, FastWavesAreHeldInsideTheBound) {
    TrackRules rules = plain_rules(10, 0.01f, 0, 1.5f); // c0 + mu |omega| would be a thousand
    TrackTwin field;
    for (int n = 0; n < 40; ++n) {
        field.at(60 + n % 8, 60).omega = {200, -100};
    }
    for (int n = 0; n < 300; ++n) {
        field.step(rules, {}, {0, 0});
    }
    float most = 0;
    for (const TrackCell& cell : field.cells) {
        most = std::max({most, glm::length(cell.theta), glm::length(cell.omega)});
        ASSERT_TRUE(std::isfinite(cell.theta.x) && std::isfinite(cell.omega.y));
    }
    EXPECT_LT(most, 224); // no more than what was put in
}

TEST(Tracks, AUniformBendRisesAtTheRateOfK) {
    for (const float k : {2.0f, 8.0f, 60.0f}) {
        const float damping = 0.15f;
        TrackTwin field;
        for (TrackCell& cell : field.cells) {
            cell.theta = {0.6f, -0.3f};
        }
        const TrackRules rules = plain_rules(2, damping, k);
        // x'' + g x' + k x = 0 by small steps
        const double g = 2.0 * static_cast<double>(damping) / (2.0 - static_cast<double>(damping)) /
                         static_cast<double>(kStep);
        double x = 1, v = 0;
        for (int n = 1; n <= 60; ++n) {
            field.step(rules, {}, {0, 0});
            for (int m = 0; m < 1000; ++m) {
                v -= (g * v + static_cast<double>(k) * x) * static_cast<double>(kStep) / 1000;
                x += v * static_cast<double>(kStep) / 1000;
            }
            ASSERT_NEAR(static_cast<double>(field.at(64, 64).theta.x), 0.6 * x, 0.02)
                << "k " << k << ", step " << n;
        }
    }
    const TrackRules paper = plain_rules(2, 0.15f, 0);
    TrackTwin field;
    field.at(0, 0).theta = {0, 0};
    for (TrackCell& cell : field.cells) {
        cell.theta = {0.6f, 0};
    }
    field.step(paper, {}, {0, 0});
    EXPECT_EQ(field.at(64, 64).theta.x, 0.6f); // k = 0: it never rises
}

shared::TrackPrint print_at(float x, float before_x, float z, glm::vec4 shape, int kind) {
    shared::TrackPrint print{};
    print.now = {{x, z}, {0, 1}}; // looks east
    print.before = {{before_x, z}, {0, 1}};
    print.half_width_m = shape.x;
    print.half_depth_m = shape.y;
    print.underside_m = shape.z;
    print.load = shape.w;
    print.kind = kind;
    return print;
}

/// Cells across the strip in every column that a print leaves between 10 and 20 m: least, most,
/// sum.
glm::ivec3 strip(float speed, glm::vec4 shape, int kind) {
    const TrackRules rules = plain_rules(2, 0.15f, 8, 0.2f);
    std::vector<glm::vec2> pressed(TrackTwin::kCount, glm::vec2(0));
    for (float x = 8.5f; x < 21; x += speed * kStep) {
        const shared::TrackPrint print = print_at(x + speed * kStep, x, 16.1f, shape, kind);
        for (int row = 56; row < 74; ++row) {
            for (int column = 40; column < 80; ++column) {
                const shared::TrackContact contact = shared::track_contact(
                    rules, print, rules.cell_m * (glm::vec2(column, row) + 0.5f));
                glm::vec2& cell = pressed[static_cast<std::size_t>(row * kSide + column)];
                cell = contact.touched == 1 ? shared::track_pressed(rules, cell, contact, 1) : cell;
            }
        }
    }
    glm::ivec3 found(kSide, 0, 0);
    for (int x = 40; x < 80; ++x) {
        int wide = 0;
        for (int z = 0; z < kSide; ++z) {
            wide += glm::length(pressed[static_cast<std::size_t>(z * kSide + x)]) > 0.3f ? 1 : 0;
        }
        found = {std::min(found.x, wide), std::max(found.y, wide), found.z + wide};
    }
    return found;
}

TEST(Tracks, AnySpeedLeavesTheSameStrip) {
    for (const auto& [shape, kind] :
         {std::pair{glm::vec4(0.15f, 0.35f, 0, 1), shared::kPrintWheel},
          std::pair{glm::vec4(1, 1, 0, 1), shared::kPrintSphere},
          std::pair{glm::vec4(0.75f, 0.5f, 0.03f, 1), shared::kPrintBox}}) {
        const glm::ivec3 slow = strip(1, shape, kind);
        EXPECT_GE(slow.x, 1) << kind;
        EXPECT_LE(slow.y - slow.x, 1) << kind;
        for (const float speed : {10.0f, 50.0f}) {
            const glm::ivec3 fast = strip(speed, shape, kind);
            EXPECT_GE(fast.x, 1) << kind << " at " << speed;
            EXPECT_LE(std::abs(fast.x - slow.x), 1) << kind << " at " << speed;
            EXPECT_LE(std::abs(fast.y - slow.y), 1) << kind << " at " << speed;
        }
    }
}

TEST(Tracks, GrassUnderWhatStaysIsHeldDownAndLeansAwayFromIt) {
    const TrackRules rules = plain_rules(2, 0.15f, 8);
    const shared::TrackPrint print = print_at(16, 16, 16, {1, 1, 0.05f, 1}, shared::kPrintSphere);
    TrackTwin field;
    for (int n = 0; n < 300; ++n) {
        field.step(rules, {&print, 1}, {0, 0});
    }
    EXPECT_GT(field.at(65, 64).theta.x, 0.9f);
    EXPECT_LT(field.at(62, 64).theta.x, -0.9f);
    EXPECT_GT(glm::length(field.at(67, 63).theta), glm::length(field.at(72, 63).theta));
    for (int n = 0; n < 600; ++n) { // it goes
        field.step(rules, {}, {0, 0});
    }
    EXPECT_LT(glm::length(field.at(66, 64).theta), 0.01f);
    EXPECT_GT(glm::length(field.pressed[64 * kSide + 65]), 0.3f);
}

TEST(Tracks, ASkidThatHoversBrushesTipsAndUphillTheGroundComesUp) {
    const TrackRules rules = plain_rules(2, 0.15f, 8);
    TrackTwin low, high, hill;
    const shared::TrackPrint on_ground =
                                 print_at(16.2f, 16, 16, {0.5f, 0.5f, 0, 1}, shared::kPrintBox),
                             hovers =
                                 print_at(16.2f, 16, 16, {0.5f, 0.5f, 0.27f, 1}, shared::kPrintBox),
                             over =
                                 print_at(16.2f, 16, 16, {0.5f, 0.5f, 0.31f, 1}, shared::kPrintBox);
    low.step(rules, {&on_ground, 1}, {0, 0});
    high.step(rules, {&hovers, 1}, {0, 0});
    hill.step(rules, {&on_ground, 1}, {1, 0});
    EXPECT_GT(low.at(64, 64).theta.x, 0.95f);
    EXPECT_EQ(high.pressed[64 * kSide + 64], glm::vec2(0));
    EXPECT_GT(high.at(64, 64).theta.x, 0.1f);
    EXPECT_NEAR(hill.at(64, 64).theta.x, 0.5f, 0.02f); // 45 degrees uphill
    TrackTwin none;
    none.step(rules, {&over, 1}, {0, 0});
    EXPECT_EQ(none.at(64, 64).theta, glm::vec2(0));
}

TEST(Tracks, WindAndTrackAddInOneUnit) {
    const float response = 0.1f;
    const glm::vec2 wind(3, 1);
    EXPECT_EQ(shared::sway_wind(wind, response, {0, 0}, {0, 0}), wind);
    for (const float bend : {0.05f, 0.4f, 0.9f}) {
        const glm::vec2 alone = shared::sway_wind({0, 0}, response, {bend, 0}, {0, 0});
        EXPECT_NEAR(shared::bend_intensity(glm::length(alone), response), bend, 1e-4f);
    }
    const float blown = shared::bend_intensity(4, response);
    const glm::vec2 both = shared::sway_wind({4, 0}, response, {0.3f, 0}, {0, 0});
    EXPECT_NEAR(shared::bend_intensity(both.x, response), blown + 0.3f, 1e-4f);
    EXPECT_LE(shared::bend_intensity(
                  glm::length(shared::sway_wind({80, 0}, response, {1, 0}, {1, 0})), response),
              shared::kMostSwayBend + 1e-4f);
    EXPECT_GT(shared::lying_light({1, 0}, 1, {-0.9f, 0.4f, 0}), 1.2f);
    EXPECT_LT(shared::lying_light({1, 0}, 1, {0.9f, 0.4f, 0}), 0.8f);
}

TEST(Tracks, MemoryGivesPagesBackToTheBitAndKeepsItsBudget) {
    tracks::PageMemory memory(40'000);
    tracks::PageContent content;
    content.pressed.assign(TrackTwin::kCount, 0);
    content.moving = {7, 99, 8, 120, 63, 4};
    content.bends.assign(3 * 256, {0, 0, 0, 0});
    content.changes = content.bends;
    for (int n = 0; n < 500; ++n) {
        content.pressed[static_cast<std::size_t>(7 * n)] =
            shared::track_pack({0.002f * static_cast<float>(n), -1.0f / 3.0f});
        content.bends[static_cast<std::size_t>(n)] = {1e-7f * static_cast<float>(n), 0.7f, -0.2f,
                                                      0};
    }
    content.epoch = 3;
    EXPECT_TRUE(memory.put({-4, 9}, content));
    const auto back = memory.take({-4, 9});
    ASSERT_TRUE(back.has_value());
    EXPECT_TRUE(back->pressed == content.pressed && back->moving == content.moving &&
                back->bends == content.bends && back->changes == content.changes);
    EXPECT_EQ(back->epoch, 3);
    EXPECT_EQ(memory.bytes(), 0u);
    EXPECT_FALSE(memory.take({-4, 9}).has_value());
    for (int n = 0; n < 40; ++n) {
        memory.put({n, 0}, content);
    }
    EXPECT_LE(memory.bytes(), 40'000u);
    EXPECT_GT(memory.lost(), 0u);
    EXPECT_FALSE(memory.has({0, 0}));
    EXPECT_TRUE(memory.has({39, 0}));
}

TEST(Tracks, ThePoolHoldsItsBoundAndDropsTheFarthest) {
    tracks::Pages pages(4, 32);
    for (int n = 0; n < 4; ++n) {
        EXPECT_GE(pages.open({n, 0}), 0);
    }
    EXPECT_EQ(pages.open({9, 9}), -1);
    const glm::dvec2 eye(5, 5);
    EXPECT_EQ(pages.least_needed({&eye, 1}, 10, {}), pages.slot_of({3, 0}));
    pages.slots()[static_cast<std::size_t>(pages.slot_of({3, 0}))].busy_until = 20;
    EXPECT_EQ(pages.least_needed({&eye, 1}, 10, {}),
              pages.slot_of({2, 0})); // what moves stays longer
    const auto table = pages.table();
    for (int n = 0; n < 4; ++n) {
        EXPECT_EQ(std::count_if(table.begin(), table.end(),
                                [&](const glm::ivec4& entry) {
                                    return entry.z == pages.slot_of({n, 0}) && entry.x == n;
                                }),
                  1);
    }
    EXPECT_EQ(pages.key_at({-0.1, 31.9}), tracks::PageKey(-1, 0));
}

std::string refusal(const std::string& keys) {
    const std::string text = "[terrain]\nelevation = \"a.tif\"\n[tracks]\n" + keys +
                             "\n[path.drive]\nkeys = [ { t = 0, position = [0, 0, 0] } ]\n";
    try {
        static_cast<void>(scene::parse_scene(text, "s.toml"));
    } catch (const base::Error& error) {
        return error.what();
    }
    return "";
}

TEST(Tracks, KeysOutOfRangeAreRefused) {
    EXPECT_EQ(refusal(""), "");
    EXPECT_EQ(refusal("pages = 4\n[[tracks.foot]]\npath = \"drive\"\nwheel = [0.8, 0, 0.2, 0.35]"),
              "");
    EXPECT_NE(refusal("damping = 0").find("tracks.damping"), std::string::npos);
    EXPECT_NE(refusal("damping = 1.5").find("tracks.damping"), std::string::npos);
    EXPECT_NE(refusal("damping = nan").find("tracks.damping"), std::string::npos);
    EXPECT_NE(refusal("wave_mps = 0.5").find("tracks.wave_mps"), std::string::npos);
    EXPECT_NE(refusal("wave_gain_m = 2").find("tracks.wave_gain_m"), std::string::npos);
    EXPECT_NE(refusal("cell_m = 0.05\nwave_mps = 3").find("tracks.wave_mps"),
              std::string::npos); // outside the stable bound
    EXPECT_NE(refusal("pages = 0").find("tracks.pages"), std::string::npos);
    EXPECT_NE(refusal("speed = 3").find("speed"), std::string::npos);
    EXPECT_EQ(refusal("mask = \"a.png\"\nmask_place = [0, 0]\nmask_size_m = [10, 20]"), "");
    EXPECT_NE(refusal("mask = \"a.png\"\nmask_place = [0, 0]").find("tracks.mask_size_m"),
              std::string::npos);
    EXPECT_NE(refusal("mask_way_deg = 20").find("tracks.mask"), std::string::npos);
    EXPECT_NE(refusal("mask = \"a.png\"\nmask_way = \"b.png\"\nmask_way_deg = 20")
                  .find("tracks.mask_way_deg"),
              std::string::npos);
    EXPECT_NE(refusal("[[tracks.foot]]\npath = \"drive\"").find("shapes"), std::string::npos);
    EXPECT_NE(refusal("[[tracks.foot]]\npath = \"dirve\"\nbox = [0, 0, 1, 1]").find("drive"),
              std::string::npos);
    EXPECT_NE(refusal("[[tracks.foot]]\npath = \"drive\"\nwheel = [0, 0, 0, 1]").find("wheel"),
              std::string::npos);
}

} // namespace
} // namespace sward::tests
