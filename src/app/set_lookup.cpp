// SPDX-License-Identifier: Apache-2.0
#include "app/set_lookup.h"

#include <fmt/format.h>

#include "app/paths.h"
#include "base/error.h"

namespace sward::app {

namespace fs = std::filesystem;

SetPlace find_set(const scene::Scene& scene) {
    std::error_code ignored;
    const fs::path beside = scene.file.parent_path() / scene.grass.set;
    for (const fs::path& path : {beside, presets_directory() / scene.grass.set}) {
        if (scene.grass.set.empty())
            break;
        if (fs::is_directory(path, ignored))
            return {path, false};
        // A FIFO or a device is found too: reading it is then refused by name.
        if (fs::exists(path, ignored))
            return {path, true};
    }
    const char* const key = scene.terrain.surface.empty() ? "grass.set" : "surface_grass.set";
    throw base::input_error(base::ExitCode::kIo, scene.file, 0, key, scene.grass.set,
                            fmt::format("a set's directory or a preset, beside the scene or in {}",
                                        base::printable(presets_directory().native(), 200)));
}

} // namespace sward::app
