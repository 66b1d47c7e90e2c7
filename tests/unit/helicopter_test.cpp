// SPDX-License-Identifier: Apache-2.0
// The helicopter over grounds that are functions: what a pilot would notice, and what must never
// happen.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "fly/helicopter.h"
#include "fly/helicopter_mesh.h"

namespace {

using namespace sward::fly;

constexpr double kDegree = 3.14159265358979 / 180;

HelicopterSpec preset() {
    return std::get<HelicopterSpec>(
        load_aircraft(std::string(SWARD_SOURCE_DIR) + "/aircraft/helicopter.toml"));
}

FlyLand flat(glm::dvec2 wind = {0, 0}) {
    return {[](double, double) { return 20.0; }, [wind](double, double) { return wind; }};
}

void fly(Helicopter& machine, double seconds, const HelicopterStick& stick, double rate = 60) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * rate)); ++i)
        machine.advance(1 / rate, stick);
}

double bank_deg(const HelicopterState& state) {
    return std::atan2(-(state.turn * glm::dvec3(1, 0, 0)).y, (state.turn * glm::dvec3(0, 1, 0)).y) /
           kDegree;
}

/// Held at a speed and a height by hands that are no pilot's.
HelicopterState held(double speed_mps, double seconds) {
    Helicopter machine(preset(), flat());
    machine.put_in_air({0, 1000, 0}, 0);
    double lever = machine.hover_lever();
    for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
        const HelicopterState state = machine.state();
        lever = std::clamp(
            lever - 0.002 * state.velocity_mps.y - 0.0002 * (state.position.y - 1000), 0.0, 1.0);
        const double pitch = std::clamp(-0.06 * (speed_mps + state.velocity_mps.z), -1.0, 1.0);
        machine.advance(1 / 60.0, {0, pitch, 0, lever});
    }
    return machine.state();
}

TEST(Rotor, HoversByMomentumTheory) {
    const RotorSpec spec;
    const double weight = 1100 * 9.81;
    Rotor rotor(spec);
    EXPECT_NEAR(rotor.hover_inflow_mps(weight), 7.44, 0.02); // sqrt(T / (2 rho A))
    rotor.settle(weight);
    RotorLoad load;
    for (int i = 0; i < 1000; ++i)
        load = rotor.step(1.0 / 240, rotor.hover_blade_rad(weight), {}, 1e6);
    EXPECT_NEAR(load.thrust_n, weight, 0.005 * weight);
    EXPECT_NEAR(rotor.inflow_mps(), 7.44, 0.05);
    EXPECT_NEAR(load.power_w, 131e3, 2e3); // 1.15 T v and the blades' own drag
    EXPECT_NEAR(rotor.rad_s(), spec.proper_rad_s(), 0.01);
}

