// SPDX-License-Identifier: Apache-2.0
// From pieces of blades to what the far field's march reads (docs/far-field.md): the columns, three
// sets of slabs, and the mean areas of the canopy. Blades come in pieces, and so does anything else
// that has a surface.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/patch/patch.h"

namespace sward::texgen {

/// A small piece of surface.
struct SurfacePiece {
    glm::dvec3 place{0};        ///< patch coordinates, x and z on the torus (m)
    glm::dvec3 area{0};         ///< projected along the axes (m2)
    glm::vec3 albedo{0};        ///< linear reflectance
    glm::vec3 tangent{0, 1, 0}; ///< unit, up
    float rank = 0.5f;
    double along = 0; ///< place along the blade, 0 root .. 1 tip
    std::size_t species = 0;
};

/// The march's textures in floats, with all mips. Of a texel: albedo times density, density, mean
/// tangent times density, rank times density; densities are relative to the mean of their height.
struct MarchImages {
    static constexpr std::size_t kFloats = 8;
    static constexpr std::size_t kDensity = 3;
    int width = 0, height = 0, layers = 0;
    std::vector<std::vector<float>> mips; ///< layer-major, row-major
};

struct MarchData {
    shared::MarchMedium medium{};
    MarchImages columns;
    std::array<MarchImages, shared::kMarchSets> slabs;
};

class MarchBuilder {
public:
    /// `seen`: heights (m, rising) that rays meet: the columns' layers divide them evenly.
    MarchBuilder(double side_m, double canopy_m, int variants, std::span<const double> seen);
    void add(int variant, const SurfacePiece& piece);
    /// Once all pieces are in. `looks`: of the species.
    [[nodiscard]] MarchData finish(std::span<const shared::GrassAppearance> looks);

private:
    double side_, canopy_;
    int variants_;
    std::array<double, shared::kMarchLayers + 1> edges_{};
    std::array<glm::dvec3, shared::kMarchLayers> areas_{};
    /// Of a layer: area as the columns weight it, the same times the tangent's upright part and
    /// times the place along the blade.
    std::array<glm::dvec3, shared::kMarchLayers> moments_{};
    struct Tint {
        glm::dvec4 columns{0}, level{0}, steep{0}; ///< albedo times area, area, as each sees it
    };
    std::array<Tint, shared::kMarchLayers> tints_{};
    std::vector<double> species_; ///< area of each, weighted by height
    MarchImages columns_, slabs_;
};

/// The pieces of a variant's blades, each a fraction of a texel.
void add_blades(const Patch& patch, int variant, MarchBuilder& builder);

class VoxelField;
/// The same of an imported volume's voxels: of each the part of its faces that it covers, in the
/// voxels' own colours where the volume has some.
void add_voxels(const VoxelField& field, const shared::GrassAppearance& look,
                MarchBuilder& builder);

/// What the renderer reads of it: half floats.
[[nodiscard]] grass::FarMedium pack_march(const MarchData& data);

} // namespace sward::texgen
