// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include <glm/glm.hpp>

#include "fly/aeroplane_spec.h"
#include "fly/rotor.h"

namespace sward::fly {

/// What stands for the hands of a pilot who has years, where the hands are on a keyboard. With all
/// of it 0 the stick is the blades' angle and nothing else.
struct HelicopterHelp {
    double attitude_per_s = 2;  ///< how fast it goes to the attitude that the stick asks for, and
                                ///< stays there
    double lean_deg = 30;       ///< that attitude, stick to the stop
    double turn_per_s = 3;      ///< how fast the nose goes to the rate that the pedals ask for
    double turn_deg_per_s = 60; ///< that rate, pedal to the stop
    double torque = 0.9;        ///< share of the rotor's torque that the tail takes by itself
    double stand_per_s = 0.4;   ///< how fast it comes to stand over a place, hands off and slow
    double rotor = 1;           ///< share of the lever that is taken back as the rotor slows
    double height_per_s = 1.5;  ///< how fast it stops to rise or sink, where that is slow
};

/// A helicopter with one main rotor, that turns against the clock seen from above, a tail rotor and
/// skids (TOML, docs/simulator.md). Its frame is an aeroplane's.
struct HelicopterSpec {
    std::string name;
    double mass_kg = 1100;
    glm::dvec3 inertia_kgm2{900, 2300, 1900}; ///< about the axes of roll, pitch, yaw
    RotorSpec rotor;
    double hub_m = 1.5;         ///< over the centre of mass
    double hub_knm = 10;        ///< moment of the hub a radian of the disc's tilt
    double lock = 8;            ///< of the blades: how fast they follow
    double cyclic_deg = 9;      ///< of the disc, at full stick
    double power_kw = 165;      ///< of the engine
    double transmission = 0.92; ///< share of it that comes to the rotor; the tail takes the rest
    double tail_m = 5.9;        ///< tail rotor behind the centre of mass
    double tail_kn = 1.2;       ///< that it pushes at most
    double fin_m2 = 0.4, tailplane_m2 = 0.35;
    glm::dvec3 flat_m2{3.5, 4, 1.1}; ///< drag area from the side, from above, from ahead
    double skid_m = 1.4;             ///< centre of mass over the ground, standing
    double skid_track_m = 2.0, skid_length_m = 2.6;
    double length_m = 8.9;             ///< of the body
    glm::dvec3 eye_m{0.3, 0.25, -0.7}; ///< the pilot's, from the centre of mass
    HelicopterHelp help;
};

/// Reads a preset. Throws base::Error with file, line and key.
[[nodiscard]] HelicopterSpec parse_helicopter(const std::string& text,
                                              const std::filesystem::path& file);

using AircraftSpec = std::variant<AeroplaneSpec, HelicopterSpec>;
/// Reads a preset of either kind, by its `kind`: "aeroplane", which it is without, or "helicopter".
/// Throws likewise.
[[nodiscard]] AircraftSpec load_aircraft(const std::filesystem::path& file);

} // namespace sward::fly
