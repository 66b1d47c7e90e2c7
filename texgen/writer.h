// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "grass/grass_set.h"
#include "texgen/preset.h"

namespace sward::texgen {

struct BakeOptions {
    int threads = 0;     ///< 0: one a core; the bytes are the same at any number
    bool volume = true;  ///< volume.vdb; the renderer does not read it
    bool preview = true; ///< preview.png
    int compression = 3; ///< zstd level of the KTX2 files: 3 is fast, 19 about a tenth smaller
};

/// Everything the renderer reads, in memory. Takes about 1.4 times the arrays' size.
[[nodiscard]] grass::GrassSet bake_set(const Preset& preset, const BakeOptions& options);

/// Writes the set's directory whole or not at all. An existing set there is replaced; any other
/// directory with something in it is refused. Throws base::Error(kIo).
void write_set(const grass::GrassSet& set, const Preset& preset,
               const std::filesystem::path& directory, const BakeOptions& options);

/// Throws base::Error(kIo) unless write_set could put a set there: for a check before long work.
void require_set_place(const std::filesystem::path& directory);

/// The text of set.json for files whose name, bytes and hash are given.
struct FileEntry {
    std::string name;
    std::uint64_t bytes = 0;
    std::string sha256;
};
[[nodiscard]] std::string set_json(const grass::GrassSet& set, const std::vector<FileEntry>& files);

} // namespace sward::texgen
