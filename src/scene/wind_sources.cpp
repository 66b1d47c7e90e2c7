// SPDX-License-Identifier: Apache-2.0
#include "scene/wind_sources.h"

#include <algorithm>

#include <fmt/format.h>

#include "scene/scene_sections.h"

namespace sward::scene {
namespace {

using Kind = WindSource::Kind;

constexpr Range kSpeed{0, 300, "m/s"};
constexpr Range kRadius{0.05, 1000, "m"};
constexpr Range kExtent{0.1, 10'000, "m"};

const std::vector<std::string> kKinds = {"rotor", "jet", "wake", "cyclone", "wave", "fan"};

Kind read_kind(TableReader& table) {
    std::string kind;
    table.name("kind", kind);
    table.require("kind");
    const auto found = std::find(kKinds.begin(), kKinds.end(), kind);
    if (found != kKinds.end())
        return static_cast<Kind>(found - kKinds.begin());
    const std::string nearest = base::nearest_name(kind, kKinds);
    throw table.error("kind", fmt::format("\"{}\"", kind),
                      nearest.empty() ? fmt::format("one of {}", fmt::join(kKinds, ", "))
                                      : fmt::format("\"{}\"", nearest));
}

/// The keys of one kind; asking for a key declares it.
void read_keys(TableReader& table, WindSource& source) {
    const Kind kind = source.kind;
    table.number("strength_mps", source.strength_mps, kSpeed);
    table.number("radius_m", source.radius_m, kRadius);
    if (kind == Kind::kJet || kind == Kind::kWake || kind == Kind::kWave)
        table.number("yaw_deg", source.where.yaw_deg, kYaw);
    if (kind == Kind::kRotor || kind == Kind::kCyclone || kind == Kind::kFan)
        table.number("reach_m", source.reach_m, kExtent);
    if (kind == Kind::kJet || kind == Kind::kWake)
        table.number("length_m", source.length_m, kExtent);
    if (kind == Kind::kRotor) {
        table.number("mass_kg", source.mass_kg, {1, 1e6, "kg"});
        table.number("height_m", source.height_m, {0, 1000, "m"});
    }
    if (kind == Kind::kCyclone) {
        table.number("inflow", source.inflow, kShare);
        table.boolean("clockwise", source.clockwise);
    }
    if (kind == Kind::kWave) {
        table.number("wavelength_m", source.wavelength_m, {0.5, 10'000, "m"});
        table.number("travel_mps", source.travel_mps, kSpeed);
    }
}

void check_keys(const TableReader& table, const WindSource& source) {
    const bool moving = !source.where.path.empty();
    table.require("radius_m");
    if (source.kind == Kind::kRotor) {
        if (table.has("strength_mps") == table.has("mass_kg"))
            throw table.error("", table.has("mass_kg") ? "both" : "neither",
                              "either strength_mps or mass_kg");
        if (!moving)
            table.require("height_m");
    } else if (source.kind != Kind::kWake || !moving) {
        table.require("strength_mps");
    }
    if (source.kind == Kind::kWake)
        table.require("length_m");
    if (source.reach_m != 0 && source.reach_m <= source.radius_m)
        throw table.error("reach_m", fmt::format("{}", source.reach_m),
                          fmt::format("more than radius_m, {}", source.radius_m));
}

} // namespace

WindSource read_source(TableReader& table, const std::map<std::string, Path>& paths) {
    WindSource source;
    source.kind = read_kind(table);
    table.place("place", source.where.place);
    table.name("path", source.where.path);
    read_span(table, source.start_s, source.end_s);
    read_keys(table, source);
    table.finish();
    if (table.has("place") == table.has("path"))
        throw table.error("", table.has("path") ? "both" : "neither", "either place or path");
    check_path(table, source.where.path, paths);
    check_keys(table, source);
    check_span(table, source.start_s, source.end_s);
    return source;
}

} // namespace sward::scene
