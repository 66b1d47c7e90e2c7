// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_sections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "scene/wind_sources.h"

namespace sward::scene {
namespace {

constexpr std::size_t kMostArrows = 1024;
constexpr std::size_t kMostSources = 256;
constexpr std::size_t kMostObstacles = 4096;

WindArrow read_arrow(TableReader& table) {
    WindArrow arrow;
    table.name("id", arrow.id);
    table.name_or_none("parent", arrow.parent);
    table.place("root", arrow.root);
    table.place("tip", arrow.tip);
    table.number("strength_mps", arrow.strength_mps, {0, 300, "m/s"});
    table.number("radius_m", arrow.radius_m, {0.01, 1000, "m"});
    read_span(table, arrow.start_s, arrow.end_s);
    table.finish();
    for (const char* key : {"id", "root", "tip", "strength_mps"})
        table.require(key);
    check_span(table, arrow.start_s, arrow.end_s);
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

/// Width, depth or radius against the side of the window: air needs somewhere to be.
void check_size(const TableReader& table, const WindObstacle& obstacle, double side_m) {
    const bool box = obstacle.kind == WindObstacle::Kind::kBox;
    const double size =
        box ? std::min(obstacle.size.x, obstacle.size.y) : std::sqrt(2.0) * obstacle.size.x;
    if (obstacle.kind == WindObstacle::Kind::kMesh || size < side_m)
        return;
    throw table.error(box ? "box" : "circle",
                      box ? fmt::format("{} x {} m", obstacle.size.x, obstacle.size.y)
                          : fmt::format("a radius of {} m", obstacle.size.x),
                      fmt::format("less than covers the wind's whole window (wind.cells * "
                                  "wind.cell_m = {} m a side)",
                                  side_m));
}

WindObstacle read_obstacle(TableReader& table, const std::map<std::string, Path>& paths) {
    WindObstacle obstacle;
    std::vector<double> n;
    int shapes = 0;
    if (table.numbers("box", n, {kPlace, kPlace, kLength, kLength, kYaw})) {
        obstacle.kind = WindObstacle::Kind::kBox, ++shapes;
        obstacle.where.place = {n[0], n[1]};
        obstacle.size = {n[2], n[3]};
        obstacle.where.yaw_deg = n[4];
    }
    if (table.numbers("circle", n, {kPlace, kPlace, kLength})) {
        obstacle.kind = WindObstacle::Kind::kCircle, ++shapes;
        obstacle.where.place = {n[0], n[1]};
        obstacle.size = {n[2], n[2]};
    }
    if (table.path("mesh", obstacle.mesh)) {
        obstacle.kind = WindObstacle::Kind::kMesh, ++shapes;
        table.place("place", obstacle.where.place);
        table.number("yaw_deg", obstacle.where.yaw_deg, kYaw);
        table.number("height_m", obstacle.height_m, {-1000, 1000, "m"});
    }
    table.name("path", obstacle.where.path);
    table.finish();
    if (shapes != 1)
        throw table.error("", fmt::format("{} shapes", shapes), "one of box, circle, mesh");
    if (obstacle.kind == WindObstacle::Kind::kMesh && !table.has("place") && !table.has("path"))
        throw table.error("", "neither", "place or path");
    check_path(table, obstacle.where.path, paths);
    return obstacle;
}

} // namespace

void read_span(TableReader& table, double& start_s, double& end_s) {
    table.number("start_s", start_s, kTime);
    table.number("end_s", end_s, kTime);
}

void check_span(const TableReader& table, double start_s, double end_s) {
    if (!(end_s > start_s))
        throw table.error("end_s", fmt::format("{}", end_s),
                          fmt::format("more than start_s, {}", start_s));
}

void read_wind(TableReader table, const std::map<std::string, Path>& paths, WindSpec& wind) {
    table.number("speed_mps", wind.speed_mps, {0, 150, "m/s"});
    table.number("direction_deg", wind.direction_deg, kYaw);
    table.number("gust", wind.gust, kShare);
    table.integer("seed", wind.seed, 0, std::numeric_limits<int>::max());
    table.integer("cells", wind.cells, 16, 4096);
    table.integer("moving_cells", wind.moving_cells, 16, 4096);
    table.number("cell_m", wind.cell_m, {0.05, 10, "m"});
    table.number("step_s", wind.step_s, {0.001, 0.1, "s"});
    table.number("confinement", wind.confinement, {0, 10, ""});
    table.number("viscosity_m2s", wind.viscosity_m2s, {0, 100, "m2/s"});
    table.number("dissipation_per_s", wind.dissipation_per_s, {0, 10, "1/s"});
    std::vector<TableReader> arrows = table.tables("arrow", kMostArrows);
    std::vector<TableReader> sources = table.tables("source", kMostSources);
    std::vector<TableReader> obstacles = table.tables("obstacle", kMostObstacles);
    table.finish();
    for (TableReader& arrow : arrows)
        wind.arrows.push_back(read_arrow(arrow));
    check_arrows(arrows, wind.arrows);
    for (TableReader& source : sources)
        wind.sources.push_back(read_source(source, paths));
    for (TableReader& obstacle : obstacles) {
        wind.obstacles.push_back(read_obstacle(obstacle, paths));
        check_size(obstacle, wind.obstacles.back(), wind.cells * wind.cell_m);
    }
}

} // namespace sward::scene
