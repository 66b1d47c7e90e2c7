// SPDX-License-Identifier: Apache-2.0
// The vehicle on grounds that are functions: what a driver would notice, and what must never
// happen.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/error.h"
#include "drive/vehicle.h"
#include "drive/vehicle_mesh.h"

namespace {

using namespace sward::drive;

const std::string kRoot = SWARD_SOURCE_DIR;

VehicleSpec car() {
    return load_vehicle(kRoot + "/vehicles/car.toml");
}

DriveLand flat(Surface surface = Surface::kGrass) {
    return {[](double, double) { return 12.5; }, [surface](double, double) { return surface; }};
}

void drive(Vehicle& vehicle, double seconds, const Pedals& pedals, double rate = 60) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * rate)); ++i)
        vehicle.advance(1 / rate, pedals);
}

double yaw_deg(const VehicleState& state) {
    const glm::dvec3 ahead = state.ahead();
    return std::atan2(ahead.x, -ahead.z) * 180 / 3.14159265358979;
}

TEST(Vehicle, PresetsStandOnTheirWheelsAndStay) {
    for (const char* const name : {"car", "tractor"}) {
        Vehicle vehicle(load_vehicle(kRoot + "/vehicles/" + name + ".toml"), flat());
        vehicle.put(100, -50, 30);
        drive(vehicle, 3, {});
        const VehicleState stood = vehicle.state();
        EXPECT_NEAR(stood.position.y, 12.5, 0.03) << name;
        EXPECT_NEAR(yaw_deg(stood), 30, 0.5) << name;
        EXPECT_NEAR((stood.turn * glm::dvec3(0, 1, 0)).y, 1, 1e-3) << name;
        double load = 0;
        for (const WheelState& wheel : stood.wheels) {
            EXPECT_TRUE(wheel.touches) << name;
            EXPECT_NEAR(wheel.contact.y, 12.5, 1e-3);
            load += wheel.load_n;
        }
        EXPECT_NEAR(load / (vehicle.spec().mass_kg * 9.81), 1, 0.05) << name;
        drive(vehicle, 20, {});
        EXPECT_EQ(vehicle.state().position, stood.position) << name << ": without input it stands";
    }
}

TEST(Vehicle, WheelsAreWhereTheyShouldBe) {
    Vehicle vehicle(car(), flat());
    vehicle.put(0, 0, 0);
    drive(vehicle, 2, {});
    const auto wheels = vehicle.state().wheels; // looking north: left is west, ahead is -z
    EXPECT_NEAR(wheels[0].contact.x, -0.775, 0.02);
    EXPECT_NEAR(wheels[0].contact.z, -1.15, 0.02);
    EXPECT_NEAR(wheels[1].contact.x, 0.775, 0.02);
    EXPECT_NEAR(wheels[3].contact.z, 1.45, 0.02);
}

TEST(Vehicle, WheelsRollAndAreSteered) {
    Vehicle vehicle(car(), flat(Surface::kRoad));
    vehicle.put(0, 0, 0);
    drive(vehicle, 3, {0.4, 0, 0});
    double turned = 0;
    const VehicleState from = vehicle.state();
    VehicleState before = from, now = from;
    for (int i = 0; i < 120;
         ++i, before = now) { // two seconds, by less than a quarter of a turn a step
        vehicle.advance(Vehicle::kStep_s, {0.4, 0, 0});
        now = vehicle.state();
        const glm::dvec3 spoke = now.wheels[2].turn * glm::dvec3(0, 1, 0),
                         last = before.wheels[2].turn * glm::dvec3(0, 1, 0);
        turned += std::atan2(glm::dot(glm::cross(last, spoke), glm::dvec3(-1, 0, 0)),
                             glm::dot(last, spoke)); // the top goes ahead
        for (const WheelState& wheel : now.wheels)
            EXPECT_NEAR(wheel.hub.y - wheel.contact.y, 0.32, 0.02);
    }
    EXPECT_NEAR(turned * 0.32, from.position.z - now.position.z, 0.3);
    drive(vehicle, 1, {0, 1, 0});
    const glm::dvec3 axle = vehicle.state().wheels[1].turn * glm::dvec3(1, 0, 0),
                     rear = vehicle.state().wheels[3].turn * glm::dvec3(1, 0, 0);
    EXPECT_GT(glm::dot(glm::cross(axle, rear), glm::dvec3(0, 1, 0)), 0.1)
        << "to the right: clockwise from above";
}

