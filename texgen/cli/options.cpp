// SPDX-License-Identifier: Apache-2.0
// Every option of texgen, declared once. Values are read here and not by CLI11, whose own
// conversions follow the locale and take an empty text for 0.
#include "texgen/cli/options.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <memory>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "base/command_line.h"
#include "base/error.h"
#include "texgen/cli/commands.h"
#include "texgen/cli/usage_error.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxThreads = 1024;
constexpr int kMaxZstdLevel = 19;

/// A whole number of any size that fits; the range of the value is its reader's.
std::int64_t whole_number(std::string_view option, std::string_view text,
                          std::string_view expected) {
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end)
        throw usage(option, text, expected);
    return value;
}

/// "-o,--output" -> "--output".
std::string shown_name(const std::string& name) {
    return name.substr(name.rfind(',') + 1);
}

CLI::Option* declare(CLI::App& app, const std::string& name, const std::string& value,
                     const std::string& help, std::function<void(const std::string&)> parse) {
    return app.add_option_function<std::string>(name, std::move(parse), help)->type_name(value);
}

CLI::Option* declare_path(CLI::App& app, const std::string& name, const std::string& value,
                          const std::string& help, std::function<void(fs::path)> take) {
    return declare(app, name, value, help, [=](const std::string& text) {
        if (text.empty() || text.find('\0') != std::string::npos)
            throw usage(shown_name(name), text, "a name");
        if (text.front() == '-') // an option that stands where the name was forgotten
            throw usage(shown_name(name), text,
                        fmt::format("a name (./{} for one with a dash)", base::printable(text)));
        take(text);
    });
}

CLI::Option* declare_path(CLI::App& app, const std::string& name, const std::string& value,
                          const std::string& help, fs::path& path) {
    return declare_path(app, name, value, help, [&path](const fs::path& p) { path = p; });
}

/// "sets/meadow/" names the same directory as "sets/meadow".
fs::path directory_name(const fs::path& path) {
    const fs::path normal = path.lexically_normal();
    return normal.has_filename() ? normal : normal.parent_path();
}

void declare_common(CLI::App& app, CommonOptions& o) {
    declare(app, "--threads", "N", "worker threads, 0 for one a core; the result is the same",
            [&o](const std::string& text) {
                const std::string expected =
                    fmt::format("a whole number from 0 to {}", kMaxThreads);
                const std::int64_t n = whole_number("--threads", text, expected);
                if (n < 0 || n > kMaxThreads)
                    throw usage("--threads", text, expected);
                o.threads = static_cast<int>(n);
            });
    app.add_flag("--json", o.json, "the report as JSON on standard output");
    const auto verbosity = [&](const char* name, const char* help, base::Verbosity value) {
        return app.add_flag_callback(
            name, [&o, value] { o.verbosity = value; }, help);
    };
    verbosity("-q,--quiet", "errors and warnings only", base::Verbosity::kQuiet)
        ->excludes(verbosity("-v,--verbose", "time each step", base::Verbosity::kVerbose));
}

Compression parse_compression(const std::string& text) {
    const std::string expected = fmt::format("none, zstd, zstd:1 to zstd:{}, or bc", kMaxZstdLevel);
    if (text == "none")
        return {.zstd_level = 0};
    if (text == "zstd")
        return {};
    if (text == "bc")
        return {.block = true};
    if (!text.starts_with("zstd:"))
        throw usage("--compression", text, expected);
    const std::int64_t level =
        whole_number("--compression", std::string_view(text).substr(5), expected);
    if (level < 1 || level > kMaxZstdLevel)
        throw usage("--compression", text, expected);
    return {.zstd_level = static_cast<int>(level)};
}

void declare_overrides(CLI::App& app, BakeCommandOptions& o) {
    static constexpr struct {
        const char *option, *key, *help;
    } kOverrides[] = {
        {"--seed", "seed", "random seed; the same seed gives the same bytes"},
        {"--size", "texture.size", "texels a side at level 0, a power of two"},
        {"--variants", "patch.variants", "patches that may stand side by side"},
        {"--layers", "texture.layers", "horizontal layers at level 0"},
        {"--slices", "texture.slices", "vertical slices an axis at level 0"},
        {"--levels", "texture.levels", "levels, each of half the size, layers and slices"},
        {"--far-rays", "texture.far_rays",
         "rays of a view of the far table and the march's correction: less noise, more time"},
    };
    for (const auto& entry : kOverrides)
        declare(app, entry.option, "N", entry.help, [&o, entry](const std::string& text) {
            const std::int64_t n = whole_number(entry.option, text, "a whole number");
            o.overrides.push_back({entry.option, entry.key, n});
        });
}

