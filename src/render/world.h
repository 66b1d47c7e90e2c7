// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>

#include "grass/grass_set.h"
#include "scene/heightfield.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace sward::render {

/// How the far field is drawn: the march; for comparison shells and slices one by one, in the
/// shares that cover as blades do, or as published.
enum class FarScheme { kMarch, kPlanes, kPublished };

/// Inputs of a field, loaded by whoever makes it (the core reads no heavy formats).
struct World {
    scene::Scene scene;
    scene::Heightfield elevation;
    scene::DensityMask mask;             ///< width 0: the slope rule
    grass::GrassSet grass;               ///< empty where the scene stands on a mesh
    FarScheme far = FarScheme::kMarch;   ///< whose textures are kept on the GPU, beside the march's
    scene::Mesh surface;                 ///< terrain.surface; no triangles: a scene on elevation
    scene::DensityMask lying, lying_way; ///< tracks.mask, tracks.mask_way; width 0: none
    std::map<std::filesystem::path, scene::Mesh>
        meshes; ///< those that the scene's obstacles and objects name, under its names
    std::map<std::filesystem::path, scene::SphereSet>
        spheres; ///< the meshes of objects that grass feels, packed; under the same names
};

} // namespace sward::render
