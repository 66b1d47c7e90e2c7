// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "grass/grass_set.h"

namespace sward::texgen {

/// Contact sheet of a set. Throws base::Error(kIo).
void write_preview(const grass::GrassSet& set, const std::filesystem::path& path, int threads);

} // namespace sward::texgen
