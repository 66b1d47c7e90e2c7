// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "fly/aeroplane.h"
#include "fly/helicopter_spec.h"

namespace sward::fly {

/// What the pilot does.
struct HelicopterStick {
    double roll = 0;  ///< 1 right
    double pitch = 0; ///< 1 nose up
    double yaw = 0;   ///< 1 right pedal
    double lever = 0; ///< collective, 0 to 1
    bool engine = true;
};

struct HelicopterState {
    glm::dvec3 position{0};      ///< of the centre of mass
    glm::dquat turn{1, 0, 0, 0}; ///< of its frame (x right, y up, z behind) in the world
    glm::dvec3 velocity_mps{0};  ///< over the ground
    glm::dvec3 rates{0};         ///< roll, pitch, yaw (rad/s): right side down, nose up, nose right
    double airspeed_mps = 0;
    double thrust_n = 0, inflow_mps = 0;  ///< of the rotor; that it drives through its disc
    double engine_w = 0;                  ///< that it gives to the rotor
    double rotor_share = 1;               ///< of its proper speed
    double rotor_rad = 0;                 ///< how far it has turned
    double tilt_back = 0, tilt_right = 0; ///< of its disc (rad)
    bool on_ground = false, crashed = false;
    [[nodiscard]] glm::dvec3 ahead() const { return turn * glm::dvec3(0, 0, -1); }
};

/// A helicopter at a fixed step, whatever the pictures' rate: a rotor of blade elements and
/// momentum whose disc tilts by stick, speed and turning, a tail rotor against its torque, a body
/// with drag, fin and tailplane, skids. What hits the ground with more than its skids, or too hard,
/// has crashed: some seconds later it is where it began. Throws nothing after construction.
class Helicopter {
public:
    static constexpr double kStep_s = 1.0 / 240;
    static constexpr double kMost_s = 0.25; ///< in one call

    Helicopter(const HelicopterSpec& spec, FlyLand land);

    /// On its skids at world x, z, lever down, rotor at its speed.
    void put_on_ground(double x, double z, double yaw_deg);
    /// In a hover over the ground.
    void put_in_air(const glm::dvec3& position, double yaw_deg);
    /// The lever at which it hovers far from the ground, 0 to 1.
    [[nodiscard]] double hover_lever() const;
    void advance(double dt_s, const HelicopterStick& stick);
    [[nodiscard]] HelicopterState state() const;
    [[nodiscard]] const HelicopterSpec& spec() const { return spec_; }

private:
    struct Sum {
        glm::dvec3 force{0};  ///< its own frame (N)
        glm::dvec3 moment{0}; ///< about roll, pitch, yaw (N m)
    };

    void step(const HelicopterStick& stick);
    [[nodiscard]] glm::dvec3 through_air() const;
    [[nodiscard]] double standing_share(const HelicopterStick& stick) const;
    [[nodiscard]] glm::dvec2 wanted_lean(const HelicopterStick& stick) const;
    [[nodiscard]] glm::dvec2 cyclic(const HelicopterStick& stick, const glm::dvec2& blown) const;
    [[nodiscard]] double wanted_rate(const HelicopterStick& stick, const glm::dvec3& through) const;
    [[nodiscard]] double blade_rad(const HelicopterStick& stick) const;
    void add_rotor(const HelicopterStick& stick, const glm::dvec3& through, Sum& sum);
    void add_tail(const HelicopterStick& stick, const glm::dvec3& through, Sum& sum);
    void add_body(const glm::dvec3& through, Sum& sum) const;
    void add_skids(Sum& sum);
    void turn_by(const glm::dvec3& moment);
    [[nodiscard]] bool hits() const;
    void begin_again();

    HelicopterSpec spec_;
    FlyLand land_;
    Rotor rotor_;
    HelicopterState before_, now_, start_;
    double owed_s_ = 0, crashed_s_ = 0;
    double hover_torque_ = 0; ///< N m
    double tail_n_ = 0;       ///< what the tail pushes to the right, and the machine leans against
};

} // namespace sward::fly
