// SPDX-License-Identifier: Apache-2.0
#include "fly/helicopter_spec.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "fly/motion.h"
#include "scene/toml_reader.h"

namespace sward::fly {
namespace {

using scene::TableReader;

constexpr std::uint64_t kLimit = 1u << 16; // bytes of a file
constexpr double kRoom = 1.1;              // of the power that hovering takes

void read_rotor(TableReader& table, RotorSpec& rotor) {
    table.number("radius_m", rotor.radius_m, {0.5, 20, "m"});
    table.number("chord_m", rotor.chord_m, {0.02, 2, "m"});
    double blades = rotor.blades;
    table.number("blades", blades, {2, 8, ""});
    if (blades != std::floor(blades))
        throw table.error("blades", fmt::format("{}", blades), "a whole number");
    rotor.blades = static_cast<int>(blades);
    table.number("tip_mps", rotor.tip_mps, {80, 260, "m/s"});
    table.number("lift_slope", rotor.lift_slope, {3, 6.3, "a radian"});
    table.number("profile_drag", rotor.profile_drag, {0.005, 0.05, ""});
    table.number("inertia_kgm2", rotor.inertia_kgm2, {0.5, 1e5, "kg m2"});
    table.number("collective_least_deg", rotor.collective_deg.x, {-5, 10, "degrees"});
    table.number("collective_most_deg", rotor.collective_deg.y, {5, 30, "degrees"});
    table.finish();
    if (rotor.collective_deg.y < rotor.collective_deg.x + 2)
        throw table.error("collective_most_deg", fmt::format("{}", rotor.collective_deg.y),
                          "2 degrees more than collective_least_deg, or more");
}

void read_help(TableReader& table, HelicopterHelp& help) {
    table.number("attitude_per_s", help.attitude_per_s, {0, 6, "1/s"});
    table.number("lean_deg", help.lean_deg, {5, 60, "degrees"});
    table.number("turn_per_s", help.turn_per_s, {0, 10, "1/s"});
    table.number("turn_deg_per_s", help.turn_deg_per_s, {5, 180, "degrees/s"});
    table.number("torque", help.torque, {0, 1, ""});
    table.number("stand_per_s", help.stand_per_s, {0, 1, "1/s"});
    table.number("rotor", help.rotor, {0, 1, ""});
    table.number("height_per_s", help.height_per_s, {0, 4, "1/s"});
    table.finish();
}

void read_body(TableReader& reader, HelicopterSpec& spec) {
    reader.text("name", spec.name);
    reader.number("mass_kg", spec.mass_kg, {50, 30'000, "kg"});
    reader.three("inertia_kgm2", spec.inertia_kgm2, {10, 1e6, "kg m2"});
    reader.number("hub_m", spec.hub_m, {0.2, 5, "m"});
    reader.number("hub_knm", spec.hub_knm, {0, 500, "kN m"});
    reader.number("lock", spec.lock, {1, 20, ""});
    reader.number("cyclic_deg", spec.cyclic_deg, {2, 20, "degrees"});
    reader.number("power_kw", spec.power_kw, {5, 10'000, "kW"});
    reader.number("transmission", spec.transmission, {0.5, 1, ""});
    reader.number("tail_m", spec.tail_m, {1, 20, "m"});
    reader.number("tail_kn", spec.tail_kn, {0.05, 50, "kN"});
    reader.number("fin_m2", spec.fin_m2, {0, 10, "m2"});
    reader.number("tailplane_m2", spec.tailplane_m2, {0, 10, "m2"});
    reader.three("flat_m2", spec.flat_m2, {0.05, 100, "m2"});
    reader.number("skid_m", spec.skid_m, {0.3, 5, "m"});
    reader.number("skid_track_m", spec.skid_track_m, {0.5, 8, "m"});
    reader.number("skid_length_m", spec.skid_length_m, {0.5, 12, "m"});
    reader.number("length_m", spec.length_m, {2, 40, "m"});
    reader.three("eye_m", spec.eye_m, {-10, 10, "m"});
}

/// A machine that cannot lift itself is no preset.
void check_hover(const TableReader& reader, const HelicopterSpec& spec) {
    const double weight = spec.mass_kg * kGravity;
    const Rotor rotor(spec.rotor);
    const double profile = spec.rotor.solidity() * spec.rotor.profile_drag / 8 * kAir *
                           spec.rotor.area_m2() * std::pow(spec.rotor.tip_mps, 3);
    const double takes_kw = (1.15 * weight * rotor.hover_inflow_mps(weight) + profile) / 1000;
    if (takes_kw * kRoom > spec.power_kw * spec.transmission)
        throw reader.error("power_kw", fmt::format("{} kW", spec.power_kw),
                           fmt::format("{:.0f} kW or more: a hover takes {:.0f} of the rotor",
                                       takes_kw * kRoom / spec.transmission, takes_kw));
    const double blade_deg = rotor.hover_blade_rad(weight) / kDegree;
    if (!(blade_deg > spec.rotor.collective_deg.x && blade_deg < spec.rotor.collective_deg.y - 1))
        throw reader.error(
            "rotor",
            fmt::format("blades from {} to {} degrees", spec.rotor.collective_deg.x,
                        spec.rotor.collective_deg.y),
            fmt::format("the {:.1f} of a hover between them, and a degree more", blade_deg));
}

} // namespace

HelicopterSpec parse_helicopter(const std::string& text, const std::filesystem::path& file) {
    const toml::table whole = scene::parse_toml(text, file);
    TableReader reader(whole, file, "");
    HelicopterSpec spec;
    spec.name = file.stem().string();
    std::string kind = "helicopter";
    reader.text("kind", kind);
    if (kind != "helicopter")
        throw reader.error("kind", base::printable(kind), "helicopter");
    read_body(reader, spec);
    if (std::optional<TableReader> rotor = reader.table("rotor"))
        read_rotor(*rotor, spec.rotor);
    if (std::optional<TableReader> help = reader.table("help"))
        read_help(*help, spec.help);
    reader.finish();
    check_hover(reader, spec);
    return spec;
}

AircraftSpec load_aircraft(const std::filesystem::path& file) {
    const std::string text = base::read_text(file, kLimit);
    const toml::table whole = scene::parse_toml(text, file);
    if (whole["kind"].value_or(std::string()) == "helicopter")
        return parse_helicopter(text, file);
    return parse_aeroplane(text, file);
}

} // namespace sward::fly
