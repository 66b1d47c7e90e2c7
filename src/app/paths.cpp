// SPDX-License-Identifier: Apache-2.0
#include "app/paths.h"

#include <cstdlib>

#include "base/error.h"
#include "base/file.h"

namespace sward::app {
namespace {

namespace fs = std::filesystem;

/// An absolute path from the environment: the XDG rules ignore relative ones.
fs::path from_environment(const char* name) {
    const char* const value = std::getenv(name);
    const fs::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : fs::path();
}

fs::path installed_directory() {
    return base::executable_directory().parent_path() / "share" / "sward";
}

bool is_installed() {
    std::error_code ignored;
    return fs::is_directory(installed_directory(), ignored);
}

} // namespace

fs::path data_directory() {
    return is_installed() ? installed_directory() : fs::path(SWARD_SOURCE_DIR);
}

fs::path default_scene() {
    return data_directory() / "terrains" / "jacksboro" / "scene.toml";
}

fs::path presets_directory() {
    return is_installed() ? installed_directory() / "presets"
                          : fs::path(SWARD_SOURCE_DIR) / "texgen" / "presets";
}

fs::path vehicles_directory() {
    return data_directory() / "vehicles";
}

fs::path aircraft_directory() {
    return data_directory() / "aircraft";
}

fs::path texgen_program() {
    return base::executable_directory() / "texgen";
}

namespace {

fs::path cache_directory() {
    fs::path cache = from_environment("XDG_CACHE_HOME");
    if (cache.empty()) {
        const fs::path home = from_environment("HOME");
        if (home.empty())
            throw base::Error(base::ExitCode::kIo,
                              "cache of grass sets: found neither XDG_CACHE_HOME nor HOME, "
                              "expected an absolute path in one of them");
        cache = home / ".cache";
    }
    return cache / "sward";
}

} // namespace

fs::path set_cache_directory() {
    return cache_directory() / "sets";
}

fs::path sphere_cache_directory() {
    return cache_directory() / "spheres";
}

fs::path recent_file() {
    fs::path state = from_environment("XDG_STATE_HOME");
    if (state.empty()) {
        const fs::path home = from_environment("HOME");
        if (home.empty())
            return {};
        state = home / ".local" / "state";
    }
    return state / "sward" / "recent-scenes";
}

} // namespace sward::app
