// SPDX-License-Identifier: Apache-2.0
#include "scene/core_elevation.h"

#include "base/error.h"
#include "scene/heightfield.h"

namespace sward::scene {

Heightfield read_core_elevation(const TerrainSpec& spec) {
    const std::string extension = spec.elevation.extension().string();
    std::error_code ignored;
    const bool header = std::filesystem::exists(
        std::filesystem::path(spec.elevation).replace_extension(".json"), ignored);
    if (extension == ".hgt")
        return read_hgt(spec.elevation);
    if (spec.size_m && spec.height_m && (extension == ".r16" || (extension == ".raw" && !header)))
        return read_raw16(spec.elevation, *spec.size_m, *spec.height_m);
    if (extension == ".raw")
        return read_raw_elevation(spec.elevation);
    throw base::input_error(
        base::ExitCode::kBadInput, spec.elevation, 0, "elevation",
        extension.empty() ? "no extension" : extension,
        ".hgt or .raw, or .r16 with size_m and height_m (the core build reads no other)");
}

} // namespace sward::scene
