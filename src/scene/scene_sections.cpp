// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_sections.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace sward::scene {
namespace {

constexpr std::size_t kMostArrows = 1024;
constexpr std::size_t kMostObstacles = 4096;
constexpr std::size_t kMostKeys = 10000;
constexpr int kHighestClass = 65535; // 16-bit landcover

const std::vector<std::string> kObjectKinds = {"sphere", "mesh", "vehicle", "rotor"};

std::optional<glm::dvec2> read_pair(TableReader& table, const char* key, const Range& range) {
    std::vector<double> given;
    if (!table.numbers(key, given, {range, range}))
        return std::nullopt;
    return glm::dvec2(given[0], given[1]);
}

WindArrow read_arrow(TableReader& table) {
    WindArrow arrow;
    table.name("id", arrow.id);
    table.name("parent", arrow.parent);
    table.place("root", arrow.root);
    table.place("tip", arrow.tip);
    table.number("strength_ms", arrow.strength_ms, {0, 300, "m/s"});
    table.number("radius_m", arrow.radius_m, {0.01, 1000, "m"});
    table.finish();
    for (const char* key : {"id", "root", "tip", "strength_ms"})
        table.require(key);
    if (arrow.root == arrow.tip)
        throw table.error("tip", "the root's own place",
                          "another place, for the arrow's direction");
    return arrow;
}

/// Every parent exists, every id is alone, and following parents comes to an end.
void check_arrows(const std::vector<TableReader>& tables, const std::vector<WindArrow>& arrows) {
    std::map<std::string, std::size_t> index;
    for (std::size_t i = 0; i < arrows.size(); ++i)
        if (!index.emplace(arrows[i].id, i).second)
            throw tables[i].error("id", fmt::format("\"{}\" a second time", arrows[i].id),
                                  "an id of its own");
    std::vector<std::string> ids;
    for (const WindArrow& arrow : arrows)
        ids.push_back(arrow.id);
    for (std::size_t i = 0; i < arrows.size(); ++i) {
        const std::string& parent = arrows[i].parent;
        if (parent.empty() || index.contains(parent))
            continue;
        const std::string nearest = base::nearest_name(parent, ids);
        throw tables[i].error("parent", fmt::format("\"{}\"", parent),
                              nearest.empty() ? "the id of an arrow"
                                              : fmt::format("\"{}\"", nearest));
    }
    // A chain that takes more steps than there are arrows goes in a circle. Arrows known to end are
    // not walked again.
    std::vector<bool> ends(arrows.size(), false);
    for (std::size_t i = 0; i < arrows.size(); ++i) {
        std::vector<std::size_t> chain;
        for (std::size_t at = i; !ends[at];) {
            chain.push_back(at);
            if (chain.size() > arrows.size())
                throw tables[i].error(
                    "parent", fmt::format("\"{}\", which leads back to itself", arrows[i].parent),
                    "arrows that start somewhere");
            if (arrows[at].parent.empty())
                break;
            at = index.at(arrows[at].parent);
        }
        for (const std::size_t at : chain)
            ends[at] = true;
    }
}

WindObstacle read_obstacle(TableReader& table) {
    WindObstacle obstacle;
    int shapes = 0;
    if (table.numbers("box", obstacle.numbers, {kPlace, kPlace, kLength, kLength, kYaw}))
        obstacle.kind = WindObstacle::Kind::kBox, ++shapes;
    if (table.numbers("circle", obstacle.numbers, {kPlace, kPlace, kLength}))
        obstacle.kind = WindObstacle::Kind::kCircle, ++shapes;
    if (table.path("mesh", obstacle.mesh))
        obstacle.kind = WindObstacle::Kind::kMesh, ++shapes;
    table.finish();
    if (shapes != 1)
        throw table.error("", fmt::format("{} shapes", shapes), "one of box, circle, mesh");
    return obstacle;
}

} // namespace

