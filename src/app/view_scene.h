// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.h"

namespace sward::app {

/// Whether a file is elevation rather than a scene, by its name.
[[nodiscard]] bool is_elevation(const std::filesystem::path& file);
/// The scene of a bare elevation file: its ground, and the default for the rest.
[[nodiscard]] std::string elevation_scene(const std::filesystem::path& file);
/// What the viewer opens: a scene file, a directory that holds scene.toml, or an elevation file.
/// Throws Error.
[[nodiscard]] scene::Scene open_scene(std::filesystem::path path);
/// What a window calls it: its file, or the folder of a scene.toml.
[[nodiscard]] std::string scene_title(const scene::Scene& scene);

} // namespace sward::app