TEST(VehicleMesh, BodiesHaveTheirPresetsMeasuresAndClearTheirWheels) {
    for (const char* const name : {"car", "tractor"}) {
        const VehicleSpec spec = load_vehicle(kRoot + "/vehicles/" + name + ".toml");
        const sward::scene::Mesh body = body_mesh(spec), roof = roof_mesh(spec);
        glm::dvec3 low(1e9), high(-1e9);
        for (const sward::scene::Mesh* const mesh : {&body, &roof})
            for (const glm::vec3& at : mesh->positions) {
                low = glm::min(low, glm::dvec3(at));
                high = glm::max(high, glm::dvec3(at));
            }
        EXPECT_LT(glm::length(high - low - spec.size_m), 1e-5) << name;
        EXPECT_NEAR(low.y, spec.clearance_m, 1e-5) << name;
        for (const auto& at : body.positions)
            for (const AxleSpec& axle : spec.axles) {
                const bool beside =
                    std::abs(static_cast<double>(at.x)) < axle.track_m / 2 - axle.width_m / 2;
                const glm::dvec2 away(static_cast<double>(at.y) - axle.radius_m,
                                      static_cast<double>(at.z) + axle.ahead_m);
                EXPECT_TRUE(beside || glm::length(away) > axle.radius_m)
                    << name << " " << at.x << " " << at.y << " " << at.z;
            }
        const sward::scene::Mesh wheel = wheel_mesh(spec.axles[1]);
        for (std::size_t i = 0; i < wheel.positions.size(); ++i) {
            EXPECT_LT(glm::length(glm::dvec2(wheel.positions[i].y, wheel.positions[i].z)),
                      spec.axles[1].radius_m + 1e-5);
            EXPECT_GE(glm::dot(wheel.positions[i], wheel.normals[i]), -1e-5f) << "out of the wheel";
        }
        EXPECT_EQ(body.positions.size(), body.normals.size());
    }
}

TEST(Vehicle, DrivesTwoHundredMetresTurnsAndStops) {
    Vehicle vehicle(car(), flat(Surface::kRoad));
    vehicle.put(0, 0, 0);
    drive(vehicle, 12, {1, 0, 0});
    VehicleState state = vehicle.state();
    EXPECT_LT(state.position.z, -200);
    EXPECT_NEAR(state.position.x, 0, 1) << "straight on";
    EXPECT_GT(state.speed_mps(), 20);
    EXPECT_LT(state.speed_mps(), 50);
    drive(vehicle, 1.5, {0, 1, 0});
    state = vehicle.state();
    EXPECT_GT(yaw_deg(state), 5) << "to the right";
    EXPECT_LT(yaw_deg(state), 120);
    drive(vehicle, 8, {0, 0, 1});
    state = vehicle.state();
    EXPECT_NEAR(state.speed_mps(), 0, 0.05);
    const glm::dvec3 stopped = state.position;
    drive(vehicle, 3, {-1, 0, 0});
    EXPECT_LT(vehicle.state().speed_mps(), -2) << "the same pedal drives back";
    EXPECT_GT(vehicle.state().speed_mps(), -25 / 3.6 - 0.5);
    EXPECT_GT(glm::distance(vehicle.state().position, stopped), 3);
}

TEST(Vehicle, GripIsTheSurfaces) {
    const auto braking = [](Surface surface) {
        Vehicle vehicle(car(), flat(surface));
        for (int i = 0; i < 3000 && vehicle.state().speed_mps() < 15; ++i)
            vehicle.advance(1.0 / 60, {1, 0, 0});
        EXPECT_GE(vehicle.state().speed_mps(), 15);
        const glm::dvec3 begin = vehicle.state().position;
        drive(vehicle, 15, {0, 0, 1});
        EXPECT_NEAR(vehicle.state().speed_mps(), 0, 0.1);
        return glm::distance(begin, vehicle.state().position);
    };
    const double road = braking(Surface::kRoad), grass = braking(Surface::kGrass),
                 wet = braking(Surface::kWetGrass);
    const auto no_less = [](double grip) {
        return 15 * 15 / (2 * 9.81 * (grip + 0.1));
    }; // rolling and drag help a little
    EXPECT_GT(road, no_less(0.95));
    EXPECT_LT(road, 20);
    EXPECT_GT(grass, no_less(0.6));
    EXPECT_GT(grass, road * 1.2);
    EXPECT_GT(wet, no_less(0.35));
    EXPECT_GT(wet, grass * 1.2);
}

