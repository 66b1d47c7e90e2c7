// SPDX-License-Identifier: Apache-2.0
// What the far field's march reads of an imported volume.
#include <algorithm>
#include <cmath>

#include "shared/shading.h"
#include "texgen/far/march_builder.h"
#include "texgen/import/import_field.h"

namespace sward::texgen {

namespace {

/// Parts a voxel is cut into along each axis, so that it fills the texels that it is as wide as;
/// fewer where there are many voxels.
int parts_of(const VoxelField& field) {
    constexpr double kMostPieces = 4e7;
    const double texels = field.volume().voxel_m * shared::kMarchTexels / field.side();
    const double affordable =
        std::cbrt(kMostPieces / static_cast<double>(std::max<std::size_t>(field.size(), 1)));
    return std::max(1, static_cast<int>(std::min(std::ceil(texels), std::min(affordable, 8.0))));
}

/// Adds the piece in equal parts spread over its voxel.
void add_spread(SurfacePiece piece, double voxel_m, int parts, MarchBuilder& builder) {
    const glm::dvec3 centre = piece.place;
    piece.area /= static_cast<double>(parts) * parts * parts;
    for (int n = 0; n < parts * parts * parts; ++n) {
        const glm::dvec3 part(n % parts, n / parts % parts, n / (parts * parts));
        piece.place = centre + ((part + 0.5) / static_cast<double>(parts) - 0.5) * voxel_m;
        builder.add(0, piece);
    }
}

} // namespace

void add_voxels(const VoxelField& field, const shared::GrassAppearance& look,
                MarchBuilder& builder) {
    const double face = field.volume().voxel_m * field.volume().voxel_m;
    const int parts = parts_of(field);
    for (std::size_t i = 0; i < field.size(); ++i) {
        SurfacePiece piece;
        piece.place = field.centre(i);
        piece.tangent = field.tangent(i);
        piece.rank = (static_cast<float>(field.rank8(i)) + 0.5f) / 256.0f;
        piece.along = field.along(i);
        const float seed = (static_cast<float>(field.seed8(i)) + 0.5f) / 256.0f;
        piece.albedo = field.coloured()
                           ? field.colour(i)
                           : shared::blade_albedo(look, {piece.rank, seed}, field.along(i), 1);
        for (int axis = 0; axis < 3; ++axis) {
            glm::vec3 way(0);
            way[axis] = 1;
            const float opacity = std::clamp(field.seen_along(i, way), 0.0f, 1.0f);
            piece.area[axis] = face * static_cast<double>(opacity);
        }
        add_spread(piece, field.volume().voxel_m, parts, builder);
    }
}

} // namespace sward::texgen
