// SPDX-License-Identifier: Apache-2.0
// Blades as triangles, as the near tier draws them: the same curve, outline and colours
// (docs/texgen.md, Export).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/blade.h"
#include "shared/grass_layout.h"

namespace sward::texgen {

/// A level of detail: blades of the lowest ranks stand for all, wider in proportion, so that the
/// area stays.
struct MeshLod {
    int segments;      ///< of a plain blade
    int head_segments; ///< of one with a head: half of them stand on it
    float share;       ///< of the blades
};
inline constexpr MeshLod kMeshLods[] = {{6, 8, 1.0f}, {3, 6, 0.5f}, {2, 4, 0.25f}};

/// Triangles, counter-clockwise seen from the blade's upper side. Floats but `colours`; metres, y
/// up.
struct BladeMesh {
    std::vector<float> positions, normals; ///< 3 a vertex
    std::vector<float> uvs; ///< 2: across from rim to rim; 1 at the root .. 0 at the tip
    std::vector<float>
        wind_uvs; ///< 2: weight and phase of `winds`, for engines that read no other attribute
    std::vector<float> winds;  ///< 3: how far the wind moves it, 0 root .. 1 tip; phase 0..1 of its
                               ///< blade; stiffness 0..1
    std::vector<float> roots;  ///< 3: the blade's root
    std::vector<float> blades; ///< 3: rank, seed, length of the curve
    std::vector<std::uint16_t> colours; ///< 4: linear albedo and 1, of 65535
    std::vector<std::uint32_t> indices;

    [[nodiscard]] std::size_t vertices() const { return positions.size() / 3; }
};

/// Those of `blades` (one variant's, by rising rank) that are of the species; at least one where
/// there is any.
[[nodiscard]] BladeMesh blade_mesh(std::span<const shared::BladeRecord> blades, int species,
                                   const shared::GrassAppearance& look, const MeshLod& lod);

} // namespace sward::texgen
