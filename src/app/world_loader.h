// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>

#include "app/load_told.h"
#include "app/options.h"
#include "render/world.h"

namespace sward::app {

/// The scene that the options name, with their overrides. Opens no other file than the scene's.
/// Throws Error.
[[nodiscard]] scene::Scene load_scene(const Options& options);

/// Latitudes and longitudes of a scene become x and z; reads its elevation where it has any. Throws
/// Error.
void settle_paths(scene::Scene& scene);

/// The meshes of the wind's obstacles and of objects, each once. Throws Error.
[[nodiscard]] std::map<std::filesystem::path, scene::Mesh> load_meshes(const scene::Scene& scene);
/// Every file that the scene names: elevation, mask, grass set, or the mesh that stands for them.
/// Throws Error, or AlreadyReported.
[[nodiscard]] render::World load_world(const scene::Scene& scene, const LoadTold& told = {});

} // namespace sward::app
