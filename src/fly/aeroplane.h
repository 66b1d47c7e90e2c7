// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "fly/aeroplane_spec.h"
#include "fly/motion.h"

namespace sward::fly {

/// What the pilot does, -1 to 1.
struct Stick {
    double roll = 0;     ///< 1 right
    double pitch = 0;    ///< 1 nose up, from the trim
    double yaw = 0;      ///< 1 right pedal
    double throttle = 0; ///< 0 to 1
    double brake = 0;    ///< 0 to 1, main wheels
};

struct AeroplaneState : AircraftState {
    double pull_n = 0;                   ///< of the propeller
    double attack_rad = 0, slip_rad = 0; ///< angle of attack; wind from the right
    bool stalled = false;
};

/// Six degrees of freedom at a fixed step, whatever the pictures' rate: lift with stall, induced
/// drag with ground effect, moments by derivatives, a propeller of constant power, three sprung
/// wheels. What hits the ground with more than its wheels, or too hard, has crashed: some seconds
/// later it is where it began. Throws nothing after construction.
class Aeroplane : private Motion<AeroplaneState> {
public:
    Aeroplane(const AeroplaneSpec& spec, FlyLand land);

    /// On its wheels at world x, z, engine idle.
    void put_on_ground(double x, double z, double yaw_deg);
    /// In level flight at its cruising speed, trimmed.
    void put_in_air(const glm::dvec3& position, double yaw_deg);
    /// The throttle at which it flies level at cruising speed, 0 to 1.
    [[nodiscard]] double cruise_throttle() const { return cruise_throttle_; }
    void advance(double dt_s, const Stick& stick);
    [[nodiscard]] AeroplaneState state() const { return shown(); }
    [[nodiscard]] const AeroplaneSpec& spec() const { return spec_; }

private:
    struct Sum {
        glm::dvec3 force{0};  ///< world (N)
        glm::dvec3 moment{0}; ///< about roll, pitch, yaw (N m)
    };
    struct Wheel {
        glm::dvec3 foot{0}; ///< where its tyre ends hanging free, in the aeroplane's frame
        double load_n = 0, steer = 0;
        bool braked = false;
    };

    void trim();
    void step(const Stick& stick);
    void add_air(const Stick& stick, Sum& sum);
    void add_wheels(const Stick& stick, Sum& sum);
    [[nodiscard]] bool hits() const;

    AeroplaneSpec spec_;
    FlyLand land_;
    std::array<Wheel, 3> wheels_;
    double trim_elevator_ = 0, trim_attack_ = 0, cruise_throttle_ = 0; ///< rad, rad, 0 to 1
};

} // namespace sward::fly
