// SPDX-License-Identifier: Apache-2.0
// What KTX 2.0 says about each texel format that we use. Internal to src/grass.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grass/grass_set.h"

namespace sward::grass {

struct FormatTraits {
    TexelFormat format;
    const char* name; ///< as messages say it
    std::uint32_t vk_format;
    std::uint32_t type_size;   ///< of the values that a big-endian machine would have to swap
    int block_side;            ///< texels a side of a block
    std::uint32_t block_bytes; ///< also the alignment of a mip that is not supercompressed
};

[[nodiscard]] const FormatTraits& traits_of(TexelFormat format);
/// Null when it is none of ours.
[[nodiscard]] const FormatTraits* traits_of_vk(std::uint32_t vk_format);

/// Data format descriptor with its total size in front (Khronos Data Format 1.3): linear or sRGB,
/// BT.709 primaries, straight alpha.
[[nodiscard]] std::vector<std::byte> data_format_descriptor(TexelFormat format);

} // namespace sward::grass
