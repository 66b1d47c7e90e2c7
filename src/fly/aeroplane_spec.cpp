// SPDX-License-Identifier: Apache-2.0
#include "fly/aeroplane_spec.h"

#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "fly/motion.h"
#include "scene/toml_reader.h"

namespace sward::fly {
namespace {

using scene::Range;
using scene::TableReader;

constexpr std::uint64_t kLimit = 1u << 16; // bytes of a file

/// Signs are kept where another sign would be no aeroplane: it would turn over by itself, or away
/// from the stick.
void read_air(TableReader& table, Derivatives& air) {
    table.number("lift_zero", air.lift_zero, {-0.5, 1.5, ""});
    table.number("lift_slope", air.lift_slope, {2, 6.3, "a radian"});
    table.number("drag_zero", air.drag_zero, {0.005, 0.2, ""});
    table.number("oswald", air.oswald, {0.3, 1, ""});
    table.number("side_slip", air.side_slip, {-2, 0, "a radian"});
    table.number("pitch_zero", air.pitch_zero, {-0.3, 0.3, ""});
    table.number("pitch_slope", air.pitch_slope, {-3, -0.05, "a radian"});
    table.number("pitch_rate", air.pitch_rate, {-40, -1, ""});
    table.number("pitch_elevator", air.pitch_elevator, {-3, -0.1, "a radian"});
    table.number("roll_slip", air.roll_slip, {-0.5, 0.1, "a radian"});
    table.number("roll_rate", air.roll_rate, {-2, -0.05, ""});
    table.number("roll_yaw", air.roll_yaw, {0, 1, ""});
    table.number("roll_aileron", air.roll_aileron, {0.01, 1, "a radian"});
    table.number("yaw_slip", air.yaw_slip, {0.005, 0.5, "a radian"});
    table.number("yaw_roll", air.yaw_roll, {-0.5, 0.5, ""});
    table.number("yaw_rate", air.yaw_rate, {-1, -0.01, ""});
    table.number("yaw_rudder", air.yaw_rudder, {0.005, 0.5, "a radian"});
    table.finish();
}

} // namespace

AeroplaneSpec parse_aeroplane(const std::string& text, const std::filesystem::path& file) {
    const toml::table whole = scene::parse_toml(text, file);
    TableReader reader(whole, file, "");
    AeroplaneSpec spec;
    spec.name = file.stem().string();
    std::string kind = "aeroplane";
    reader.text("kind", kind);
    if (kind != "aeroplane")
        throw reader.error("kind", base::printable(kind), "aeroplane or helicopter");
    reader.text("name", spec.name);
    reader.number("mass_kg", spec.mass_kg, {50, 20'000, "kg"});
    reader.three("inertia_kgm2", spec.inertia_kgm2, {10, 1e6, "kg m2"});
    reader.number("wing_m2", spec.wing_m2, {2, 200, "m2"});
    reader.number("span_m", spec.span_m, {2, 60, "m"});
    reader.number("chord_m", spec.chord_m, {0.2, 10, "m"});
    reader.number("stall_deg", spec.stall_deg, {8, 30, "degrees"});
    reader.number("power_kw", spec.power_kw, {1, 5000, "kW"});
    reader.number("propeller", spec.propeller, {0.1, 1, ""});
    reader.number("static_pull_kn", spec.static_pull_kn, {0.05, 100, "kN"});
    reader.number("propeller_m", spec.propeller_m, {0.2, 8, "m"});
    reader.three("throw_deg", spec.throw_deg, {1, 45, "degrees"});
    reader.number("cruise_mps", spec.cruise_mps, {10, 200, "m/s"});
    reader.number("gear_m", spec.gear_m, {0.2, 5, "m"});
    reader.number("gear_track_m", spec.gear_track_m, {0.5, 15, "m"});
    reader.number("gear_ahead_m", spec.gear_ahead_m, {0.3, 15, "m"});
    reader.number("gear_back_m", spec.gear_back_m, {0.05, 5, "m"});
    reader.number("length_m", spec.length_m, {2, 60, "m"});
    reader.three("eye_m", spec.eye_m, {-10, 10, "m"});
    if (std::optional<TableReader> air = reader.table("air"))
        read_air(*air, spec.air);
    reader.finish();
    const double lift =
        2 * spec.mass_kg * kGravity / (kAir * spec.wing_m2 * spec.cruise_mps * spec.cruise_mps);
    const double most = spec.air.lift_zero + spec.air.lift_slope * spec.stall_deg * kDegree;
    if (lift > 0.8 * most)
        throw reader.error(
            "cruise_mps",
            fmt::format("{} m/s, at which the wing needs a lift coefficient of {:.2f}",
                        spec.cruise_mps, lift),
            fmt::format("one below {:.2f}: faster, lighter, or more wing", 0.8 * most));
    return spec;
}

AeroplaneSpec load_aeroplane(const std::filesystem::path& file) {
    return parse_aeroplane(base::read_text(file, kLimit), file);
}

} // namespace sward::fly
