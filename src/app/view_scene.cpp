// SPDX-License-Identifier: Apache-2.0
#include "app/view_scene.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

namespace sward::app {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 9> kElevation = {".tif", ".tiff", ".hgt", ".raw", ".r16",
                                                        ".vrt", ".img",  ".asc", ".bil"};

/// As a TOML string.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out += '\\';
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        else
            out += c;
    }
    return out + "\"";
}

} // namespace

bool is_elevation(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return std::find(kElevation.begin(), kElevation.end(), extension) != kElevation.end();
}

std::string elevation_scene(const fs::path& file) {
    return "[terrain]\nelevation = " + quoted(file.filename().string()) + "\n";
}

scene::Scene open_scene(fs::path path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored))
        path /= "scene.toml";
    if (!is_elevation(path))
        return scene::load_scene(path);
    return scene::parse_scene(elevation_scene(path), path);
}

std::string scene_title(const scene::Scene& scene) {
    const fs::path whole = fs::absolute(scene.file).lexically_normal();
    return whole.filename() == "scene.toml" ? whole.parent_path().filename().string()
                                            : whole.filename().string();
}

} // namespace sward::app
