// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "drive/vehicle_spec.h"

namespace sward::drive {

/// The land that is driven on, world metres.
struct DriveLand {
    std::function<double(double x, double z)> height;
    std::function<Surface(double x, double z)> surface; ///< null: grass
};

/// What the driver does.
struct Pedals {
    double drive = 0; ///< 1 full throttle, -1 brakes, and drives backwards once it stands
    double steer = 0; ///< -1 left, 1 right
    double brake = 0; ///< 0 to 1: all wheels, as a hand brake
    [[nodiscard]] bool idle() const { return drive == 0 && brake == 0; }
};

struct WheelState {
    bool touches = false;
    glm::dvec3 contact{0};             ///< on the ground, where it touches
    Surface surface = Surface::kGrass; ///< that it stands on, or stood on last
    double load_n = 0;
    glm::dvec3 hub{0}; ///< its middle
    glm::dquat turn{1, 0, 0,
                    0}; ///< of its frame (axle along x) in the world: steered, and rolled on
};

struct VehicleState {
    glm::dvec3 position{0}; ///< under the centre of mass where the wheels stand on level ground
    glm::dquat turn{1, 0, 0, 0}; ///< of the vehicle's frame (x right, y up, z behind) in the world
    glm::dvec3 velocity_mps{0};
    std::array<WheelState, 4> wheels{}; ///< front left, front right, rear left, rear right
    [[nodiscard]] glm::dvec3 ahead() const { return turn * glm::dvec3(0, 0, -1); }
    [[nodiscard]] double speed_mps() const { return glm::dot(velocity_mps, ahead()); } ///< forward
};

/// A vehicle on the ground that is drawn: Bullet's raycast vehicle, a spring a wheel, at a fixed
/// step. It is where it is whatever the pictures' rate: state() is between its last two steps. Left
/// alone it comes to rest, and stays. Throws nothing after construction.
class Vehicle {
public:
    static constexpr double kStep_s = 1.0 / 120;
    static constexpr double kMost_s = 0.25; ///< in one call: a stopped program must not leap

    Vehicle(const VehicleSpec& spec, DriveLand land);
    ~Vehicle();
    Vehicle(const Vehicle&) = delete;
    Vehicle& operator=(const Vehicle&) = delete;

    /// Puts it on its wheels at world x, z.
    void put(double x, double z, double yaw_deg);
    void advance(double dt_s, const Pedals& pedals);
    [[nodiscard]] VehicleState state() const;
    [[nodiscard]] const VehicleSpec& spec() const;

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

} // namespace sward::drive
