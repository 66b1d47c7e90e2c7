// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "assets/image_file.h"

namespace sward::assets {

/// A picture with every channel as its file holds it, for tools that give back what they were
/// given.
struct LayerImage {
    enum class Type { kUint8, kUint16, kHalf, kFloat };
    int width = 0;
    int height = 0;
    int channels = 0; ///< 1 to 4
    Type type = Type::kUint8;
    Format format = Format::kPng;   ///< PNG, TIFF or EXR
    std::vector<std::string> names; ///< of the channels, in EXR; else empty
    std::vector<float>
        values; ///< channel fastest, row 0 at the top; integers 0..255 or 0..65535, never scaled

    /// Index of the channel that is coverage: "A" of EXR, the last of two or four; -1 where there
    /// is none.
    [[nodiscard]] int alpha() const;
};

/// Reads PNG, TIFF or EXR by its first bytes. Refuses JPEG (its loss would be written back),
/// palettes, other types than 8 and 16 bits unsigned, half and float, and values that are not
/// finite. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] LayerImage read_layer_image(const std::filesystem::path& path);

/// The picture as the bytes of a file of its format and type. The same picture gives the same
/// bytes.
[[nodiscard]] std::vector<std::byte> encode_layer_image(const LayerImage& image,
                                                        const std::filesystem::path& name);

} // namespace sward::assets
