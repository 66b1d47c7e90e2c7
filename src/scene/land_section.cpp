// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "scene/heightfield.h"
#include "scene/scene_sections.h"

namespace sward::scene {
namespace {

constexpr int kHighestClass = 65535; // 16-bit landcover
constexpr std::size_t kMostFeatures = 64;

/// { density, height, dryness, ground }. Grass is soil's; another ground has none unless it says
/// so.
LandClass read_look(TableReader& table) {
    LandClass look;
    table.word("ground", look.ground, kGroundNames);
    const bool given = table.number("density", look.density, kShare);
    table.number("height", look.height, {0.2, kLandMostHeight, ""});
    table.number("dryness", look.dryness, {-1, 1, ""});
    if (!given && look.ground == GroundKind::kSoil)
        throw table.error("density", "nothing", "a number from 0 to 1, or a ground without grass");
    return look;
}

void read_classes(TableReader& table, TerrainSpec& terrain) {
    auto classes = table.table("classes");
    if (!classes)
        return;
    for (auto& [value, entry] : classes->integer_keys(kHighestClass, kShare)) {
        LandClass look;
        if (const double* density = std::get_if<double>(&entry)) {
            look.density = *density;
        } else {
            look = read_look(std::get<TableReader>(entry));
            std::get<TableReader>(entry).finish();
        }
        if (!terrain.classes.emplace(value, look).second) // "1" and "01"
            throw table.error("classes", fmt::format("{} a second time", value), "each class once");
    }
}

LandClass class_of(const TableReader& table, const char* key, int value,
                   const TerrainSpec& terrain) {
    const auto found = terrain.classes.find(value);
    if (found == terrain.classes.end())
        throw table.error(key, fmt::format("{}", value), "a class of [terrain.classes]");
    return found->second;
}

LandFeature read_feature(TableReader& table, const TerrainSpec& terrain, bool line) {
    LandFeature feature;
    table.path("file", feature.file);
    table.text("layer", feature.layer);
    table.text("where", feature.where);
    if (line)
        table.number("width_m", feature.width_m, {0.1, 1000, "m"});
    int value = 0;
    if (table.integer("class", value, 0, kHighestClass)) {
        for (const char* key : {"density", "height", "dryness", "ground"})
            if (table.has(key))
                throw table.error(key, "class beside it", "one of the two");
        feature.look = class_of(table, "class", value, terrain);
    } else {
        feature.look = read_look(table);
    }
    table.finish();
    table.require("file");
    if (line)
        table.require("width_m");
    return feature;
}

} // namespace

void read_land(TableReader& table, TerrainSpec& terrain) {
    read_classes(table, terrain);
    int outside = 0;
    if (table.integer("outside_class", outside, 0, kHighestClass))
        terrain.outside = class_of(table, "outside_class", outside, terrain);
    table.number("classes_mb", terrain.classes_mb, {1, 4096, "MB"});
    for (TableReader& area : table.tables("area", kMostFeatures))
        terrain.features.push_back(read_feature(area, terrain, false));
    for (TableReader& line : table.tables("line", kMostFeatures))
        terrain.features.push_back(read_feature(line, terrain, true));
}

} // namespace sward::scene
