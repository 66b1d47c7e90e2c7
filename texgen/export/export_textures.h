// SPDX-License-Identifier: Apache-2.0
// What `texgen export` writes for other engines, as files in a folder that the caller makes and
// gives its name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grass/grass_set.h"

namespace sward::texgen {

struct TextureExport {
    int threads = 0;
    int compression = 3; ///< zstd level of the KTX2 files, 0 none
    bool atlases = true;
};

/// albedo_*.ktx2 and tangent_*.ktx2 as arrays, the same as atlases (KTX2 and PNG), the far field's
/// files as they are in the set, and stack.json, which says where each image is. Throws
/// base::Error: kOverLimit where an atlas would be larger than GPUs take.
void write_textures(const grass::GrassSet& set, const std::filesystem::path& set_directory,
                    const std::filesystem::path& folder, const TextureExport& options);

} // namespace sward::texgen
