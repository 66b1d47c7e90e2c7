// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "scene/scene_sections.h"
#include "scene/toml_reader.h"

namespace sward::scene {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 20;
constexpr std::size_t kMostNamed = 1024; // cameras, paths
constexpr std::size_t kMostObjects = 4096;

} // namespace

Scene load_scene(const std::filesystem::path& file) {
    return parse_scene(base::read_text(file, kLimit), file);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file) {
    const toml::table document = parse_toml(text, file);
    Scene scene;
    scene.file = file;
    TableReader root(document, file, "");
    auto terrain = root.table("terrain");
    auto grass = root.table("grass");
    auto surface_grass = root.table("surface_grass");
    auto sun = root.table("sun");
    auto air = root.table("air");
    auto wind = root.table("wind");
    auto tracks = root.table("tracks");
    auto objects = root.tables("object", kMostObjects);
    auto cameras = root.table("camera");
    auto paths = root.table("path");
    auto lod = root.table("lod");
    root.finish();
    root.require("terrain");

    read_terrain(*terrain, scene.terrain);
    if (grass)
        read_grass(*grass, scene.grass);
    if (tracks && !scene.terrain.surface.empty())
        throw root.error("tracks", "terrain.surface", "terrain.elevation beside it");
    if (surface_grass && scene.terrain.surface.empty())
        throw root.error("surface_grass", "terrain.elevation", "terrain.surface beside it");
    if (surface_grass)
        read_surface_grass(*surface_grass, scene.surface_grass, scene.grass);
    if (sun)
        read_sun(*sun, scene.sun);
    if (air)
        read_air(*air, scene.air);
    if (cameras)
        for (const auto& [name, table] : cameras->named_tables(kMostNamed))
            scene.cameras[name] = read_camera(table);
    if (paths)
        for (const auto& [name, table] : paths->named_tables(kMostNamed))
            scene.paths[name] = read_path(table);
    if (wind)
        read_wind(*wind, scene.paths, scene.wind);
    if (tracks)
        read_tracks(*tracks, scene.paths, scene.tracks.emplace());
    for (const TableReader& table : objects)
        scene.objects.push_back(read_object(table, scene.paths));
    if (lod)
        read_lod(*lod, scene.lod);
    return scene;
}

} // namespace sward::scene
