// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/heightfield.h"
#include "scene/image.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace sward::assets {

/// Elevation of a scene: GeoTIFF or anything GDAL reads locally (its CRS turned into a local
/// east-north-up frame centred on the raster), .hgt, 16-bit PNG (height_m gives metres at 0 and
/// full scale), float TIFF/EXR (size_m where it carries no georeference). Voids are filled from
/// their neighbours. Throws Error: kIo missing or unreadable; kBadInput wrong format, NaN, all
/// nodata, fewer than 2 x 2 posts; kOverLimit over docs/limits. The message names the file.
[[nodiscard]] scene::Heightfield load_elevation(const scene::TerrainSpec& spec);

/// Density mask of a scene: PNG, TIFF, EXR, JPEG or an ASCII grid; one channel, 0..1, or with
/// TerrainSpec::classes integer landcover classes, of which one that is not listed has density 0. A
/// file with a place on Earth is laid where it belongs in the frame of `ground`, area by area; any
/// other is spread over all of it. Density is 0 where the file has no value. Throws like
/// load_elevation.
[[nodiscard]] scene::DensityMask load_mask(const scene::TerrainSpec& spec,
                                           const scene::Heightfield& ground);
/// The same without a terrain, spread.
[[nodiscard]] scene::DensityMask load_mask(const std::filesystem::path& path,
                                           const std::map<int, double>& classes = {});

/// x, z in a frame of latitude and longitude (degrees, WGS 84). Throws Error(kBadInput) where they
/// have no place in it.
[[nodiscard]] glm::dvec2 local_place(const scene::Georeference& frame, double latitude_deg,
                                     double longitude_deg);

/// Triangles of a .glb or .gltf, of every node of its default scene, placed by its transforms;
/// pictures, materials, skins and morphs are left alone. External buffers are read from the glTF's
/// directory and below it only. Throws Error: kIo missing or unreadable; kBadInput for what is no
/// glTF, a required extension, an index or range past its end, NaN, a node in a loop, no triangles;
/// kOverLimit over docs/limits.
[[nodiscard]] scene::Mesh load_mesh(const std::filesystem::path& path);

/// 8-bit sRGB PNG. `metadata` is not written: the same picture gives the same bytes. Throws
/// Error(kIo).
void write_png(const std::filesystem::path& path, const scene::Picture& picture);
/// 8-bit PNG of 1 to 4 channels, interleaved, row 0 at the top; a fourth is straight alpha.
struct ByteImage {
    int width = 0;
    int height = 0;
    int channels = 3;
    std::vector<std::uint8_t> values;
    bool colour = true; ///< sRGB-encoded; else numbers, marked as such
};
void write_png(const std::filesystem::path& path, const ByteImage& image);
/// Half-float (colour) and float (everything else) EXR, zip-compressed, named channels. Throws
/// Error(kIo).
void write_exr(const std::filesystem::path& path, const scene::Image& image);
/// Reads an EXR with all of its channels and its text attributes. Throws Error: kIo, kBadInput,
/// kOverLimit.
[[nodiscard]] scene::Image read_exr(const std::filesystem::path& path);

/// One line with the versions of the heavy libraries, for `sward info`.
[[nodiscard]] std::string library_versions();

} // namespace sward::assets