TEST(Rotor, TheGroundHoldsItUp) {
    const RotorSpec spec;
    const auto thrust = [&](double height) {
        Rotor rotor(spec);
        rotor.settle(10'800);
        RotorLoad load;
        for (int i = 0; i < 1000; ++i)
            load = rotor.step(1.0 / 240, 0.13, {0, 0, height}, 1e6);
        return load.thrust_n;
    };
    EXPECT_GT(thrust(3), 1.04 * thrust(1000));
    EXPECT_LT(thrust(3), 1.25 * thrust(1000));
    EXPECT_NEAR(thrust(15), thrust(1000), 0.02 * thrust(1000)) << "three radii up it is gone";
}

TEST(Helicopter, HoversHandsOff) {
    Helicopter machine(preset(), flat());
    machine.put_in_air({100, 200, 50}, 30);
    const HelicopterStick hands_off{0, 0, 0, machine.hover_lever()};
    fly(machine, 120, hands_off);
    const HelicopterState state = machine.state();
    EXPECT_LT(glm::length(state.position - glm::dvec3(100, 200, 50)), 1);
    EXPECT_LT(glm::length(state.velocity_mps), 0.02);
    EXPECT_NEAR(bank_deg(state), -2.8, 0.3) << "it leans against its tail rotor's push";
    EXPECT_NEAR(std::atan2(state.ahead().x, -state.ahead().z) / kDegree, 30, 1);
}

TEST(Helicopter, HoldsItsPlaceInAWind) {
    Helicopter machine(preset(), flat({5, 3}));
    machine.put_in_air({0, 200, 0}, 0);
    fly(machine, 60, {0, 0, 0, machine.hover_lever()});
    const HelicopterState state = machine.state();
    EXPECT_LT(std::hypot(state.position.x, state.position.z), 6);
    EXPECT_GT(state.position.y, 205) << "a wind through the disc lifts it: translational lift";
}

TEST(Helicopter, WithoutHelpNobodyHoldsIt) {
    HelicopterSpec spec = preset();
    spec.help = {0, 30, 0, 60, 0, 0, 0, 0};
    Helicopter machine(spec, flat());
    machine.put_in_air({0, 400, 0}, 0);
    const double lever = machine.hover_lever();
    machine.advance(0.1, {0.3, 0, 0, lever}); // a nudge
    double most = 0;
    for (int i = 0; i < 30 * 60; ++i) {
        machine.advance(1 / 60.0, {0, 0, 0, lever});
        most = std::max(most, std::abs(bank_deg(machine.state())));
    }
    EXPECT_GT(most, 12) << "as with the real one";
}

TEST(Helicopter, StickPedalsAndLeverTurnItAsAPilotExpects) {
    Helicopter machine(preset(), flat());
    const double lever = machine.hover_lever();
    const auto after = [&](double seconds, HelicopterStick stick) {
        machine.put_in_air({0, 200, 0}, 0);
        fly(machine, seconds, stick);
        return machine.state();
    };
    EXPECT_GT(bank_deg(after(1, {0.45, 0, 0, lever})), 2);
    EXPECT_LT(bank_deg(after(1, {-0.45, 0, 0, lever})), -6);
    EXPECT_LT(after(4, {0, -0.4, 0, lever}).velocity_mps.z, -4) << "nose down, away";
    EXPECT_GT(after(1, {0, 0, 0.45, lever}).rates.z, 0.3) << "nose right";
    const double climb = after(10, {0, 0, 0, lever + 0.1}).velocity_mps.y;
    EXPECT_GT(climb, 3);
    EXPECT_LT(climb, 6);
    EXPECT_LT(after(10, {0, 0, 0, lever - 0.1}).velocity_mps.y, -2);
    // The lever all the way up asks for more than the engine has: the rotor slows, and holds.
    const HelicopterState up = after(20, {0, 0, 0, 1});
    EXPECT_LT(up.rotor_share, 0.97);
    EXPECT_GT(up.rotor_share, 0.85);
    EXPECT_GT(up.velocity_mps.y, 3);
}

TEST(Helicopter, TakesLessPowerAtTwentyMetresASecondThanInAHover) {
    const HelicopterState hover = held(0, 30), fast = held(20, 60), faster = held(38, 60);
    EXPECT_NEAR(hover.engine_w, 131e3, 3e3);
    EXPECT_NEAR(fast.airspeed_mps, 19, 3);
    EXPECT_LT(fast.engine_w, 0.75 * hover.engine_w);
    EXPECT_GT(faster.engine_w, fast.engine_w) << "past the bucket drag takes it back";
}

TEST(Helicopter, LiftsOffWithLessLeverThanItHoversWith) {
    Helicopter machine(preset(), flat());
    machine.put_on_ground(5, 7, 90);
    fly(machine, 5, {});
    const HelicopterState stood = machine.state();
    EXPECT_TRUE(stood.on_ground);
    EXPECT_FALSE(stood.crashed);
    EXPECT_NEAR(stood.position.y, 20 + preset().skid_m, 0.05);
    EXPECT_LT(glm::length(stood.velocity_mps), 0.02);
    fly(machine, 10, {0, 0, 0, machine.hover_lever()}); // ground effect
    EXPECT_GT(machine.state().position.y, 22.5);
    EXPECT_LT(machine.state().position.y, 28);
    fly(machine, 20, {0, 0, 0, machine.hover_lever() - 0.06});
    fly(machine, 5, {});
    EXPECT_TRUE(machine.state().on_ground);
    EXPECT_FALSE(machine.state().crashed);
}

TEST(Helicopter, SinksOnItsTurningRotorWithoutAnEngine) {
    Helicopter machine(preset(), flat());
    machine.put_in_air({0, 1500, 0}, 0);
    fly(machine, 10, {0, -0.4, 0, machine.hover_lever()});
    fly(machine, 25, {0, -0.15, 0, 0.12, false});
    const HelicopterState state = machine.state();
    EXPECT_EQ(state.engine_w, 0);
    EXPECT_GT(state.rotor_share, 0.9);
    EXPECT_GT(state.velocity_mps.y, -14);
    EXPECT_LT(state.velocity_mps.y, -6);
    // With the lever left where it was, the rotor stops being one.
    machine.put_in_air({0, 1500, 0}, 0);
    fly(machine, 6, {0, 0, 0, machine.hover_lever(), false});
    EXPECT_LT(machine.state().rotor_share, 0.75);
}

TEST(Helicopter, AHardGroundEndsInANewBeginning) {
    Helicopter machine(preset(), flat());
    machine.put_in_air({0, 120, 0}, 0);
    bool crashed = false;
    for (int i = 0; i < 20 * 60 && !crashed; ++i) {
        machine.advance(1 / 60.0, {0, 0, 0, 0.1});
        crashed = machine.state().crashed;
    }
    EXPECT_TRUE(crashed);
    fly(machine, 4, {0, 0, 0, machine.hover_lever()});
    EXPECT_FALSE(machine.state().crashed);
    EXPECT_NEAR(machine.state().position.y, 120, 3);
}

TEST(Helicopter, IsWhereItIsWhateverThePicturesRate) {
    const auto end = [](double rate) {
        Helicopter machine(preset(), flat({3, 1}));
        machine.put_in_air({0, 300, 0}, 0);
        fly(machine, 12, {0.1, -0.2, 0.05, 0.52}, rate);
        return machine.state().position;
    };
    EXPECT_LT(glm::length(end(240) - end(30)), 0.3);
    EXPECT_LT(glm::length(end(240) - end(144)), 0.6);
}

TEST(Helicopter, NothingThatIsAskedMakesItNoNumber) {
    Helicopter machine(preset(), flat());
    for (const double much : {1.0, -1.0, 1e9, -1e9, static_cast<double>(NAN)}) {
        machine.put_in_air({0, 100, 0}, 0);
        fly(machine, 20, {much, -much, much, much, much > 0});
        const HelicopterState state = machine.state();
        EXPECT_TRUE(std::isfinite(state.position.x + state.position.y + state.turn.w +
                                  state.thrust_n + state.rotor_share));
    }
    machine.advance(NAN, {});
    machine.advance(INFINITY, {});
    EXPECT_TRUE(std::isfinite(machine.state().position.y));
}

TEST(HelicopterSpec, WrongPresetsAreToldWithFileAndKey) {
    EXPECT_NO_THROW(static_cast<void>(parse_helicopter("", "h.toml")));
    for (const char* const bad :
         {"mass_kg = 0", "mass = 3", "kind = \"balloon\"", "inertia_kgm2 = [1, 2]",
          "[rotor]\nblades = 2.5", "[rotor]\nradius_m = nan", "[rotor]\ncollective_most_deg = 6",
          "[help]\nlean_deg = 90", "power_kw = 60", "mass_kg = 4000", "= 3"})
        try {
            static_cast<void>(parse_helicopter(bad, "h.toml"));
            ADD_FAILURE() << bad;
        } catch (const sward::base::Error& error) {
            EXPECT_EQ(error.code(), sward::base::ExitCode::kBadInput) << bad;
            EXPECT_EQ(std::string(error.what()).find("h.toml"), 0u) << error.what();
        }
}

TEST(HelicopterMesh, HasItsPresetsMeasuresAndLeavesThePilotsViewFree) {
    const HelicopterSpec spec = preset();
    const sward::scene::Mesh body = helicopter_mesh(spec), rotor = rotor_mesh(spec),
                             tail = tail_rotor_mesh(spec);
    float low = 1e9f, wide = 0;
    for (const glm::vec3& at : body.positions) {
        low = std::min(low, at.y);
        EXPECT_TRUE(static_cast<double>(at.z) > spec.eye_m.z - 0.05 ||
                    static_cast<double>(at.y) < spec.eye_m.y - 0.2)
            << "ahead of the pilot";
    }
    for (const glm::vec3& at : rotor.positions)
        wide = std::max(wide, std::hypot(at.x, at.z));
    EXPECT_NEAR(low, -spec.skid_m, 1e-4);
    EXPECT_NEAR(wide, spec.rotor.radius_m, 0.02);
    for (const glm::vec3& at : tail.positions)
        EXPECT_LT(std::abs(at.x), 0.2f);
    for (const sward::scene::Mesh* const mesh : {&body, &rotor, &tail})
        for (std::size_t i = 0; i < mesh->triangles.size(); ++i) { // fronts as the normals say
            const auto& t = mesh->triangles[i];
            const glm::vec3 front = glm::cross(mesh->positions[t[1]] - mesh->positions[t[0]],
                                               mesh->positions[t[2]] - mesh->positions[t[0]]);
            EXPECT_GT(glm::dot(front, mesh->normals[t[0]]), 0) << i;
        }
}

} // namespace
