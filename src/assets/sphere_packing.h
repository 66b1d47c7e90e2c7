// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "scene/mesh.h"

namespace sward::assets {

struct PackingSettings {
    int most_spheres = 256; ///< more follow thin parts better; each costs a test in the physics of
                            ///< the blades near it
    int cells = 96; ///< of the longest side: parts thinner than two or three are lost; time grows
                    ///< with its square
};

inline constexpr std::size_t kMostPackedTriangles = 2'000'000;

/// Balls that fill a closed mesh, the greatest first: OpenVDB's adaptive packing of its level set.
/// They reach at most a cell out of it. Throws Error naming `file`: kBadInput for a mesh that is
/// not closed or has no inside that a ball of a cell fits in, kOverLimit for more than
/// kMostPackedTriangles.
[[nodiscard]] scene::SphereSet pack_spheres(const scene::Mesh& mesh,
                                            const PackingSettings& settings,
                                            const std::filesystem::path& file);

} // namespace sward::assets
