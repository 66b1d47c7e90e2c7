// SPDX-License-Identifier: Apache-2.0
// From pieces of blades to what the far field's march reads (docs/far-field.md): the columns, three sets of slabs, and the mean areas
// of the canopy. Blades come in pieces, and so does anything else that has a surface.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/patch.h"

namespace sward::texgen {

/// A small piece of surface.
struct SurfacePiece {
    glm::dvec3 place{0};  ///< patch coordinates, x and z on the torus (m)
    glm::dvec3 area{0};   ///< projected along the axes (m2)
    glm::vec3 albedo{0};  ///< linear reflectance
    double upright = 0;   ///< square of the upright part of the blade's tangent there
    double along = 0;     ///< place along the blade, 0 root .. 1 tip
    std::size_t species = 0;
};

/// The march's textures in floats, with all mips: rgb albedo times density, a density, both relative to the mean of their height.
struct MarchImages {
    int width = 0, height = 0, layers = 0;
    std::vector<std::vector<float>> mips; ///< layer-major, row-major, 4 floats a texel
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
    void add_to(MarchImages& images, std::size_t texel, const SurfacePiece& piece, double area) const;
    double side_, canopy_;
    int variants_;
    std::array<double, shared::kMarchLayers + 1> edges_{};
    std::array<glm::dvec3, shared::kMarchLayers> areas_{};
    std::array<glm::dvec3, shared::kMarchLayers> moments_{}; ///< area; times upright; times along
    std::vector<double> species_;                            ///< area of each, weighted by height
    MarchImages columns_, slabs_;
};

/// The pieces of a variant's blades, each a fraction of a texel.
void add_blades(const Patch& patch, int variant, MarchBuilder& builder);

/// What the renderer reads of it: half floats.
[[nodiscard]] grass::FarMedium pack_march(const MarchData& data);

} // namespace sward::texgen
