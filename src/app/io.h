// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/heightfield.h"
#include "scene/image.h"
#include "scene/mesh.h"
#include "scene/scene.h"

// What the two builds of sward read and write: io_full.cpp stands on the assets module, io_core.cpp
// on scene alone.
namespace sward::app {

/// "full" or "core", for `sward info`.
[[nodiscard]] std::string_view build_name();
/// Versions of the libraries behind the formats, one line.
[[nodiscard]] std::string format_libraries();

/// Elevation of a scene. Full: assets::load_elevation, and raw posts; core: .hgt and .raw. Throws
/// Error.
[[nodiscard]] scene::Heightfield load_elevation(const scene::TerrainSpec& spec);
/// Density mask, laid over the terrain. The core build reads none: throws Error(kBadInput).
[[nodiscard]] scene::DensityMask load_mask(const scene::TerrainSpec& spec,
                                           const scene::Heightfield& ground);
/// x, z of a latitude and longitude in the terrain's frame; null where the terrain has no place on
/// Earth.
[[nodiscard]] scene::PlaceOnEarth place_on_earth(const scene::Heightfield& ground);

/// A mesh that a scene names. The core build reads none: throws Error(kBadInput).
[[nodiscard]] scene::Mesh load_mesh(const std::filesystem::path& path);

/// Extensions that -o may end in, without the dot.
[[nodiscard]] std::vector<std::string_view> picture_extensions();
/// Extension of the display pictures, without the dot: screenshots.
[[nodiscard]] std::string_view display_extension();
/// Whether a file of this name holds linear channels (AOVs) rather than a display picture.
[[nodiscard]] bool is_linear(const std::filesystem::path& path);

/// Write a file whole or not at all. Throw Error(kIo).
void write_display(const std::filesystem::path& path, const scene::Picture& picture);
void write_linear(const std::filesystem::path& path, const scene::Image& image);
/// Writes a picture's bytes to stdout. Throws Error(kIo) where the other end is gone.
void write_raw(const scene::Picture& picture);
/// Reads what write_linear wrote. The core build reads none: throws Error(kBadInput).
[[nodiscard]] scene::Image read_linear(const std::filesystem::path& path);

} // namespace sward::app
