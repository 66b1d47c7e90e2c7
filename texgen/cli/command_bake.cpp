// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"
#include "texgen/bake/writer.h"
#include "texgen/cli/commands.h"
#include "texgen/cli/dry_run.h"
#include "texgen/cli/export.h"
#include "texgen/patch/patch_size.h"
#include "texgen/preset/preset.h"
#include "texgen/report/report.h"
#include "texgen/support/output_place.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> preset_folders() {
    return {SWARD_PRESETS, base::executable_directory() / "../share/sward/presets"};
}

/// Options as they were given: "--size 64, --levels 3".
std::string shown(const BakeCommandOptions& o) {
    std::vector<std::string> words;
    for (const Override& change : o.overrides)
        words.push_back(fmt::format("{} {}", change.option, change.value));
    if (o.height_map)
        words.push_back(fmt::format("--height-map {}",
                                    kHeightMapNames.at(static_cast<std::size_t>(*o.height_map))));
    return fmt::format("{}", fmt::join(words, ", "));
}

/// A smaller --size has room for fewer levels; who asked for levels as well is told instead.
/// Returns what there is to say of it.
std::string lower_levels(Preset& preset, const BakeCommandOptions& o) {
    const auto given = [&](const char* key) {
        return std::ranges::find(o.overrides, key, &Override::key) != o.overrides.end();
    };
    if (!given("texture.size") || given("texture.levels"))
        return {};
    const std::int64_t wanted = preset.levels;
    while (preset.levels > 1 && preset.size >> (preset.levels - 1) < kLeastLevelTexels)
        --preset.levels;
    return preset.levels == wanted
               ? ""
               : fmt::format("--size {}: {} levels instead of {}, the last of {} texels",
                             preset.size, preset.levels, wanted,
                             preset.size >> (preset.levels - 1));
}

Preset preset_of(const BakeCommandOptions& o) {
    const fs::path path = find_preset(o.preset, preset_folders());
    Preset preset = load_preset(path);
    for (const Override& change : o.overrides)
        override_preset(preset, change.option, change.key, change.value);
    preset.wrap = o.wrap;
    preset.height_map = o.height_map.value_or(preset.height_map);
    const std::string fewer_levels = lower_levels(preset, o);
    try {
        check_preset(preset, path);
    } catch (const base::Error& error) { // the file was right by itself: it is the options
        std::string text = error.what();
        if (const std::string file = base::printable(path.string(), 300) + ": ";
            text.starts_with(file))
            text.erase(0, file.size());
        throw base::Error(error.code() == base::ExitCode::kBadInput ? base::ExitCode::kUsage
                                                                    : error.code(),
                          shown(o) + ": " + text);
    }
    if (!fewer_levels.empty())
        base::log_info(fewer_levels);
    return preset;
}

/// The first sentence of the comment that a preset begins with.
std::string description(const fs::path& preset) {
    const std::string text = base::read_text(preset, 1 << 20);
    std::string words;
    for (std::size_t at = 0; at < text.size() && text[at] == '#';) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at + 1, end - at - 1);
        if (line.find("SPDX") == std::string::npos)
            words += line;
        at = end + 1;
    }
    words.erase(0, words.find_first_not_of(' '));
    return words.substr(0, words.find(". "));
}

std::string preset_list(bool json) {
    std::map<std::string, std::string> presets;
    std::error_code ignored;
    for (const fs::path& folder : preset_folders())
        for (const auto& entry : fs::directory_iterator(folder, ignored))
            if (entry.path().extension() == ".toml")
                presets.emplace(entry.path().stem().string(), description(entry.path()));
    if (json)
        return nlohmann::ordered_json(presets).dump(2) + "\n";
    std::string text;
    for (const auto& [name, words] : presets)
        text += fmt::format("{:<12}{}\n", name, words);
    return text;
}

void require_preview_place(const fs::path& file, const fs::path& output) {
    base::require_writable(file);
    std::error_code ignored;
    if (fs::weakly_canonical(file, ignored).parent_path() == fs::weakly_canonical(output, ignored))
        throw base::input_error(base::ExitCode::kIo, file, 0, "--preview", "a file inside the set",
                                "a place outside of it");
}

BakeOptions bake_options(const BakeCommandOptions& o) {
    BakeOptions options;
    options.threads = o.threads;
    options.preview = o.preview;
    options.volume = o.volume;
    options.compression = o.compression.zstd_level;
    options.block = o.compression.block;
    options.check_nan = o.check_nan;
    options.preview_file = o.preview_file;
    return options;
}

/// --dry-run. The place is looked at where there is one.
int tell(const BakeCommandOptions& o, const Preset& preset) {
    std::error_code ignored;
    if (!o.output.empty() && fs::exists(fs::absolute(o.output).parent_path(), ignored))
        require_set_place(o.output);
    SetReport report = dry_run(preset, bake_options(o));
    report.path = o.output.string();
    print_result(o.json ? report_json(report) : report_text(report));
    return 0;
}

} // namespace

int run_bake(const BakeCommandOptions& o) {
    base::set_verbosity(o.verbosity);
    if (o.list) {
        print_result(preset_list(o.json));
        return 0;
    }
    const Preset preset = preset_of(o);
    if (o.dry_run)
        return tell(o, preset);
    const OutputParents parents(o.output), preview_parents(o.preview_file.value_or(o.output));
    require_set_place(o.output);
    if (o.preview_file)
        require_preview_place(*o.preview_file, o.output);
    if (o.export_format != ExportFormat::kNone)
        require_export_place(export_directory(o.output, o.export_format));
    const BakeOptions options = bake_options(o);
    const auto start = std::chrono::steady_clock::now();
    const grass::GrassSet set = bake_set(preset, options);
    const std::vector<FileEntry> files = write_set(set, preset, o.output, options);
    if (o.export_format != ExportFormat::kNone)
        export_pictures(set, export_directory(o.output, o.export_format), o.export_format,
                        o.threads);
    if (o.json) {
        SetReport report = report_of(set, o.output.string(), files);
        report.seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        print_result(report_json(report));
    }
    return 0;
}

} // namespace sward::texgen