void declare_bake(CLI::App& app, BakeCommandOptions& o) {
    declare(app, "PRESET", "PRESET",
            "species preset: a TOML file, or the name of a shipped one (meadow, lawn, wheat, ...)",
            [&o](const std::string& text) {
                if (text.empty())
                    throw usage("PRESET", text, "a file or the name of a shipped preset");
                o.preset = text;
            });
    declare_path(app, "-o,--output", "DIR",
                 "directory of the grass set; an earlier set there is replaced",
                 [&o](const fs::path& path) { o.output = directory_name(path); });
    declare_overrides(app, o);
    declare(app, "--height-map", "linear|top",
            "B1: one height map a variant instead of an image a layer, for little memory; top: "
            "finer near "
            "the canopy's top",
            [&o](const std::string& text) {
                if (text != "linear" && text != "top")
                    throw usage("--height-map", text, "linear or top");
                o.height_map = text == "top" ? HeightMap::kTop : HeightMap::kLinear;
            });
    declare(
        app, "--compression", "none|zstd|zstd:N|bc",
        "of the textures: zstd (level 3) as it stands, N up to 19 smaller and slower; bc: shape "
        "planes as BC5, a quarter less on the GPU",
        [&o](const std::string& text) { o.compression = parse_compression(text); });
    declare(app, "--export", "png|exr",
            "also layers and slices of level 0 as pictures, in the directory DIR-png or DIR-exr",
            [&o](const std::string& text) {
                if (text != "png" && text != "exr")
                    throw usage("--export", text, "png or exr");
                o.export_format = text == "png" ? ExportFormat::kPng : ExportFormat::kExr;
            });
    CLI::Option* preview =
        declare_path(app, "--preview", "FILE", "contact sheet as FILE, instead of DIR/preview.png",
                     [&o](const fs::path& path) { o.preview_file = path; });
    app.add_flag_callback(
           "--no-preview", [&o] { o.preview = false; }, "no contact sheet")
        ->excludes(preview);
    app.add_flag_callback(
        "--no-volume", [&o] { o.volume = false; },
        "leave out volume.vdb (the renderer does not read it)");
    app.add_flag("--checknan", o.check_nan,
                 "look at every number written: exit 1 on NaN or infinity");
    app.add_flag("--dry-run", o.dry_run,
                 "check everything and tell what would be made and what it takes; write nothing; "
                 "needs no --output");
    app.add_flag("--list", o.list, "the shipped presets, a line each");
    app.add_flag_callback(
        "--no-wrap", [&o] { o.wrap = false; },
        "a test tool: cut blades at the patch's edge, so that the set shows its joints");
    declare_common(app, o);
}

/// A finite number in [low, high], read without a locale.
void declare_real(CLI::App& app, const std::string& name, const std::string& help,
                  std::pair<double, double> range, double& out) {
    declare(app, name, "N", help, [=, &out](const std::string& text) {
        const std::string expected =
            fmt::format("a number from {} to {}", range.first, range.second);
        double value = 0;
        const char* end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error != std::errc() || stop != end || !(value >= range.first && value <= range.second))
            throw usage(name, text, expected);
        out = value;
    });
}

void declare_count(CLI::App& app, const std::string& name, const std::string& help,
                   std::pair<int, int> range, int& out) {
    declare(app, name, "N", help, [=, &out](const std::string& text) {
        const std::string expected =
            fmt::format("a whole number from {} to {}", range.first, range.second);
        const std::int64_t n = whole_number(name, text, expected);
        if (n < range.first || n > range.second)
            throw usage(name, text, expected);
        out = static_cast<int>(n);
    });
}

void declare_cut(CLI::App& app, double& cut) {
    declare_real(
        app, "--cut",
        "border that is laid over the other side: a share of the side below 1, else texels",
        {0, 8192}, cut);
}

