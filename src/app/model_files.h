// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "scene/mesh.h"

namespace sward::render {
struct World;
} // namespace sward::render

namespace sward::app {

/// The file of a vehicle or an aircraft that `option` names: one that ships in `folder`, without
/// its ".toml", or a file. Throws Error(kUsage) that lists those that ship.
[[nodiscard]] std::filesystem::path
find_model(const char* option, const std::filesystem::path& folder, const std::string& name);

/// Adds a mesh that no file holds to a scene's objects: its grass does not feel it. `name` is
/// nobody else's.
void add_model_mesh(render::World& world, const std::string& name, const scene::Mesh& mesh,
                    const glm::dvec3& colour);

} // namespace sward::app
