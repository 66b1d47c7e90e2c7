// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "fly/helicopter_spec.h"
#include "fly/motion.h"

namespace sward::fly {

/// What the pilot does.
struct HelicopterStick {
    double roll = 0;  ///< 1 right
    double pitch = 0; ///< 1 nose up
    double yaw = 0;   ///< 1 right pedal
    double lever = 0; ///< collective, 0 to 1
    bool engine = true;
};

struct HelicopterState : AircraftState {
    double thrust_n = 0, inflow_mps = 0;  ///< of the rotor; that it drives through its disc
    double engine_w = 0;                  ///< that it gives to the rotor
    double rotor_share = 1;               ///< of its proper speed
    double rotor_rad = 0;                 ///< how far it has turned
    double tilt_back = 0, tilt_right = 0; ///< of its disc (rad)
};

/// A helicopter at a fixed step, whatever the pictures' rate: a rotor of blade elements and
/// momentum whose disc tilts by stick, speed and turning, a tail rotor against its torque, a body
/// with drag, fin and tailplane, skids. What hits the ground with more than its skids, or too hard,
/// has crashed: some seconds later it is where it began. Throws nothing after construction.
class Helicopter : private Motion<HelicopterState> {
public:
    Helicopter(const HelicopterSpec& spec, FlyLand land);

    /// On its skids at world x, z, lever down, rotor at its speed.
    void put_on_ground(double x, double z, double yaw_deg);
    /// In a hover over the ground.
    void put_in_air(const glm::dvec3& position, double yaw_deg);
    /// The lever at which it hovers far from the ground, 0 to 1.
    [[nodiscard]] double hover_lever() const;
    void advance(double dt_s, const HelicopterStick& stick);
    [[nodiscard]] HelicopterState state() const { return shown(); }
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
    [[nodiscard]] bool hits() const;
    void begin_again();

    HelicopterSpec spec_;
    FlyLand land_;
    Rotor rotor_;
    double hover_torque_ = 0; ///< N m
    double tail_n_ = 0;       ///< what the tail pushes to the right, and the machine leans against
};

} // namespace sward::fly