void declare_up(CLI::App& app, bool& z_up) {
    declare(app, "--up", "AXIS", "the file's upward axis, y (default) or z (Blender)",
            [&z_up](const std::string& text) {
                if (text != "y" && text != "z")
                    throw usage("--up", text, "y or z");
                z_up = text == "z";
            });
}

void declare_seam(CLI::App& app, Options& o) {
    declare_path(app, "IN", "IN",
                 "what is to be made seamless: a directory of pictures, a pattern "
                 "(layer.%04d.png), a picture or a .vdb",
                 o.seam.input)
        ->required();
    declare_path(app, "-o,--output", "OUT",
                 "a directory for a stack, a file for a picture or a .vdb",
                 [&o](const fs::path& path) { o.seam.output = directory_name(path); })
        ->required();
    declare_cut(app, o.seam.cut);
    declare_up(app, o.seam.z_up);
    declare_common(app, o.seam);
}

void declare_import(CLI::App& app, Options& o) {
    declare_path(app, "FILE", "FILE",
                 "volume of another program (.vdb), or a directory of pictures with its stack.json",
                 [&o](const fs::path& path) { o.import.input = directory_name(path); })
        ->required();
    declare_path(app, "-o,--output", "DIR", "directory of the grass set",
                 [&o](const fs::path& path) { o.import.output = directory_name(path); })
        ->required();
    declare_up(app, o.import.z_up);
    declare_real(app, "--scale", "metres a unit of the file", {1e-6, 1e6}, o.import.scale);
    declare_real(app, "--period",
                 "metres after which the volume repeats; default as the file says, else its box",
                 {1e-4, 1e4}, o.import.period_m);
    declare_real(app, "--side", "metres a side of a stack of pictures, instead of its stack.json's",
                 {0.01, 1000}, o.import.side_m);
    declare_real(app, "--canopy", "metres from the ground to the top of a stack, likewise",
                 {1e-4, 100}, o.import.canopy_m);
    declare_real(app, "--density", "factor on the file's density: 1 is an opaque voxel",
                 {1e-6, 1e6}, o.import.density);
    declare(app, "--size", "N",
            "texels a side at level 0, a power of two; default nearest to the voxels",
            [&o](const std::string& text) {
                const std::int64_t n =
                    whole_number("--size", text, "a power of two from 32 to 2048");
                if (n < 32 || n > 2048 || (n & (n - 1)) != 0)
                    throw usage("--size", text, "a power of two from 32 to 2048");
                o.import.size = static_cast<int>(n);
            });
    declare_count(app, "--layers", "horizontal layers at level 0", {2, 256}, o.import.layers);
    declare_count(app, "--slices", "vertical slices an axis at level 0", {2, 256}, o.import.slices);
    declare_count(app, "--levels", "levels, each of half the size, layers and slices", {1, 4},
                  o.import.levels);
    declare_count(
        app, "--far-rays",
        "rays of a view of the far table and the march's correction: less noise, more time",
        {256, 1048576}, o.import.far_rays);
    app.add_flag("--seam", o.import.seam, "make the volume periodic first, as texgen seam does");
    declare_cut(app, o.import.cut);
    declare(app, "--name", "NAME", "name of the set", [&o](const std::string& text) {
        const bool plain =
            !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](char c) {
                return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
            });
        if (!plain)
            throw usage("--name", text, "1 to 64 letters, digits, - and _");
        o.import.name = text;
    });
    declare(app, "--compression", "none|zstd|zstd:N|bc", "of the textures, as for a preset",
            [&o](const std::string& text) { o.import.compression = parse_compression(text); });
    app.add_flag_callback(
        "--no-preview", [&o] { o.import.preview = false; }, "leave out preview.png");
    declare_common(app, o.import);
}

