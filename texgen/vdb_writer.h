// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "texgen/volume.h"

namespace sward::texgen {

/// A volume as the bytes of an OpenVDB file: `density` first, half floats, y up, a voxel's value at its middle.
[[nodiscard]] std::vector<std::byte> encode_vdb(const Volume& volume);

} // namespace sward::texgen
