// SPDX-License-Identifier: Apache-2.0
#include <chrono>

#include "base/error.h"
#include "base/file.h"
#include "texgen/commands.h"
#include "texgen/dry_run.h"
#include "texgen/export.h"
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
    if (o.export_format != ExportFormat::kNone)
        require_export_place(export_directory(o.output, o.export_format));
    BakeOptions options;
    options.threads = o.threads;
    options.preview = o.preview;
    options.volume = o.volume;
    options.compression = o.compression.zstd_level;
    options.block = o.compression.block;
    options.check_nan = o.check_nan;
    options.preview_file = o.preview_file;
    if (o.dry_run) {
        SetReport report = dry_run(preset, options);
        report.path = o.output.string();
        print_result(o.json ? report_json(report) : report_text(report));
        return 0;
    }
    const auto start = std::chrono::steady_clock::now();
    const grass::GrassSet set = bake_set(preset, options);
    const std::vector<FileEntry> files = write_set(set, preset, o.output, options);
    if (o.export_format != ExportFormat::kNone)
        export_pictures(set, export_directory(o.output, o.export_format), o.export_format, o.threads);
    if (o.json) {
        SetReport report = report_of(set, o.output.string(), files);
        report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        print_result(report_json(report));
    }
    return 0;
}

} // namespace sward::texgen