void declare_export(CLI::App& app, Options& o) {
    ExportCommandOptions& e = o.exporting;
    declare_path(app, "SET", "SET", "a grass set's directory", [&e](const fs::path& path) {
        e.input = directory_name(path);
    })->required();
    declare_path(app, "-o,--output", "DIR",
                 "directory for the files; an earlier export there is replaced",
                 [&e](const fs::path& path) { e.output = directory_name(path); })
        ->required();
    declare(app, "--for", "gltf|textures|blender",
            "gltf: triangles with levels of detail; textures: albedo and tangents as arrays and "
            "atlases, the far field's data; blender: "
            "triangles, points and the volume",
            [&e](const std::string& text) {
                static constexpr std::pair<const char*, ExportTarget> kTargets[] = {
                    {"gltf", ExportTarget::kGltf},
                    {"textures", ExportTarget::kTextures},
                    {"blender", ExportTarget::kBlender}};
                const auto* found = std::ranges::find(kTargets, text, [](const auto& entry) {
                    return std::string_view(entry.first);
                });
                if (found == std::end(kTargets))
                    throw usage("--for", text, "gltf, textures or blender");
                e.target = found->second;
            })
        ->required();
    declare(app, "--compression", "none|zstd|zstd:N", "of the KTX2 files, as for a preset",
            [&e](const std::string& text) {
                e.compression = parse_compression(text);
                if (e.compression.block)
                    throw usage("--compression", text,
                                "none, zstd or zstd:N: bc packs what other engines do not get");
            });
    app.add_flag_callback(
        "--no-atlas", [&e] { e.atlases = false; }, "texture arrays alone");
    declare_common(app, e);
}

void declare_inspect(CLI::App& app, Options& o) {
    declare_path(app, "SET", "SET", "a grass set's directory, a .ktx2 or a .vdb file",
                 o.inspect.input)
        ->required();
    declare_common(app, o.inspect);
}

void declare_verify(CLI::App& app, Options& o) {
    declare_path(app, "SET", "SET", "a grass set's directory", o.verify.input)->required();
    declare_common(app, o.verify);
}

/// A command beside the default one: a line here, a function in commands.h, a struct in options.h.
struct Subcommand {
    const char* name;
    const char* help;
    void (*declare)(CLI::App&, Options&);
    int (*run)(const Options&);
};

constexpr Subcommand kSubcommands[] = {
    {"seam", "make a layer stack or a volume seamless", declare_seam,
     [](const Options& o) { return run_seam(o.seam); }},
    {"import", "turn a volume or a stack of pictures into a far-only set", declare_import,
     [](const Options& o) { return run_import(o.import); }},
    {"export", "write a set's meshes, textures or volume for other engines", declare_export,
     [](const Options& o) { return run_export(o.exporting); }},
    {"inspect", "print what is in a set or a file", declare_inspect,
     [](const Options& o) { return run_inspect(o.inspect); }},
    {"verify", "check every hash and limit of a set", declare_verify,
     [](const Options& o) { return run_verify(o.verify); }},
};

/// What CLI11 cannot say: the default command's arguments are required only where no other is
/// named.
void check_bake(const CLI::App& app, const Options& o) {
    if (o.run) {
        for (const CLI::Option* option : app.get_options())
            if (option->count() > 0)
                throw base::Error(base::ExitCode::kUsage,
                                  fmt::format("{}: found before a command, expected after it",
                                              option->get_name()));
        return;
    }
    if (o.bake.list)
        return;
    const bool nowhere = o.bake.output.empty() && !o.bake.dry_run;
    if (o.bake.preset.empty() || nowhere)
        throw base::Error(base::ExitCode::kUsage,
                          fmt::format("{}: found nothing, expected one: see `texgen --help`",
                                      o.bake.preset.empty() ? "PRESET" : "--output"));
}

} // namespace

Options parse_options(int argc, char** argv) {
    Options o;
    CLI::App app("Bakes a grass set: blades, layers and slices.", "texgen");
    app.require_subcommand(0, 1)->set_version_flag("--version", "texgen " SWARD_VERSION);
    declare_bake(app, o.bake);
    for (const Subcommand& command : kSubcommands) {
        CLI::App* sub = app.add_subcommand(command.name, command.help);
        command.declare(*sub, o);
        sub->parse_complete_callback([&o, run = command.run] { o.run = run; });
    }
    base::refuse_flag_values(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        o.help = app.help();
        return o;
    } catch (const CLI::Success& done) { // --version
        o.help = std::string(done.what()) + "\n";
        return o;
    } catch (const CLI::ParseError& problem) {
        throw usage_error(app, problem);
    } catch (const base::Error&) { // a value, perhaps of an option that there is not
        if (base::has_unknown_option(app))
            throw usage_error(app, CLI::ExtrasError(app.remaining(true)));
        throw;
    }
    check_bake(app, o);
    if (!o.run)
        o.run = [](const Options& all) { return run_bake(all.bake); };
    return o;
}

} // namespace sward::texgen
