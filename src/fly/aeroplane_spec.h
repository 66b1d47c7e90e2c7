// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include <glm/glm.hpp>

namespace sward::fly {

/// Linear coefficients of an aeroplane about its centre of mass, per radian, rates made
/// dimensionless by span (roll, yaw) or chord (pitch) over twice the airspeed: the derivatives of
/// the textbooks (Stevens and Lewis, "Aircraft Control and Simulation"; Roskam, "Airplane Flight
/// Dynamics").
struct Derivatives {
    double lift_zero = 0.31, lift_slope = 4.4; ///< CL at no angle of attack; over the angle
    double drag_zero = 0.03, oswald = 0.75;    ///< CD without lift; efficiency of the span
    double side_slip = -0.39;                  ///< CY over sideslip
    double pitch_zero = 0.04, pitch_slope = -0.61, pitch_rate = -12.4,
           pitch_elevator = -1.1;                                                       ///< Cm
    double roll_slip = -0.092, roll_rate = -0.48, roll_yaw = 0.08, roll_aileron = 0.18; ///< Cl
    double yaw_slip = 0.059, yaw_roll = -0.028, yaw_rate = -0.094, yaw_rudder = 0.066;  ///< Cn
};

/// A light aeroplane with one propeller and three wheels (TOML, docs/simulator.md). Its frame is a
/// vehicle's: x right, y up, z behind.
struct AeroplaneSpec {
    std::string name;
    double mass_kg = 1043;
    glm::dvec3 inertia_kgm2{1285, 1825, 2667}; ///< about the axes of roll, pitch, yaw
    double wing_m2 = 16.2, span_m = 10.9, chord_m = 1.49;
    double stall_deg = 16;                   ///< angle of attack at which the flow leaves the wing
    double power_kw = 120, propeller = 0.75; ///< of the engine; share of it that pulls
    double static_pull_kn = 2.4;             ///< standing: the propeller's most
    glm::dvec3 throw_deg{20, 25, 20};        ///< ailerons, elevator, rudder at full stick
    double propeller_m = 1.9;                ///< across
    double cruise_mps = 50;                  ///< what it is trimmed for
    double gear_m = 1.15;                    ///< centre of mass over the ground, standing
    double gear_track_m = 2.5, gear_ahead_m = 1.3,
           gear_back_m =
               0.35; ///< main wheels apart; nose wheel ahead, main wheels behind the centre of mass
    double length_m = 8.2;
    glm::dvec3 eye_m{-0.25, 0.65, 0.1}; ///< the pilot's, from the centre of mass
    Derivatives air;
};

/// Reads a preset. Throws base::Error with file, line and key.
[[nodiscard]] AeroplaneSpec load_aeroplane(const std::filesystem::path& file);
/// The same from a text; `file` names it in messages.
[[nodiscard]] AeroplaneSpec parse_aeroplane(const std::string& text,
                                            const std::filesystem::path& file);

} // namespace sward::fly
