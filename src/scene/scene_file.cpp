// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "scene/scene_sections.h"
#include "scene/toml_reader.h"

namespace sward::scene {
namespace {

constexpr std::uint64_t kLimit = std::uint64_t{1} << 20;
constexpr std::size_t kMostNamed = 1024; // cameras, paths
constexpr std::size_t kMostObjects = 4096;
constexpr int kMostDots = 32;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Whether the dot at `at` may be a number's: digits on both sides, and no second dot before them.
bool in_number(std::string_view line, std::size_t at) {
    std::size_t first = at;
    while (first > 0 && is_digit(line[first - 1]))
        --first;
    return first < at && at + 1 < line.size() && is_digit(line[at + 1]) &&
           (first == 0 || line[first - 1] != '.');
}

/// The parser nests one table for each dot of a key, with no limit, and its destructor would
/// overflow the stack. A key stands on one line, so counting dots line by line bounds the depth
/// whatever quotes and brackets stand around them.
void refuse_deep_keys(std::string_view text, const std::filesystem::path& file) {
    int number = 0;
    while (!text.empty()) {
        ++number;
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(text.size(), line.size() + 1));
        const std::size_t start = line.find_first_not_of(" \t");
        if (start == std::string_view::npos || line[start] == '#')
            continue;
        int dots = 0;
        for (std::size_t i = 0; i < line.size(); ++i)
            dots += line[i] == '.' && !in_number(line, i) ? 1 : 0;
        if (dots > kMostDots)
            throw base::input_error(base::ExitCode::kOverLimit, file, number, "dots in one line",
                                    std::to_string(dots), "at most " + std::to_string(kMostDots));
    }
}

toml::table parse(const std::string& text, const std::filesystem::path& file) {
    refuse_deep_keys(text, file);
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw base::input_error(base::ExitCode::kBadInput, file,
                                static_cast<int>(error.source().begin.line), "not valid TOML",
                                error.description(), "TOML 1.0");
    }
}

} // namespace

Scene load_scene(const std::filesystem::path& file) {
    return parse_scene(base::read_text(file, kLimit), file);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& file) {
    const toml::table document = parse(text, file);
    Scene scene;
    scene.file = file;
    TableReader root(document, file, "");
    auto terrain = root.table("terrain");
    auto grass = root.table("grass");
    auto surface_grass = root.table("surface_grass");
    auto sun = root.table("sun");
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
