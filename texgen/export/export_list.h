// SPDX-License-Identifier: Apache-2.0
// export.json: what an export holds, and by which a later one knows that it may take its place.
#pragma once

#include <filesystem>
#include <vector>

#include "grass/grass_set.h"
#include "texgen/bake/writer.h"

namespace sward::texgen {

inline constexpr const char* kExportJson = "export.json";

/// Throws base::Error(kIo) unless an export may take this name: nothing is there, or an empty
/// directory, or an export of which no file was changed and none added.
void require_export_output(const std::filesystem::path& directory);

/// Writes export.json for the files in `folder`; returns them, by name. `target` is what --for
/// said.
std::vector<FileEntry> write_export_list(const grass::GrassSet& set, const char* target,
                                         const std::filesystem::path& folder, int threads);

} // namespace sward::texgen
