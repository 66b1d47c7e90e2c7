// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "grass/grass_set.h"
#include "texgen/preset/preset.h"

namespace sward::texgen {

/// A voxel's place in its volume's box.
struct VoxelPlace {
    std::uint16_t x = 0, y = 0, z = 0;
    bool operator==(const VoxelPlace&) const = default;
};

/// A volume of grass as plain arrays: the active voxels of `density`, by rising y, then z, then x.
/// All arrays are of one length, or empty where the file has no such grid. Metres, y up.
struct Volume {
    double voxel_m = 0;  ///< edge of a voxel
    glm::ivec3 cells{0}; ///< size of the box, in voxels
    std::vector<VoxelPlace> at;
    std::vector<float> density; ///< area of grass in the voxel over the area of the voxel's face
    std::vector<glm::vec3> tangent; ///< unit
    std::vector<glm::vec3> colour;  ///< linear albedo
    std::vector<float> rank, seed;  ///< (n + 0.5) / 256
    std::vector<float> others; ///< what of `density` belongs to other blades than the companions'

    double period_m = 0; ///< of the tiling, from the file's metadata; 0: it says none
    double canopy_m = 0; ///< likewise the canopy's top, about the top of the box; 0: that is it
    std::string preset;  ///< name of the set it was made for; empty: not ours
    std::uint64_t set_seed = 0;
    int format_version = 0;
    /// Its terms of light alone count: of the file's metadata, else plain meadow grass's. One for
    /// all voxels: the mean of a set's species by their area, the higher it stands the more, as the
    /// march's.
    Species light;
};

/// Variant 0 of a set as a volume (G1): every blade's curved, tapered surface cut into small pieces
/// and summed by voxel, so that the sum of density * voxel_m^2 is the area of the blades. Voxels
/// are as wide as a texel of level 0. Where several blades share a voxel, the companions are those
/// of the one with the most area (the lower rank at a tie).
[[nodiscard]] Volume rasterise_volume(const grass::GrassSet& set);

/// volume.vdb of variant 0: fog volume `density`, then `tangent`, `colour`, `rank`, `seed`,
/// `others`; half float. Period, preset, seed and format version stand in every grid's metadata.
/// The same set gives the same bytes.
[[nodiscard]] std::vector<std::byte> encode_volume(const grass::GrassSet& set);

/// volume.vdb of a set's directory. Its size and SHA-256 are compared with set.json before OpenVDB,
/// which takes files on trust, sees it. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Volume read_volume(const std::filesystem::path& set_directory);

/// Area of a blade's surface, square metres, by the integral that the rasteriser approximates.
[[nodiscard]] double blade_area(const grass::GrassSet& set, const shared::BladeRecord& blade);

/// What a volume holds, read back. `name`: of the file, for messages.
struct VolumeInfo {
    std::vector<std::string> grids;  ///< names, in file order
    std::uint64_t active_voxels = 0; ///< of `density`
    double density_sum = 0;
    double voxel_m = 0;
};
[[nodiscard]] VolumeInfo inspect_volume(const std::vector<std::byte>& bytes,
                                        const std::filesystem::path& name);

} // namespace sward::texgen
