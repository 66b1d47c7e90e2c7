// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"
#include "texgen/commands.h"
#include "texgen/preset.h"
#include "texgen/writer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;

Preset preset_of(const BakeCommandOptions& o) {
    const std::vector<fs::path> folders = {SWARD_PRESETS,
                                           base::executable_directory() / "../share/sward/presets"};
    const fs::path path = find_preset(o.preset, folders);
    Preset preset = load_preset(path);
    for (const Override& change : o.overrides)
        override_preset(preset, change.option, change.key, change.value);
    check_preset(preset, path);
    return preset;
}

} // namespace

int run_bake(const BakeCommandOptions& o) {
    base::set_verbosity(o.verbosity);
    const Preset preset = preset_of(o);
    require_set_place(o.output);
    BakeOptions options;
    options.threads = o.threads;
    options.preview = o.preview;
    options.volume = o.volume;
    options.compression = o.compression.zstd_level;
    write_set(bake_set(preset, options), preset, o.output, options);
    return 0;
}

} // namespace sward::texgen
