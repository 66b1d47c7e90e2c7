// SPDX-License-Identifier: Apache-2.0
// KTX 2.0, the subset that grass sets and their exports need: 2D arrays and 2D textures with mips
// in the formats of TexelFormat, with no supercompression (scheme 0) or Zstandard's (scheme 2).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "grass/grass_set.h"

namespace sward::grass {

/// Limits of a texture array (images, and bytes once unpacked with all mips).
inline constexpr std::uint32_t kMaxArrayLayers = 2048;
inline constexpr std::uint32_t kMaxSide = 2048;       ///< of an array; an atlas may have more
inline constexpr std::uint32_t kMaxPlainSide = 16384; ///< of a single texture: what GPUs take
inline constexpr std::uint64_t kMaxArrayBytes = std::uint64_t{1} << 30;

/// Bytes of mip `mip`: max(1, width >> mip) x max(1, height >> mip) x layers texels, in whole
/// blocks.
[[nodiscard]] std::uint64_t mip_bytes(const TextureArray& array, int mip);

/// The file's bytes. `compression` is zstd's level, 1 fast .. 19 small, or 0 for none. The array
/// must be well formed.
[[nodiscard]] std::vector<std::byte> encode_ktx2(const TextureArray& array, int compression);

/// Reads a hostile file; `name` is for messages. Throws base::Error: kBadInput malformed, another
/// format or a float that is not finite, kOverLimit above the limits (before memory is taken).
[[nodiscard]] TextureArray decode_ktx2(std::span<const std::byte> bytes,
                                       const std::filesystem::path& name);

} // namespace sward::grass
