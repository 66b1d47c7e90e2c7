// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_sections.h"

#include <algorithm>

#include <fmt/format.h>

namespace sward::scene {
namespace {

constexpr std::size_t kMostKeys = 10000;
constexpr int kMostBands = 256;

constexpr int kMostSpheres = 10000; // of one mesh

std::optional<glm::dvec2> read_pair(TableReader& table, const char* key, const Range& range) {
    std::vector<double> given;
    if (!table.numbers(key, given, {range, range}))
        return std::nullopt;
    return glm::dvec2(given[0], given[1]);
}

/// A place as [x, y, z], or on Earth as [latitude, longitude, height]; height is what y would be.
void read_place(TableReader& table, glm::dvec3& position, std::optional<glm::dvec2>& geo) {
    const bool placed = table.place("position", position);
    std::vector<double> given;
    if (!table.numbers("geo", given, {kLatitude, kLongitude, kHeight})) {
        if (placed)
            geo.reset();
        return;
    }
    if (placed)
        throw table.error("geo", "position beside it", "one of the two");
    geo = glm::dvec2(given[0], given[1]);
    position = {0, given[2], 0};
}

/// Refuses a table with neither.
void require_place(const TableReader& table) {
    if (!table.has("geo"))
        table.require("position");
}

} // namespace

void read_colour(TableReader& table, const char* key, glm::dvec3& colour) {
    table.three(key, colour, kShare);
}

void read_terrain(TableReader table, TerrainSpec& terrain) {
    table.path("elevation", terrain.elevation);
    table.integer("elevation_band", terrain.elevation_band, 1, kMostBands);
    terrain.size_m = read_pair(table, "size_m", {1, 1.2e6, "m"});
    terrain.height_m = read_pair(table, "height_m", {-2e4, 2e4, "m"});
    table.path("mask", terrain.mask);
    table.integer("mask_band", terrain.mask_band, 1, kMostBands);
    table.number("detail_m", terrain.detail_m, {0, 10, "m"});
    table.path("surface", terrain.surface);
    read_land(table, terrain);
    table.finish();
    if (terrain.elevation.empty() == terrain.surface.empty())
        throw table.error("", terrain.elevation.empty() ? "neither" : "both",
                          "either elevation or surface");
    if (terrain.height_m && terrain.height_m->x >= terrain.height_m->y)
        throw table.error("height_m",
                          fmt::format("[{}, {}]", terrain.height_m->x, terrain.height_m->y),
                          "the lower height first");
    if (!terrain.classes.empty() && !terrain.has_mask())
        throw table.error("classes", "no mask", "terrain.mask beside it");
}

void read_grass(TableReader table, GrassSpec& grass) {
    table.text("set", grass.set);
    table.number("density", grass.density, kShare);
    table.finish();
}

void read_sun(TableReader table, SunSpec& sun) {
    table.number("azimuth_deg", sun.azimuth_deg, kYaw);
    table.number("elevation_deg", sun.elevation_deg, {-90, 90, "degrees"});
    table.finish();
}

void read_air(TableReader table, AirSpec& air) {
    table.number("visibility_km", air.visibility_km, {0.1, 250, "km"});
    table.finish();
}

void read_lod(TableReader table, LodSpec& lod) {
    table.number("handover_start_m", lod.handover_start_m, {0, 1e5, "m"});
    table.number("handover_end_m", lod.handover_end_m, {0, 1e5, "m"});
    table.number("far_end_m", lod.far_end_m, {0, 1e5, "m"});
    table.finish();
    const auto rising = [&](const char* key, const std::optional<double>& low,
                            const std::optional<double>& high, const char* expected) {
        if (low && high && *low >= *high)
            throw table.error(key, fmt::format("{}", *high), fmt::format("{}, {}", expected, *low));
    };
    rising("handover_end_m", lod.handover_start_m, lod.handover_end_m,
           "more than handover_start_m");
    rising("far_end_m", lod.handover_start_m, lod.far_end_m, "more than handover_start_m");
    rising("far_end_m", lod.handover_end_m, lod.far_end_m, "more than handover_end_m");
}

Pose read_camera(TableReader table) {
    Pose pose;
    read_place(table, pose.position, pose.geo);
    table.boolean("agl", pose.agl);
    table.number("yaw_deg", pose.yaw_deg, kYaw);
    table.number("pitch_deg", pose.pitch_deg, kPitch);
    table.number("fov_deg", pose.fov_deg, kFov);
    table.finish();
    require_place(table);
    return pose;
}

Path read_path(TableReader table) {
    Path path;
    std::vector<TableReader> keys = table.tables("keys", kMostKeys);
    table.boolean("agl", path.agl);
    table.number("fov_deg", path.fov_deg, kFov);
    table.finish();
    if (keys.empty())
        throw table.error("keys", "none", "at least one { t, position, yaw_deg, pitch_deg }");
    PathKey key; // yaw and pitch that a key leaves out are those of the key before it
    for (TableReader& entry : keys) {
        const double before = key.t_s;
        entry.number("t", key.t_s, kTime);
        read_place(entry, key.position, key.geo);
        entry.number("yaw_deg", key.yaw_deg, kYaw);
        entry.number("pitch_deg", key.pitch_deg, kPitch);
        entry.finish();
        entry.require("t");
        require_place(entry);
        if (!path.keys.empty() && key.t_s <= before)
            throw entry.error("t", fmt::format("{}", key.t_s),
                              fmt::format("more than {}, the key before", before));
        path.keys.push_back(key);
    }
    return path;
}

void check_path(const TableReader& table, const std::string& path,
                const std::map<std::string, Path>& paths) {
    if (path.empty() || paths.contains(path))
        return;
    std::vector<std::string> names;
    for (const auto& [name, unused] : paths)
        names.push_back(name);
    const std::string nearest = base::nearest_name(path, names);
    throw table.error("path", fmt::format("\"{}\"", path),
                      nearest.empty() ? "the NAME of a [path.NAME]"
                                      : fmt::format("\"{}\"", nearest));
}

ObjectSpec read_object(TableReader table, const std::map<std::string, Path>& paths) {
    ObjectSpec object;
    table.word("kind", object.kind, kObjectKindNames);
    table.number("radius_m", object.radius_m, {0.01, 1000, "m"});
    table.path("mesh", object.mesh);
    read_place(table, object.position, object.geo);
    table.boolean("agl", object.agl);
    table.number("yaw_deg", object.yaw_deg, kYaw);
    table.name("path", object.path);
    read_colour(table, "colour", object.colour);
    table.boolean("collides", object.collides);
    table.integer("most_spheres", object.most_spheres, 1, kMostSpheres);
    table.finish();
    table.require("kind");
    if (object.kind == ObjectKind::kMesh)
        table.require("mesh");
    const bool placed = table.has("position") || table.has("geo");
    if (placed == table.has("path"))
        throw table.error("", placed ? "both" : "neither", "either position or path");
    if (table.has("agl") && table.has("path"))
        throw table.error("agl", "a path beside it", "agl in the path");
    check_path(table, object.path, paths);
    return object;
}

} // namespace sward::scene
