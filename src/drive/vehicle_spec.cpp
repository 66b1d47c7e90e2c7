// SPDX-License-Identifier: Apache-2.0
#include "drive/vehicle_spec.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "base/file.h"
#include "scene/toml_reader.h"

namespace sward::drive {
namespace {

namespace fs = std::filesystem;
using scene::Range;
using scene::TableReader;

constexpr std::uint64_t kFileLimit = 1u << 16;
constexpr double kGravity = 9.81, kTurn = 6.283185307;

AxleSpec read_axle(TableReader table) {
    AxleSpec axle;
    table.number("ahead_m", axle.ahead_m, {-20, 20, "m"});
    table.number("track_m", axle.track_m, {0.3, 10, "m"});
    table.number("radius_m", axle.radius_m, {0.1, 2, "m"});
    table.number("width_m", axle.width_m, {0.02, 2, "m"});
    table.number("travel_m", axle.travel_m, {0.02, 1, "m"});
    table.number("spring_hz", axle.spring_hz, {0.5, 5, "Hz"});
    table.number("damping", axle.damping, {0.05, 1, ""});
    table.number("steer_deg", axle.steer_deg, {0, 60, "degrees"});
    table.boolean("driven", axle.driven);
    table.finish();
    for (const char* const key : {"ahead_m", "track_m", "radius_m"})
        table.require(key);
    return axle;
}

void read_surfaces(TableReader& table, const char* key, std::array<double, kSurfaces>& values,
                   const Range& range) {
    std::vector<double> read;
    if (table.numbers(key, read, std::vector<Range>(kSurfaces, range)))
        std::copy_n(read.begin(), kSurfaces, values.begin());
}

} // namespace

VehicleSpec parse_vehicle(const std::string& text, const fs::path& file) {
    const toml::table whole = scene::parse_toml(text, file);
    TableReader reader(whole, file, "");
    VehicleSpec spec;
    spec.name = file.stem().string();
    reader.text("name", spec.name);
    reader.number("mass_kg", spec.mass_kg, {50, 100'000, "kg"});
    reader.three("size_m", spec.size_m, {0.2, 20, "m"});
    reader.number("clearance_m", spec.clearance_m, {0.02, 2, "m"});
    reader.number("mass_height_m", spec.mass_height_m, {0.05, 5, "m"});
    reader.number("power_kw", spec.power_kw, {0.1, 5000, "kW"});
    reader.number("pull_kn", spec.pull_kn, {0.05, 1000, "kN"});
    reader.number("reverse_kmh", spec.reverse_kmh, {1, 100, "km/h"});
    reader.number("top_kmh", spec.top_kmh, {1, 400, "km/h"});
    reader.number("brake_kn", spec.brake_kn, {0.1, 1000, "kN"});
    reader.number("drag_m2", spec.drag_m2, {0, 20, "m2"});
    read_surfaces(reader, "grip", spec.grip, {0.02, 2, ""});
    read_surfaces(reader, "rolling", spec.rolling, {0, 0.5, ""});
    reader.three("eye_m", spec.eye_m, {-10, 10, "m"});
    auto front = reader.table("front"), rear = reader.table("rear");
    reader.finish();
    reader.require("front");
    reader.require("rear");
    spec.axles = {read_axle(*front), read_axle(*rear)};
    for (const AxleSpec& axle : spec.axles)
        if (const double sag = kGravity / (kTurn * axle.spring_hz * kTurn * axle.spring_hz);
            sag > 0.8 * axle.travel_m)
            throw reader.error("travel_m",
                               fmt::format("springs that give {:.2f} m under the body of {:.2f} m",
                                           sag, axle.travel_m),
                               "a fifth of the travel left, or a higher spring_hz");
    if (!(spec.axles[0].ahead_m > 0) || !(spec.axles[1].ahead_m < 0))
        throw reader.error("front", "axles on one side of the centre of mass",
                           "front.ahead_m above 0, rear.ahead_m below 0");
    if (!spec.axles[0].driven && !spec.axles[1].driven)
        throw reader.error("front", "no axle that is driven",
                           "driven = true in front, rear or both");
    return spec;
}

VehicleSpec load_vehicle(const fs::path& file) {
    return parse_vehicle(base::read_text(file, kFileLimit), file);
}

} // namespace sward::drive
