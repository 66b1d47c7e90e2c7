// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "texgen/vdb/volume.h"

namespace sward::texgen {

/// Limits of a volume (docs/limits.md).
inline constexpr int kMaxVdbGrids = 64;
inline constexpr int kMaxVdbSide = 4096;                               // voxels
inline constexpr std::uint64_t kMaxVdbVoxels = std::uint64_t{1} << 28; // active, a grid
inline constexpr std::uint64_t kMaxVdbBytes = std::uint64_t{1} << 32;

struct VdbGridInfo {
    std::string name;
    std::string type; ///< as OpenVDB names it: "Tree_float_5_4_3", ...
};

inline constexpr const char* kPeriodKey = "period_m"; ///< metadata of a grid, in its units
inline constexpr const char* kCanopyKey = "canopy_m"; ///< likewise

/// The bytes of an OpenVDB file; by its first ones before the rest is read. Throws base::Error:
/// kIo, kBadInput, kOverLimit.
[[nodiscard]] std::vector<std::byte> read_vdb_file(const std::filesystem::path& path);

/// How a volume is taken from a file.
struct VolumeQuery {
    bool z_up = false;      ///< the file's z is up (Blender); else its y
    double scale = 1;       ///< metres a unit of the file
    double period_m = 0;    ///< instead of the metadata's, when above 0
    bool companions = true; ///< tangent, colour, rank and seed beside the density
};

/// The active voxels of a file's grids, and of the one that decides between two of them.
struct VdbCells {
    std::string key_grid; ///< `density`, else the first scalar grid
    std::vector<glm::ivec3> at;
    std::vector<float> key; ///< 0 where only other grids are active
    glm::dvec3 voxel{0};    ///< in the file's units
    double period = 0;      ///< from the metadata `period_m`; 0: none
};

/// The voxel `from` goes to `to`, in every grid.
struct VdbMove {
    glm::ivec3 from{0}, to{0};
};

class VdbReader;

/// An OpenVDB file in memory, read grid by grid and by us: the library trusts what it reads. Throws
/// base::Error: kBadInput, kOverLimit.
class VdbFile {
public:
    VdbFile(std::span<const std::byte> bytes, std::filesystem::path name);
    ~VdbFile();
    VdbFile(const VdbFile&) = delete;
    VdbFile& operator=(const VdbFile&) = delete;

    [[nodiscard]] const std::vector<VdbGridInfo>& grids() const { return infos_; }

    /// Reads every float and vec3 grid to its end and keeps none: throws where one is damaged.
    void check_grids() const;

    /// The fog volume `density` and what stands beside it, `color` or `Cd` for `colour`. Voxels of
    /// density 0 are left out, and with a warning those that are not 0 by rounding alone. Refuses
    /// level sets, values below that, non-finite ones, and transforms other than a scale and a
    /// shift. kUsage where `period_m` does not fit.
    [[nodiscard]] Volume read_volume(const VolumeQuery& query) const;

    /// The active voxels of all float and vec3 grids, by rising x, y, z. Refuses level sets, and
    /// grids whose voxels do not lie on each other.
    [[nodiscard]] VdbCells read_cells() const;

    /// A file of the same float and vec3 grids whose voxels have moved; others are left out with a
    /// warning. Every grid gets `period_m`.
    [[nodiscard]] std::vector<std::byte> moved(std::span<const VdbMove> moves, double period) const;

private:
    std::unique_ptr<VdbReader> reader_;
    std::vector<VdbGridInfo> infos_;
};

} // namespace sward::texgen
