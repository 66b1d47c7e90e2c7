// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assets/placement.h"
#include "scene/heightfield.h"

namespace sward::assets {

enum class Format { kUnknown, kPng, kTiff, kExr, kJpeg };
/// By the first bytes of the file; its name says nothing.
[[nodiscard]] Format format_of(std::span<const std::byte> head);

/// One channel of a picture: of a palette, its red; of grey with alpha, the grey.
struct Channel {
    int width = 0;
    int height = 0;
    double full_scale = 0; ///< largest value of an unsigned integer type (255, 65535, ...); 0 for
                           ///< floating point and signed classes
    std::vector<float> values; ///< as the file holds them, 0..full_scale; row 0 at the top; NaN
                               ///< where the file has no value, else finite
    std::unique_ptr<Placement>
        placement; ///< null where the file has no place on Earth, or no frame was asked for
    bool turned_loose = false; ///< it has a geotransform and no CRS
};

/// What a palette stands for: its colours, or classes whose numbers are the indices into it.
enum class Palette { kColours, kIndices };

struct ChannelRequest {
    int least_side = 1;
    Palette palette = Palette::kColours; ///< kIndices: classes, which may be signed integers too
    int band = 0; ///< from 1; 0: the first, with a warning where there are more
    const scene::Georeference* frame = nullptr; ///< of the terrain, to place the picture in
};

/// Reads PNG, TIFF, EXR, JPEG or an ASCII grid. Throws base::Error: kIo, kBadInput, kOverLimit.
[[nodiscard]] Channel read_channel(const std::filesystem::path& path,
                                   const ChannelRequest& request);

/// The two readers behind it: EXR through OpenImageIO, the rest through GDAL, whose drivers keep
/// libpng, libjpeg and libtiff from writing to stderr.
[[nodiscard]] Channel read_exr_channel(const std::filesystem::path& path,
                                       const ChannelRequest& request);
[[nodiscard]] Channel read_gdal_channel(const std::filesystem::path& path,
                                        const ChannelRequest& request);

/// Refuses a PNG whose chunks claim more than the file holds: libpng takes that memory first.
/// Throws kBadInput.
void check_png_chunks(const std::filesystem::path& path);
/// Refuses an EXR with an attribute that its reader would divide by. `rows`: of tiff:RowsPerStrip,
/// or nothing. Throws kBadInput.
void check_rows_per_strip(const std::filesystem::path& path, std::optional<int> rows);

} // namespace sward::assets