TEST(Vehicle, EachWheelHasTheGripOfItsOwnPlace) {
    // Over a road to z = -40, and there the brake: what is beyond is `left` and `right` of x = 0.
    const auto braking_mps2 = [](Surface left, Surface right) {
        Vehicle vehicle(car(), {[](double, double) { return 0.0; },
                                [=](double x, double z) {
                                    return z > -40 ? Surface::kRoad : x < 0 ? left : right;
                                }});
        for (int i = 0; i < 3000 && vehicle.state().position.z > -42; ++i)
            vehicle.advance(1.0 / 60, {1, 0, 0});
        const double speed = vehicle.state().speed_mps();
        drive(vehicle, 0.5, {0, 0, 1});
        return (speed - glm::length(vehicle.state().velocity_mps)) / 0.5;
    };
    const double road = braking_mps2(Surface::kRoad, Surface::kRoad),
                 wet = braking_mps2(Surface::kWetGrass, Surface::kWetGrass),
                 seam = braking_mps2(Surface::kRoad, Surface::kWetGrass);
    EXPECT_NEAR(seam, (road + wet) / 2, 0.15 * (road - wet));
    // From a road into sand: what rolls by itself is held back where the sand begins.
    const DriveLand beach{
        [](double, double) { return 0.0; },
        [](double, double z) { return z > -60 ? Surface::kRoad : Surface::kSand; }};
    Vehicle vehicle(car(), beach);
    for (int i = 0; i < 3000 && vehicle.state().position.z > -59; ++i)
        vehicle.advance(1.0 / 60, {1, 0, 0});
    EXPECT_EQ(vehicle.state().wheels[2].surface, Surface::kRoad);
    EXPECT_EQ(vehicle.state().wheels[0].surface, Surface::kSand);
    drive(vehicle, 1, {});
    const double fast = vehicle.state().speed_mps();
    drive(vehicle, 1, {});
    EXPECT_NEAR(fast - vehicle.state().speed_mps(), 0.15 * 9.81, 0.4);
}

TEST(Surface, IsWhatLiesThere) {
    using sward::scene::GroundCover;
    using sward::scene::GroundKind;
    const auto bare = [](GroundKind kind) { return surface_of({true, 0, false, false, kind}); };
    EXPECT_EQ(surface_of({}), Surface::kGrass) << "beyond the terrain";
    EXPECT_EQ(surface_of({true, 0.5}), Surface::kGrass);
    EXPECT_EQ(surface_of({true, 0.5, true, true}), Surface::kWetGrass);
    EXPECT_EQ(surface_of({true, 0.01}), Surface::kSoil);
    EXPECT_EQ(bare(GroundKind::kAsphalt), Surface::kRoad);
    EXPECT_EQ(bare(GroundKind::kGravel), Surface::kSoil);
    EXPECT_EQ(bare(GroundKind::kRock), Surface::kSoil);
    EXPECT_EQ(bare(GroundKind::kSand), Surface::kSand);
    EXPECT_EQ(bare(GroundKind::kWater), Surface::kSand);
}

TEST(Vehicle, StandsOnASlopeWithoutCreeping) {
    for (const double yaw : {0.0, 45.0, 90.0}) {
        Vehicle vehicle(car(), {[](double, double z) { return -0.15 * z; }, {}});
        vehicle.put(0, 0, yaw);
        drive(vehicle, 3, {});
        const glm::dvec3 stood = vehicle.state().position;
        drive(vehicle, 30, {});
        EXPECT_LT(glm::distance(vehicle.state().position, stood), 0.05) << yaw;
        EXPECT_LT(std::abs(stood.z), 0.5);
    }
}

/// Rough land with steps, ditches and a cliff.
double rough(double x, double z) {
    return 4 * std::sin(x * 0.07) + 3 * std::cos(z * 0.11) +
           0.3 * std::sin(x * 1.7) * std::cos(z * 1.3) + (x > 40 ? -6 : 0) +
           (std::fmod(std::abs(z), 30) < 1 ? -0.8 : 0);
}

