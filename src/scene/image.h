// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sward::scene {

/// Float image with named channels, row 0 at the top, interleaved. Colour channels "R","G","B","A"
/// are linear.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::string> channels; ///< e.g. {"R","G","B","A","depth"}
    std::vector<float> texels;         ///< width * height * channels.size()
    std::map<std::string, std::string> metadata;
};

/// 8-bit display picture, sRGB-encoded already, 3 channels interleaved, row 0 at the top.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;
};

/// Binary PPM (P6), written whole or not at all: the core build's picture output. Throws
/// Error(kIo).
void write_ppm(const std::filesystem::path& path, const Picture& picture);

} // namespace sward::scene
