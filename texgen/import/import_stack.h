// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "texgen/seam/stack_json.h"
#include "texgen/vdb/volume.h"

namespace sward::texgen {

/// A stack of square pictures as a volume, voxels as wide as its texels. A layer fills its slab,
/// which ends half-way to its neighbours: a picture's alpha (without one, its luminance) is the
/// slab's opacity, its colour the voxels'. `side_m`, `canopy_m`: instead of the description's,
/// above 0. Layers without heights stand evenly. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Volume read_stack_volume(const std::filesystem::path& directory, double side_m,
                                       double canopy_m);

} // namespace sward::texgen
