// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace sward::app {

/// The meshes of objects that grass feels, packed with balls: by mesh name and number of balls as
/// objects give them, the most that any asks for. Packed on first use and kept beside the grass
/// sets under the hash of their triangles; what is damaged is packed again. A cache that cannot be
/// written is no failure: a warning, and the next start packs once more. Throws Error for a mesh
/// that cannot be packed.
[[nodiscard]] std::map<std::filesystem::path, scene::SphereSet>
load_spheres(const scene::Scene& scene, const std::map<std::filesystem::path, scene::Mesh>& meshes);

} // namespace sward::app
