// SPDX-License-Identifier: Apache-2.0
// What the far field's march reads of an imported volume.
#include <cmath>

#include "shared/shading.h"
#include "texgen/import_field.h"
#include "texgen/march_builder.h"

namespace sward::texgen {

void add_voxels(const VoxelField& field, const shared::GrassAppearance& look, MarchBuilder& builder) {
    const double face = field.volume().voxel_m * field.volume().voxel_m;
    constexpr float kMostOpaque = 0.999f; // beyond it an optical depth says nothing
    for (std::size_t i = 0; i < field.size(); ++i) {
        SurfacePiece piece;
        piece.place = field.centre(i);
        piece.tangent = field.tangent(i);
        piece.rank = (static_cast<float>(field.rank8(i)) + 0.5f) / 256.0f;
        piece.along = field.along(i);
        const float seed = (static_cast<float>(field.seed8(i)) + 0.5f) / 256.0f;
        piece.albedo = field.coloured() ? field.colour(i) : shared::blade_albedo(look, {piece.rank, seed}, field.along(i), 1);
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 way(0);
            way[axis] = 1;
            const float opacity = std::min(std::max(field.seen_along(i, way), 0.0f), kMostOpaque);
            piece.area[axis] = field.blades() ? face * static_cast<double>(opacity) : -face * std::log1p(-static_cast<double>(opacity));
        }
        builder.add(0, piece);
    }
}

} // namespace sward::texgen
