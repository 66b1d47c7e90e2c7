// SPDX-License-Identifier: Apache-2.0
// The aeroplane over grounds that are functions: what a pilot would notice, and what must never
// happen.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "fly/aeroplane.h"
#include "fly/aeroplane_mesh.h"

namespace {

using namespace sward::fly;

constexpr double kDegree = 3.14159265358979 / 180;

AeroplaneSpec trainer() {
    return load_aeroplane(std::string(SWARD_SOURCE_DIR) + "/aircraft/trainer.toml");
}

FlyLand flat(glm::dvec2 wind = {0, 0}) {
    return {[](double, double) { return 20.0; }, [wind](double, double) { return wind; }};
}

void fly(Aeroplane& plane, double seconds, const Stick& stick, double rate = 60) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * rate)); ++i)
        plane.advance(1 / rate, stick);
}

double bank_deg(const AeroplaneState& state) {
    return std::atan2(-(state.turn * glm::dvec3(1, 0, 0)).y, (state.turn * glm::dvec3(0, 1, 0)).y) /
           kDegree;
}

double heading_deg(const AeroplaneState& state) {
    return std::atan2(state.ahead().x, -state.ahead().z) / kDegree;
}

TEST(Aeroplane, FliesLevelHandsOffAtItsCruisingSpeed) {
    Aeroplane plane(trainer(), flat());
    plane.put_in_air({100, 500, 50}, 30);
    const Stick hands_off{0, 0, 0, plane.cruise_throttle(), 0};
    fly(plane, 60, hands_off);
    const AeroplaneState state = plane.state();
    EXPECT_NEAR(state.position.y, 500, 15);
    EXPECT_NEAR(state.airspeed_mps, 50, 1.5);
    EXPECT_NEAR(bank_deg(state), 0, 0.5);
    EXPECT_NEAR(heading_deg(state), 30, 0.5);
    EXPECT_NEAR(glm::length(glm::dvec2(state.position.x - 100, state.position.z - 50)), 3000, 60);
}

TEST(Aeroplane, AWindCarriesIt) {
    Aeroplane plane(trainer(), flat({8, 0}));
    plane.put_in_air({0, 500, 0}, 0);
    fly(plane, 20, {0, 0, 0, plane.cruise_throttle(), 0});
    EXPECT_NEAR(plane.state().position.x, 160, 8);
    EXPECT_NEAR(plane.state().airspeed_mps, 50, 1.5);
}

TEST(Aeroplane, StickAndPedalsTurnItAsAPilotExpects) {
    Aeroplane plane(trainer(), flat());
    const auto after = [&](double seconds, Stick stick) {
        plane.put_in_air({0, 800, 0}, 0);
        stick.throttle = plane.cruise_throttle();
        fly(plane, seconds, stick);
        return plane.state();
    };
    EXPECT_GT(bank_deg(after(0.5, {0.5, 0, 0})), 5);
    EXPECT_LT(bank_deg(after(0.5, {-0.5, 0, 0})), -5);
    EXPECT_GT(after(0.7, {0, 0.3, 0}).velocity_mps.y, 1);
    EXPECT_LT(after(0.7, {0, -0.3, 0}).velocity_mps.y, -1);
    EXPECT_GT(after(0.4, {0, 0, 0.5}).rates.z, 0.02);
    // A bank turns it: at 30 degrees and 50 m/s by g tan(bank) / v, some 6.5 degrees a second.
    plane.put_in_air({0, 800, 0}, 0);
    const double throttle = plane.cruise_throttle();
    const auto hold_bank = [&](double seconds) {
        for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
            const AeroplaneState state = plane.state();
            plane.advance(1 / 60.0, {std::clamp(0.03 * (30 - bank_deg(state)) - 0.4 * state.rates.x,
                                                -1.0, 1.0),
                                     0.12 - 0.02 * state.velocity_mps.y, 0.05, throttle, 0});
        }
    };
    hold_bank(8);
    const double from = heading_deg(plane.state());
    hold_bank(5);
    EXPECT_NEAR(heading_deg(plane.state()) - from, 5 * 6.5, 6);
}

TEST(Aeroplane, StallsWhenItIsHeldUpWithoutPower) {
    Aeroplane plane(trainer(), flat());
    plane.put_in_air({0, 1500, 0}, 0);
    bool stalled = false;
    double slowest = 100, sinking = 0;
    for (int i = 0; i < 25 * 60; ++i) {
        plane.advance(1 / 60.0, {0, 1, 0, 0, 0});
        stalled = stalled || plane.state().stalled;
        slowest = std::min(slowest, plane.state().airspeed_mps);
        sinking = std::min(sinking, plane.state().velocity_mps.y);
    }
    EXPECT_TRUE(stalled);
    EXPECT_LT(slowest, 30) << "a wing of 16 m2 carries 1043 kg down to some 27 m/s";
    EXPECT_LT(sinking, -4);
    fly(plane, 12, {0, -0.2, 0, 1, 0}); // stick forward, power
    EXPECT_FALSE(plane.state().stalled);
    EXPECT_GT(plane.state().airspeed_mps, 30);
}

