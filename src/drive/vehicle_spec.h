// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include <glm/glm.hpp>

#include "drive/surface.h"

namespace sward::drive {

/// An axle: two wheels alike, left and right of the middle.
struct AxleSpec {
    double ahead_m = 0;   ///< of the centre of mass; behind it below 0
    double track_m = 1.5; ///< from wheel to wheel
    double radius_m = 0.32, width_m = 0.2;
    double travel_m = 0.3;  ///< of the spring, from the wheel hanging free to the wheel home
    double spring_hz = 1.6; ///< of the body on its springs
    double damping = 0.4;   ///< share of the critical one
    double steer_deg = 0;   ///< to each side, at a standstill
    bool driven = false;
};

/// A vehicle with two axles (TOML, docs/simulator.md). Right-handed as the world: x right, y up, z
/// behind.
struct VehicleSpec {
    std::string name;
    double mass_kg = 1300;
    glm::dvec3 size_m{1.8, 1.4, 4.3};  ///< of the body: width, height, length
    double clearance_m = 0.16;         ///< under the body, standing
    double mass_height_m = 0.55;       ///< of the centre of mass over the ground, standing
    double power_kw = 90, pull_kn = 6; ///< of the engine; of its wheels at most
    double reverse_kmh = 25, top_kmh = 180;
    double brake_kn = 12;
    double drag_m2 = 0.7; ///< area times coefficient
    /// Of the tyres over their load, by Surface: grip, and what holds a rolling wheel back.
    std::array<double, kSurfaces> grip{0.6, 0.35, 0.95, 0.62, 0.45};
    std::array<double, kSurfaces> rolling{0.06, 0.09, 0.012, 0.035, 0.15};
    std::array<AxleSpec, 2> axles{}; ///< front, rear
    glm::dvec3 eye_m{-0.35, 1.15,
                     0.2}; ///< the driver's, from the middle of the vehicle on the ground
};

/// Reads a preset. Throws base::Error with file, line and key.
[[nodiscard]] VehicleSpec load_vehicle(const std::filesystem::path& file);
/// The same from a text; `file` names it in messages.
[[nodiscard]] VehicleSpec parse_vehicle(const std::string& text, const std::filesystem::path& file);

} // namespace sward::drive
