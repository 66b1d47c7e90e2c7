// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cstdio>

#include "base/error.h"
#include "base/file.h"
#include "texgen/commands.h"
#include "texgen/preset.h"
#include "texgen/report.h"
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
    preset.wrap = o.wrap;
    preset.height_map = o.height_map.value_or(preset.height_map);
    check_preset(preset, path);
    return preset;
}

void require_preview_place(const fs::path& file, const fs::path& output) {
    base::require_writable(file);
    std::error_code ignored;
    if (fs::weakly_canonical(file, ignored).parent_path() == fs::weakly_canonical(output, ignored))
        throw base::input_error(base::ExitCode::kIo, file, 0, "--preview", "a file inside the set",
                                "a place outside of it");
}

} // namespace

int run_bake(const BakeCommandOptions& o) {
    base::set_verbosity(o.verbosity);
    const Preset preset = preset_of(o);
    require_set_place(o.output);
    if (o.preview_file)
        require_preview_place(*o.preview_file, o.output);
    BakeOptions options;
    options.threads = o.threads;
    options.preview = o.preview;
    options.volume = o.volume;
    options.compression = o.compression.zstd_level;
    options.block = o.compression.block;
    options.check_nan = o.check_nan;
    options.preview_file = o.preview_file;
    const auto start = std::chrono::steady_clock::now();
    const grass::GrassSet set = bake_set(preset, options);
    const std::vector<FileEntry> files = write_set(set, preset, o.output, options);
    if (o.json) {
        SetReport report = report_of(set, o.output.string(), files);
        report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        std::fputs(report_json(report).c_str(), stdout);
    }
    return 0;
}

} // namespace sward::texgen
