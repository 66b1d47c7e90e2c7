// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace sward::app {

/// What a scene's grass.set, or on a mesh its surface_grass.set, leads to.
struct SetPlace {
    std::filesystem::path path;
    bool is_preset = false; ///< a texgen preset to bake; else a set's directory
};

/// Looks beside the scene, then among the shipped presets. Throws Error(kIo) that names both
/// places.
[[nodiscard]] SetPlace find_set(const scene::Scene& scene);

} // namespace sward::app
