// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace sward::assets {

enum class Format { kUnknown, kPng, kTiff, kExr, kJpeg };
/// By the first bytes of the file; its name says nothing.
[[nodiscard]] Format format_of(std::span<const std::byte> head);

/// The first channel of a picture.
struct Channel {
    int width = 0;
    int height = 0;
    int channels = 0; ///< of the file
    double full_scale =
        0; ///< largest value of an integer type (255, 65535, ...); 0 for floating point
    std::vector<float>
        values; ///< integers as 0..1 of full_scale; row 0 at the top; every value is finite
};

/// Reads PNG, TIFF, EXR or JPEG through OpenImageIO. Throws base::Error: kIo, kBadInput,
/// kOverLimit.
[[nodiscard]] Channel read_first_channel(const std::filesystem::path& path, int least_side);

} // namespace sward::assets
