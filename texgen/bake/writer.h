// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/preset/preset.h"

namespace sward::texgen {

struct FileEntry {
    std::string name;
    std::uint64_t bytes = 0;
    std::string sha256;
};

struct BakeOptions {
    int threads = 0;     ///< 0: one a core; the bytes are the same at any number
    bool volume = true;  ///< volume.vdb; the renderer does not read it
    bool preview = true; ///< preview.png
    int compression =
        3; ///< zstd level of the KTX2 files: 3 is fast, 19 about a tenth smaller, 0 none
    bool block = false; ///< shape planes as BC5: a quarter less on the GPU
    bool check_nan =
        false; ///< look at every number that is written; kFailure names one that is not finite
    /// Where the contact sheet goes instead of preview.png inside the set.
    std::optional<std::filesystem::path> preview_file = std::nullopt;
};

/// Everything the renderer reads, in memory. Takes about 1.4 times the arrays' size.
[[nodiscard]] grass::GrassSet bake_set(const Preset& preset, const BakeOptions& options);

/// Fills `layers_shape` and `slices_shape` of every level; `layers` and `slices` become what a
/// reader gets.
void compress_shapes(grass::GrassSet& set, int threads);

/// Writes the set's directory whole or not at all. An existing set there is replaced; any other
/// directory with something in it is refused. Returns its files but set.json. Throws
/// base::Error(kIo).
std::vector<FileEntry> write_set(const grass::GrassSet& set, const Preset& preset,
                                 const std::filesystem::path& directory,
                                 const BakeOptions& options);

/// Throws base::Error(kIo) unless write_set could put a set there: for a check before long work.
void require_set_place(const std::filesystem::path& directory);

/// The text of set.json for files whose name, bytes and hash are given.
[[nodiscard]] std::string set_json(const grass::GrassSet& set, const std::vector<FileEntry>& files);

} // namespace sward::texgen
