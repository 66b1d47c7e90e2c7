// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "grass/grass_set.h"
#include "texgen/far/far_light.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {

/// Which cells of a volume's box are active, and where their values lie: a bit a cell, and the
/// count before each word.
class VoxelIndex {
public:
    explicit VoxelIndex(const Volume& volume);

    /// Voxels before cell (x, y, z) in order; x may be one past the end of its row.
    [[nodiscard]] std::uint32_t before(int x, int y, int z) const;
    /// Index of the voxel there, or -1. All in the box.
    [[nodiscard]] std::int64_t at(int x, int y, int z) const;

private:
    [[nodiscard]] std::uint64_t cell(int x, int y, int z) const {
        return (static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(cells_.z) +
                static_cast<std::uint64_t>(z)) *
                   static_cast<std::uint64_t>(cells_.x) +
               static_cast<std::uint64_t>(x);
    }
    glm::ivec3 cells_;
    std::vector<std::uint64_t> bits_;
    std::vector<std::uint32_t> count_;
};

/// A volume as the importer sees it: every voxel belongs to a strand (a blade where the volume
/// knows blades, else the column of its place), and has a direction.
class VoxelField {
public:
    VoxelField(const Volume& volume, double density);

    [[nodiscard]] const Volume& volume() const { return volume_; }
    [[nodiscard]] const VoxelIndex& index() const { return index_; }
    [[nodiscard]] std::size_t size() const { return volume_.at.size(); }
    [[nodiscard]] bool blades() const { return blades_; }
    [[nodiscard]] double side() const { return volume_.cells.x * volume_.voxel_m; }
    [[nodiscard]] double box_top() const { return volume_.cells.y * volume_.voxel_m; }
    /// Where the canopy ends, less than a voxel from the box's top.
    [[nodiscard]] double canopy() const {
        return volume_.canopy_m > 0 ? volume_.canopy_m : box_top();
    }

    [[nodiscard]] std::uint32_t strand(std::size_t i) const;
    [[nodiscard]] int rank8(std::size_t i) const; ///< 0..255
    [[nodiscard]] int seed8(std::size_t i) const;
    [[nodiscard]] glm::vec3 tangent(std::size_t i) const; ///< unit, upward
    [[nodiscard]] float along(std::size_t i) const;       ///< place along the strand, 0..1
    [[nodiscard]] glm::dvec2
    root(std::size_t i) const; ///< x, z of the strand's foot, nearest image, metres
    [[nodiscard]] glm::dvec3 centre(std::size_t i) const;
    [[nodiscard]] bool coloured() const { return !volume_.colour.empty(); }
    /// Linear albedo of a voxel that the file gave one: what the far field's averages hold.
    [[nodiscard]] const glm::vec3& colour(std::size_t i) const { return volume_.colour[i]; }
    /// The species that a texel names which shows the voxel, and its giver: one a voxel, or none
    /// for a volume of one species.
    [[nodiscard]] int species(std::size_t i) const { return species_.empty() ? 0 : species_[i]; }
    void paint(std::vector<std::uint8_t> species) { species_ = std::move(species); }
    /// Opacity of a cloud's voxel, or area over face of a blade's.
    [[nodiscard]] float density(std::size_t i) const { return volume_.density[i] * density_; }

    /// Number of the other blades in a voxel, for what is hidden by strand: one beside each strand,
    /// since it mostly runs along.
    [[nodiscard]] static std::uint32_t beside(std::uint32_t strand) { return strand | 1u << 16; }
    /// Share of a blade's voxel that belongs to others than its strand.
    [[nodiscard]] float others(std::size_t i) const;

    /// What part of its face a voxel covers, seen along a unit direction: of a blade its area,
    /// foreshortened; of a cloud its opacity over one voxel.
    [[nodiscard]] float seen_along(std::size_t i, const glm::vec3& direction) const;

    /// Farthest of any voxel from its root, metres.
    [[nodiscard]] double farthest_root() const;

    /// Unit normal of a blade's piece, by its tangent and number; `tangent` may be the bent one.
    [[nodiscard]] glm::vec3 normal(std::size_t i, const glm::vec3& tangent) const;

private:
    void find_roots();
    void find_directions();
    [[nodiscard]] glm::vec3 gradient_direction(std::size_t i) const;

    const Volume& volume_;
    VoxelIndex index_;
    float density_;
    bool blades_;
    std::vector<glm::vec3> tangents_;          ///< estimated, where the volume has none
    std::vector<std::vector<glm::vec2>> feet_; ///< of each blade number (rank and seed), in metres
    std::vector<std::uint16_t> tops_;          ///< highest cell of each
    std::vector<std::uint8_t> species_;
};

/// The volume as a canopy that rays can be cast through, at rest and bent. Both must outlive it.
[[nodiscard]] Canopy volume_canopy(const VoxelField& field, const shared::GrassAppearance& look);

/// Heights that rays meet, rising, for place_layers.
[[nodiscard]] std::vector<double> heights_seen(const VoxelField& field, int threads);

/// Layers and slices of level `level` with mips.
struct ImportQuery;
[[nodiscard]] grass::FarLevel project_level(const VoxelField& field, const ImportQuery& query,
                                            int level, const grass::GrassSet& set,
                                            std::span<const double> seen);

} // namespace sward::texgen
