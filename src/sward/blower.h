// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec2.hpp>

namespace sward {

/// Something of the host's that moves the air as it goes (docs/wind.md).
struct Blower {
    enum class Kind {
        kRotor, ///< overhead: its downwash spreads over the ground
        kWake,  ///< air that a vehicle drags along behind it
        kJet,   ///< a strip of driven air: a propeller's
    };
    Kind kind = Kind::kWake;
    glm::dvec2 place{
        0}; ///< world x, z (m): under the hub; the vehicle's end; the strip's beginning
    glm::dvec2 velocity{0}; ///< of the place (m/s)
    double yaw_deg = 0;     ///< kWake: where the vehicle goes; kJet: where the air goes
    /// 0 to 300: of the downwash far below a rotor; what the air is brought to behind the others.
    double speed_mps = 0;
    double radius_m = 1; ///< of the disc; half the width of the others; 0.05 to 1000
    double height_m = 0; ///< kRotor: of the disc over the ground, 0 or more
    double length_m = 1; ///< kWake, kJet: 0.1 to 10,000
};

} // namespace sward
