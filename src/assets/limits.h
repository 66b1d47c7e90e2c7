// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace sward::assets {

/// What a picture or raster may be, checked before memory is taken (docs/scene.md, Limits).
inline constexpr std::int64_t kMostSide = 16384;
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
inline constexpr int kMostChannels = 4;
inline constexpr int kMostBands = 256; ///< of a raster with a geotransform, of which one is read
inline constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 31;
/// Deflate cannot do better than 1032 to 1: more is a file that lies about its size. Small pictures
/// may be that flat.
inline constexpr std::uint64_t kMostRatio = 1000;
inline constexpr std::uint64_t kRatioFrom = std::uint64_t{64} << 20;

/// Throws kOverLimit, or kBadInput below `least` a side. `bytes_each` is of one pixel, decoded;
/// `file_bytes` of the file.
void check_size(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
                int channels, std::uint64_t bytes_each, std::uint64_t file_bytes,
                std::int64_t least);

} // namespace sward::assets