TEST(Vehicle, NeverFallsThroughAndNeverExplodesAtAnyRate) {
    for (const char* const name : {"car", "tractor"})
        for (const double rate : {1.0, 4.0, 24.0, 60.0, 144.0, 240.0}) {
            Vehicle vehicle(load_vehicle(kRoot + "/vehicles/" + name + ".toml"), {rough, {}});
            vehicle.put(3, 8, 70);
            for (int i = 0; i < static_cast<int>(40 * rate); ++i) {
                const double t = i / rate;
                vehicle.advance(1 / rate, {std::fmod(t, 9) < 7 ? 1.0 : -1.0, std::sin(t * 0.6), 0});
                const VehicleState state = vehicle.state();
                ASSERT_TRUE(
                    std::isfinite(glm::length(state.position) + glm::length(state.velocity_mps)))
                    << name << rate << " " << t;
                const glm::dvec3 middle =
                    state.position + state.turn * glm::dvec3(0, vehicle.spec().mass_height_m, 0);
                ASSERT_GT(middle.y, rough(middle.x, middle.z) - 0.35) << name << rate << " " << t;
                ASSERT_LT(glm::length(state.velocity_mps), 60) << name << rate << " " << t;
                ASSERT_LT(middle.y, rough(middle.x, middle.z) + 30) << name << rate << " " << t;
            }
        }
}

TEST(Vehicle, TheRateOfPicturesChangesNoStep) {
    const auto run = [](int pieces) { // the same sixtieth, in one piece or in several
        Vehicle vehicle(car(), {rough, {}});
        vehicle.put(3, 8, 70);
        for (int i = 0; i < 600; ++i)
            for (int k = 0; k < pieces; ++k)
                vehicle.advance(1.0 / 64 / pieces, {1, std::sin(i * 0.01), 0});
        return vehicle.state().position;
    };
    EXPECT_LT(glm::distance(run(1), run(4)), 1e-6);
}

TEST(Vehicle, FarFromTheMiddleItDrivesTheSame) {
    const auto way = [](double x0) {
        Vehicle vehicle(car(), flat(Surface::kRoad));
        vehicle.put(x0, -x0, 90);
        drive(vehicle, 15, {1, 0, 0}); // past several shifts of Bullet's origin
        return vehicle.state().position.x - x0;
    };
    EXPECT_NEAR(way(0), way(200'000), 0.5);
    EXPECT_GT(way(0), 200);
}

TEST(Vehicle, AnOverturnedOneIsPutOnItsWheels) {
    Vehicle vehicle(car(), {[](double x, double) { return x > 10 ? (x - 10) * 2.5 : 0.0; },
                            {}}); // a bank that rolls it
    vehicle.put(0, 0, 60);
    drive(vehicle, 4, {1, 0, 0});
    drive(vehicle, 20, {});
    EXPECT_GT((vehicle.state().turn * glm::dvec3(0, 1, 0)).y, 0.25);
}

TEST(VehicleSpec, WrongPresetsAreToldWithFileAndKey) {
    const std::string axles = "[front]\nahead_m = 1\ntrack_m = 1.5\nradius_m = 0.3\ndriven = "
                              "true\n[rear]\nahead_m = -1\ntrack_m = 1.5\nradius_m = 0.3\n";
    EXPECT_NO_THROW(static_cast<void>(parse_vehicle(axles, "v.toml")));
    for (const std::string& bad :
         {std::string("mass_kg = 0\n") + axles, std::string("mass = 3\n") + axles,
          std::string("grip = [1, 2, 1]\n") + axles, std::string("name = 3\n") + axles,
          std::string("= 3\n"), std::string("mass_kg = 900\n"),
          std::string("[front]\nahead_m = nan\n") + axles,
          axles.substr(0, axles.find("driven")) + axles.substr(axles.find("[rear]")),
          axles + "spring_hz = 0.5\ntravel_m = 0.05\n"})
        try {
            static_cast<void>(parse_vehicle(bad, "v.toml"));
            ADD_FAILURE() << bad;
        } catch (const sward::base::Error& error) {
            EXPECT_EQ(error.code(), sward::base::ExitCode::kBadInput) << bad;
            EXPECT_EQ(std::string(error.what()).find("v.toml"), 0u) << error.what();
        }
}

} // namespace
