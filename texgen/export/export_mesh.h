// SPDX-License-Identifier: Apache-2.0
// blades_mesh.glb: the blades as triangles, for engines and editors (docs/texgen.md, Export).
#pragma once

#include <cstddef>
#include <vector>

#include "grass/grass_set.h"

namespace sward::texgen {

inline constexpr const char* kMeshFile = "blades_mesh.glb";

/// One mesh a variant, species and level of detail; level k of all variants is scene k, and the
/// nodes of level 0 name theirs by MSFT_lod. With `levels` 1 there is no extension. Throws
/// base::Error(kOverLimit) above 1 GiB.
[[nodiscard]] std::vector<std::byte> encode_blade_meshes(const grass::GrassSet& set, int levels,
                                                         int threads);

} // namespace sward::texgen