void read_terrain(TableReader table, TerrainSpec& terrain) {
    table.path("elevation", terrain.elevation);
    terrain.size_m = read_pair(table, "size_m", {1, 1e6, "m"});
    terrain.height_m = read_pair(table, "height_m", {-2e4, 2e4, "m"});
    table.path("mask", terrain.mask);
    table.number("detail_m", terrain.detail_m, {0, 10, "m"});
    table.path("surface", terrain.surface);
    if (auto classes = table.table("classes"))
        for (const auto& [value, density] : classes->integer_keys(kHighestClass, kShare))
            if (!terrain.classes.emplace(value, density).second) // "1" and "01"
                throw table.error("classes", fmt::format("{} a second time", value),
                                  "each class once");
    table.finish();
    if (terrain.elevation.empty() == terrain.surface.empty())
        throw table.error("", terrain.elevation.empty() ? "neither" : "both",
                          "either elevation or surface");
    if (terrain.height_m && terrain.height_m->x >= terrain.height_m->y)
        throw table.error("height_m",
                          fmt::format("[{}, {}]", terrain.height_m->x, terrain.height_m->y),
                          "the lower height first");
    if (!terrain.classes.empty() && terrain.mask.empty())
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

void read_wind(TableReader table, WindSpec& wind) {
    table.number("speed_ms", wind.speed_ms, {0, 150, "m/s"});
    table.number("direction_deg", wind.direction_deg, kYaw);
    table.number("gust", wind.gust, kShare);
    table.integer("seed", wind.seed, 0, std::numeric_limits<int>::max());
    table.integer("cells", wind.cells, 16, 4096);
    table.number("cell_m", wind.cell_m, {0.05, 10, "m"});
    table.number("step_s", wind.step_s, {0.001, 0.1, "s"});
    table.number("confinement", wind.confinement, {0, 10, ""});
    table.number("viscosity_m2s", wind.viscosity_m2s, {0, 100, "m2/s"});
    table.number("dissipation_per_s", wind.dissipation_per_s, {0, 10, "1/s"});
    std::vector<TableReader> arrows = table.tables("arrow", kMostArrows);
    std::vector<TableReader> obstacles = table.tables("obstacle", kMostObstacles);
    table.finish();
    for (TableReader& arrow : arrows)
        wind.arrows.push_back(read_arrow(arrow));
    check_arrows(arrows, wind.arrows);
    for (TableReader& obstacle : obstacles)
        wind.obstacles.push_back(read_obstacle(obstacle));
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
    table.place("position", pose.position);
    table.boolean("agl", pose.agl);
    table.number("yaw_deg", pose.yaw_deg, kYaw);
    table.number("pitch_deg", pose.pitch_deg, kPitch);
    table.number("fov_deg", pose.fov_deg, kFov);
    table.finish();
    table.require("position");
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
        entry.place("position", key.position);
        entry.number("yaw_deg", key.yaw_deg, kYaw);
        entry.number("pitch_deg", key.pitch_deg, kPitch);
        entry.finish();
        entry.require("t");
        entry.require("position");
        if (!path.keys.empty() && key.t_s <= before)
            throw entry.error("t", fmt::format("{}", key.t_s),
                              fmt::format("more than {}, the key before", before));
        path.keys.push_back(key);
    }
    return path;
}

ObjectSpec read_object(TableReader table, const std::map<std::string, Path>& paths) {
    ObjectSpec object;
    table.name("kind", object.kind);
    table.number("radius_m", object.radius_m, {0.01, 1000, "m"});
    table.path("mesh", object.mesh);
    table.place("position", object.position);
    table.number("yaw_deg", object.yaw_deg, kYaw);
    table.name("path", object.path);
    table.finish();
    table.require("kind");
    if (std::find(kObjectKinds.begin(), kObjectKinds.end(), object.kind) == kObjectKinds.end())
        throw table.error("kind", fmt::format("\"{}\"", object.kind),
                          fmt::format("one of {}", fmt::join(kObjectKinds, ", ")));
    if (object.kind == "mesh")
        table.require("mesh");
    if (table.has("position") == table.has("path"))
        throw table.error("", table.has("path") ? "both" : "neither", "either position or path");
    if (!object.path.empty() && !paths.contains(object.path)) {
        std::vector<std::string> names;
        for (const auto& [name, path] : paths)
            names.push_back(name);
        const std::string nearest = base::nearest_name(object.path, names);
        throw table.error("path", fmt::format("\"{}\"", object.path),
                          nearest.empty() ? "the NAME of a [path.NAME]"
                                          : fmt::format("\"{}\"", nearest));
    }
    return object;
}

} // namespace sward::scene
