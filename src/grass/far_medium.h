// SPDX-License-Identifier: Apache-2.0
// The march's correction table as a file.
#pragma once

#include <filesystem>

#include "grass/grass_set.h"

namespace sward::grass {

/// RGBA32F, elevations wide and half mips tall, an image a kind; channels: factor on depth, on
/// light, of the one density, of the other. No mips.
[[nodiscard]] TextureArray encode_correction(const FarMedium& march);

/// Checks every factor; `name` is for messages. Throws base::Error(kBadInput).
void decode_correction(const TextureArray& array, const std::filesystem::path& name,
                       FarMedium& march);

} // namespace sward::grass
