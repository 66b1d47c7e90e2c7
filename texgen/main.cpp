// SPDX-License-Identifier: Apache-2.0
// texgen: a species preset becomes a grass set (docs/texgen.md).
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "texgen/preset.h"
#include "texgen/writer.h"

namespace {

using namespace sward;
namespace fs = std::filesystem;

struct Options {
    std::string preset;
    std::string output;
    std::vector<std::pair<std::string, std::string>> overrides = {{"--seed", "seed"},
                                                                  {"--variants", "patch.variants"},
                                                                  {"--size", "texture.size"},
                                                                  {"--layers", "texture.layers"},
                                                                  {"--slices", "texture.slices"}};
    std::vector<std::int64_t> values = std::vector<std::int64_t>(overrides.size(), -1);
    int threads = 0;
    bool no_preview = false;
    bool no_volume = false;
    bool quiet = false;
    bool verbose = false;
};

/// The options and their help, declared once.
void declare(CLI::App& app, Options& o, std::vector<CLI::Option*>& set_numbers) {
    app.add_option("PRESET", o.preset,
                   "species preset: a TOML file, or the name of a shipped one (meadow, lawn)")
        ->required();
    app.add_option("-o,--output", o.output,
                   "directory of the grass set; an earlier set there is replaced")
        ->required();
    // CLI11 reads an empty text as 0.
    const auto some_number = [](const std::string& text) {
        return text.empty() ? std::string("found nothing, expected a number") : std::string();
    };
    const char* help[] = {"random seed; the same seed gives the same bytes",
                          "patches that may stand side by side",
                          "texels a side at level 0, a power of two",
                          "horizontal layers at level 0", "vertical slices an axis at level 0"};
    for (std::size_t i = 0; i < o.overrides.size(); ++i)
        set_numbers.push_back(
            app.add_option(o.overrides[i].first, o.values[i], help[i])
                ->type_name("N")
                ->check(some_number));
    app.add_option("--threads", o.threads,
                   "worker threads, 0 for one a core; the result is the same")
        ->type_name("N")
        ->check(CLI::Range(0, 1024));
    app.add_flag("--no-preview", o.no_preview, "leave out preview.png");
    app.add_flag("--no-volume", o.no_volume,
                 "leave out volume.vdb (the renderer does not read it)");
    app.add_flag("-q,--quiet", o.quiet, "errors and warnings only");
    app.add_flag("-v,--verbose", o.verbose, "time each step");
    app.set_version_flag("--version", fmt::format("texgen {}", SWARD_VERSION));
}

void run(const Options& o, const std::vector<CLI::Option*>& set_numbers) {
    const std::vector<fs::path> folders = {SWARD_PRESETS,
                                           base::executable_directory() / "../share/sward/presets"};
    const fs::path path = texgen::find_preset(o.preset, folders);
    texgen::Preset preset = texgen::load_preset(path);
    for (std::size_t i = 0; i < set_numbers.size(); ++i)
        if (set_numbers[i]->count() > 0)
            texgen::override_preset(preset, o.overrides[i].first, o.overrides[i].second,
                                    o.values[i]);
    texgen::check_preset(preset, path);
    // "sets/meadow/" names the same directory as "sets/meadow".
    fs::path output = fs::path(o.output).lexically_normal();
    if (!output.has_filename())
        output = output.parent_path();
    texgen::require_set_place(output);
    texgen::BakeOptions options;
    options.threads = o.threads;
    options.preview = !o.no_preview;
    options.volume = !o.no_volume;
    texgen::write_set(texgen::bake_set(preset, options), preset, output, options);
}

int exit_code(base::ExitCode code) {
    return static_cast<int>(code);
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Bakes a grass set: blades, layers and slices of one species.", "texgen");
    std::vector<CLI::Option*> set_numbers;
    declare(app, options, set_numbers);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& done) { // --help, --version
        return app.exit(done);
    } catch (const CLI::ParseError& problem) {
        base::log_error(base::printable(problem.what(), 200));
        return exit_code(base::ExitCode::kUsage);
    }
    base::set_verbosity(options.quiet     ? base::Verbosity::kQuiet
                        : options.verbose ? base::Verbosity::kVerbose
                                          : base::Verbosity::kNormal);
    base::install_signal_cleanup();
    try {
        run(options, set_numbers);
        return exit_code(base::ExitCode::kDone);
    } catch (const base::Error& error) {
        base::log_error(error.what());
        return exit_code(error.code());
    } catch (const std::bad_alloc&) {
        base::log_error("out of memory");
        return exit_code(base::ExitCode::kOverLimit);
    } catch (const std::exception& error) {
        base::log_error(error.what());
        return exit_code(base::ExitCode::kFailure);
    }
}
