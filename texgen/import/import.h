// SPDX-License-Identifier: Apache-2.0
// A far-only grass set from a volume: textures, far table and colours, no blades.
#pragma once

#include <string>

#include "grass/grass_set.h"
#include "texgen/preset/preset.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {

struct ImportQuery {
    std::string name;   ///< of the set
    double density = 1; ///< factor on the volume's
    int size =
        0; ///< texels a side at level 0; 0: the power of two nearest to the voxels, 32 to 2048
    int layers = 16; ///< at level 0, halved by every further level
    int slices = 16; ///< an axis
    int levels = 4;
    int far_rays = kFarRays; ///< as in a preset
    int threads = 0;
};

/// A set of one variant. The box of the volume must be square; it is taken as periodic. A volume
/// that texgen wrote is read as blades (area, direction and identity of each voxel); any other as a
/// cloud whose density is the opacity of a voxel. Missing companions are estimated: directions from
/// the density's gradients, colours as a meadow's, ranks and seeds by place. Throws base::Error:
/// kBadInput, kOverLimit.
[[nodiscard]] grass::GrassSet import_volume(const Volume& volume, const ImportQuery& query,
                                            const std::filesystem::path& file);

} // namespace sward::texgen
