// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sward::scene {

inline constexpr double kForever = std::numeric_limits<double>::infinity();

/// An arrow that pushes the fluid at its tip (methods.md W5); arrows chained by `parent` start in
/// sequence from the root.
struct WindArrow {
    std::string id, parent;
    glm::dvec2 root{0, 0}, tip{0, 0};
    double strength_mps = 0; ///< speed that the push brings the air to
    double radius_m = 1;
    double start_s = 0; ///< not before; a child also waits for its parent's gust
    double end_s = kForever;
    bool operator==(const WindArrow&) const = default;
};

/// Where a source or obstacle is: at `place`, or carried by a path, `place` and `yaw_deg` then
/// relative to it.
struct WindPlace {
    glm::dvec2 place{0, 0};
    double yaw_deg = 0;
    std::string path; ///< name of a [path.*], or empty
};

/// An analytic source (methods.md J4, C5). Which fields count depends on the kind: docs/scene.md
/// has the table.
struct WindSource {
    enum class Kind { kRotor, kJet, kWake, kCyclone, kWave, kFan } kind = Kind::kFan;
    WindPlace where;
    std::optional<double> strength_mps; ///< rotor: by mass_kg; wake: by its path
    double radius_m = 1;
    double reach_m = 0;             ///< where it has died away; 0: by the kind
    std::optional<double> mass_kg;  ///< rotor: what it carries
    std::optional<double> height_m; ///< rotor: disc above the ground; unset: by its path
    double length_m = 0;      ///< jet: of the driven core, 0: 4 radii; wake: behind the vehicle
    double wavelength_m = 20; ///< wave
    std::optional<double> travel_mps; ///< wave: how fast its crests run; unset: strength_mps
    double inflow = 0.2;              ///< cyclone: radial speed over tangential
    bool clockwise = false;           ///< cyclone, seen from above
    double start_s = 0, end_s = kForever;
};

/// One that a host moves: at `source.where.place` at `time_s`, and on a straight line before and
/// after it.
struct MovingWindSource {
    WindSource source;
    glm::dvec2 velocity_mps{0, 0};
    double time_s = 0;
};

struct WindObstacle {
    enum class Kind { kBox, kCircle, kMesh } kind = Kind::kCircle;
    WindPlace where;
    glm::dvec2 size{
        1, 1}; ///< box: width along its own x, depth along its own z; circle: radius, unused
    std::filesystem::path mesh; ///< resolved against the scene's directory
    double height_m = 0.5;      ///< mesh: where it is cut, above its own origin
};

struct WindSpec {
    double speed_mps = 4;
    double direction_deg = 270; ///< where the wind comes from, as in aviation
    double gust = 0.4;          ///< 0 steady .. 1 violent
    int seed = 7;
    int cells = 1000;
    int moving_cells = 256; ///< while nothing is local but what a host moves; at most `cells`
    double cell_m = 0.5;
    double step_s = 1.0 / 60.0;
    double confinement = 0.3;
    double viscosity_m2s = 0;
    double dissipation_per_s = 0;
    std::vector<WindArrow> arrows;
    std::vector<WindSource> sources;
    std::vector<WindObstacle> obstacles;
};

} // namespace sward::scene
