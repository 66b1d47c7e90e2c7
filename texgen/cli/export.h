// SPDX-License-Identifier: Apache-2.0
// Layers and slices of level 0 as picture files, for other engines and for people.
#pragma once

#include <filesystem>

#include "grass/grass_set.h"
#include "texgen/cli/options.h"

namespace sward::texgen {

/// "sets/meadow" -> "sets/meadow-png".
[[nodiscard]] std::filesystem::path export_directory(const std::filesystem::path& set,
                                                     ExportFormat format);

/// Throws base::Error(kIo) unless export_pictures may write there: for a check before long work.
void require_export_place(const std::filesystem::path& directory);

/// One picture a kind (PNG) or one with named channels (EXR) for each layer and slice of each
/// variant, and stack.json with their heights and places in metres. The directory appears whole or
/// not at all; earlier pictures there are replaced, any other directory with something in it is
/// refused. Throws base::Error(kIo).
void export_pictures(const grass::GrassSet& set, const std::filesystem::path& directory,
                     ExportFormat format, int threads);

} // namespace sward::texgen
