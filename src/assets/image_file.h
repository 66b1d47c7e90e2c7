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

/// The first channel of a picture: of a palette, its red; of grey with alpha, the grey.
struct Channel {
    int width = 0;
    int height = 0;
    int channels = 0; ///< of the file
    double full_scale =
        0; ///< largest value of an integer type (255, 65535, ...); 0 for floating point
    std::vector<float>
        values; ///< as the file holds them, 0..full_scale; row 0 at the top; every one is finite
};

/// What a palette stands for: its colours, or classes whose numbers are the indices into it.
enum class Palette { kColours, kIndices };

/// Reads PNG, TIFF, EXR or JPEG. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Channel read_first_channel(const std::filesystem::path& path, int least_side,
                                         Palette palette = Palette::kColours);

/// The two readers behind it: EXR through OpenImageIO, the rest through GDAL, whose drivers keep
/// libpng, libjpeg and libtiff from writing to stderr.
[[nodiscard]] Channel read_exr_channel(const std::filesystem::path& path, int least_side);
[[nodiscard]] Channel read_gdal_channel(const std::filesystem::path& path, int least_side,
                                        Palette palette);

} // namespace sward::assets