TEST(Aeroplane, TheGroundHelpsItsWing) {
    // Gliding level just over the ground it loses less speed than high up.
    const auto speed_after = [](double height) {
        Aeroplane plane(trainer(), flat());
        plane.put_in_air({0, height, 0}, 0);
        for (int i = 0; i < 14 * 60; ++i) {
            const AeroplaneState state = plane.state();
            plane.advance(1 / 60.0, {0,
                                     std::clamp(0.08 * (height - state.position.y) -
                                                    0.12 * state.velocity_mps.y,
                                                -1.0, 1.0),
                                     0, 0, 0});
        }
        return plane.state().airspeed_mps;
    };
    EXPECT_GT(speed_after(20 + 1.9), speed_after(500) + 0.3);
}

TEST(Aeroplane, StandsTaxiesAndTakesOff) {
    Aeroplane plane(trainer(), flat());
    plane.put_on_ground(5, 7, 90);
    fly(plane, 5, {0, 0, 0, 0, 1});
    const AeroplaneState stood = plane.state();
    EXPECT_TRUE(stood.on_ground);
    EXPECT_FALSE(stood.crashed);
    EXPECT_NEAR(stood.position.y, 20 + trainer().gear_m, 0.05);
    EXPECT_LT(glm::length(stood.velocity_mps), 0.02);
    fly(plane, 5, {0, 0, 0, 0, 1});
    EXPECT_LT(glm::length(plane.state().position - stood.position), 0.05);
    double rolled = 0;
    for (int i = 0; i < 60 * 60 && plane.state().position.y < 40; ++i) {
        plane.advance(1 / 60.0, {0, plane.state().airspeed_mps > 28 ? 0.25 : 0, 0, 1, 0});
        if (plane.state().on_ground)
            rolled = plane.state().position.x - stood.position.x;
    }
    EXPECT_GT(plane.state().position.y, 39.9);
    EXPECT_GT(rolled, 120);
    EXPECT_LT(rolled, 700);
    EXPECT_FALSE(plane.state().crashed);
}

TEST(Aeroplane, AHillEndsInANewBeginning) {
    Aeroplane plane(trainer(), {[](double, double z) { return z < -500 ? 400.0 : 0.0; }, {}});
    plane.put_in_air({0, 200, 0}, 0);
    const double throttle = plane.cruise_throttle();
    bool crashed = false;
    for (int i = 0; i < 14 * 60; ++i) {
        plane.advance(1 / 60.0, {0, 0, 0, throttle, 0});
        crashed = crashed || plane.state().crashed;
        EXPECT_GT(plane.state().position.z, -520);
    }
    EXPECT_TRUE(crashed);
    fly(plane, 1, {0, 0, 0, throttle, 0});
    EXPECT_NEAR(plane.state().position.y, 200, 30);
}

TEST(Aeroplane, IsWhereItIsWhateverThePicturesRate) {
    const auto end = [](double rate) {
        Aeroplane plane(trainer(), flat({3, 1}));
        plane.put_in_air({0, 300, 0}, 0);
        fly(plane, 12, {0.1, 0.05, 0, 0.7, 0}, rate);
        return plane.state().position;
    };
    EXPECT_LT(glm::length(end(240) - end(30)), 0.3);
    EXPECT_LT(glm::length(end(240) - end(144)), 0.6);
}

TEST(Aeroplane, NothingThatIsAskedMakesItNoNumber) {
    Aeroplane plane(trainer(), flat());
    for (const double much : {1.0, -1.0, 1e9, -1e9}) {
        plane.put_in_air({0, 100, 0}, 0);
        fly(plane, 20, {much, -much, much, much, much});
        EXPECT_TRUE(std::isfinite(plane.state().position.x + plane.state().position.y +
                                  plane.state().turn.w));
    }
    plane.advance(NAN, {});
    plane.advance(INFINITY, {});
    EXPECT_TRUE(std::isfinite(plane.state().position.y));
}

TEST(AeroplaneSpec, WrongPresetsAreToldWithFileAndKey) {
    EXPECT_NO_THROW(static_cast<void>(parse_aeroplane("", "a.toml")));
    for (const char* const bad :
         {"mass_kg = 0", "mass = 3", "span_m = nan", "inertia_kgm2 = [1, 2]",
          "[air]\npitch_slope = 0.5", "[air]\nlift = 3", "cruise_mps = 15", "= 3"})
        try {
            static_cast<void>(parse_aeroplane(bad, "a.toml"));
            ADD_FAILURE() << bad;
        } catch (const sward::base::Error& error) {
            EXPECT_EQ(error.code(), sward::base::ExitCode::kBadInput) << bad;
            EXPECT_EQ(std::string(error.what()).find("a.toml"), 0u) << error.what();
        }
}

TEST(AeroplaneMesh, HasItsPresetsMeasuresAndLeavesThePilotsViewFree) {
    const AeroplaneSpec spec = trainer();
    const sward::scene::Mesh mesh = aeroplane_mesh(spec);
    glm::vec3 low(1e9f), high(-1e9f);
    for (const glm::vec3& at : mesh.positions) {
        low = glm::min(low, at);
        high = glm::max(high, at);
        EXPECT_TRUE(at.z > -0.6f || static_cast<double>(at.y) < spec.eye_m.y - 0.2)
            << "ahead of the pilot";
    }
    EXPECT_NEAR(high.x - low.x, spec.span_m, 1e-4);
    EXPECT_NEAR(low.y, -spec.gear_m, 1e-4);
}

} // namespace
