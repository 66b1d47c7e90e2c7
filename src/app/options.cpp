// SPDX-License-Identifier: Apache-2.0
// With the other options_*.cpp the only file that includes CLI11. Every value goes through parse.h:
// CLI11's own conversions follow the locale and let "64px" pass.
#include "app/options.h"

#include <algorithm>
#include <array>
#include <functional>
#include <tuple>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <fmt/format.h>

#include "app/io.h"
#include "app/option_declare.h"
#include "app/parse.h"
#include "base/command_line.h"

namespace sward::app {
namespace {

using render::HandoverMode;
using render::Tiers;

constexpr std::array<std::pair<std::string_view, render::FarScheme>, 3> kFarSchemes = {
    {{"march", render::FarScheme::kMarch},
     {"planes", render::FarScheme::kPlanes},
     {"published", render::FarScheme::kPublished}}};
constexpr std::array<std::pair<std::string_view, Tiers>, 4> kTiers = {
    {{"all", Tiers::kAll},
     {"blades", Tiers::kBlades},
     {"shells", Tiers::kShells},
     {"reference", Tiers::kReference}}};
constexpr std::array<std::pair<std::string_view, HandoverMode>, 4> kHandovers = {
    {{"rank", HandoverMode::kRank},
     {"off", HandoverMode::kOff},
     {"hard", HandoverMode::kHard},
     {"fade", HandoverMode::kFade}}};
constexpr std::array<std::pair<std::string_view, int>, 3> kSamples = {
    {{"1", 1}, {"2", 2}, {"4", 4}}};

constexpr std::array<std::pair<std::string_view, const char*>, 5> kSuites = {
    {{"all", "all"}, {"far", "far"}, {"near", "near"}, {"tracks", "tracks"}, {"wind", "wind"}}};

constexpr NumberRange kTime{0, 1e9, "seconds"};
constexpr NumberRange kStep{1e-6, 10, "seconds"};
constexpr NumberRange kExposure{1e-6, 1e6, ""};
constexpr NumberRange kDistance{0.1, 10'000, "metres"};
constexpr NumberRange kShare{0, 1, ""};
constexpr NumberRange kGrid{1, 64, ""};
constexpr NumberRange kLevel{0, 31, ""};
constexpr NumberRange kWarm{0, 10'000, ""};
constexpr NumberRange kIndex{0, 4294967295.0, ""};
constexpr NumberRange kEvery{1e-3, 1e6, "seconds"};
constexpr NumberRange kExitAfter{1, 1'000'000, ""};

CLI::Option* declare_path(CLI::App& app, const std::string& name, const std::string& value,
                          const std::string& help, std::filesystem::path* path) {
    const std::string shown = name.substr(name.rfind(',') + 1);
    return declare(app, name, value, help, [=](const std::string& text) {
        if (text.empty() || text.find('\0') != std::string::npos)
            throw option_error(shown, text, "the name of a file");
        if (text.front() == '-') // an option that stands where the name was forgotten
            throw option_error(shown, text,
                               fmt::format("the name of a file (./{} for one with a dash)",
                                           base::printable(text)));
        *path = text;
    });
}

/// Where one looks from, when, and how it is drawn: the same for a picture and for the viewer.
void declare_frame_options(CLI::App& app, Options* o) {
    declare(app, "--size", "WxH", "pixels; default 1280x720", [=](const std::string& text) {
        std::tie(o->frame.width, o->frame.height) = parse_size("--size", text);
    });
    declare(
        app, "--camera", "NAME|x,y,z,yaw,pitch",
        "a camera of the scene, or a pose: metres (y above the ground, or above the datum after "
        "\"abs:\") and degrees; or geo:LAT,LON,HEIGHT,YAW,PITCH",
        [=](const std::string& text) {
            if (text.empty())
                throw option_error("--camera", text, "a camera of the scene, or a pose");
            if (text.find(',') != std::string::npos)
                static_cast<void>(scene::parse_pose(text, "--camera"));
            o->camera = text;
        });
    declare(app, "--time", "SECONDS", "simulated time; default 0",
            [=](const std::string& text) { o->time_s = parse_number("--time", text, kTime); });
    declare(app, "--fixed-timestep", "SECONDS",
            "simulated time from one frame to the next; default 1/60. The viewer follows the clock "
            "without it",
            [=](const std::string& text) {
                o->step_s = parse_step("--fixed-timestep", text, kStep);
                o->fixed_step = true;
            });
    declare(
        app, "--tiers", "all|blades|shells|reference", "which tiers draw; default all",
        [=](const std::string& text) { o->frame.tiers = parse_choice("--tiers", text, kTiers); });
    declare(app, "--density", "0..1",
            "share of the set's blades that stand, instead of the scene's",
            [=](const std::string& text) { o->density = parse_number("--density", text, kShare); });
    declare(app, "--samples", "1|2|4", "MSAA; default 4", [=](const std::string& text) {
        o->frame.samples = parse_choice("--samples", text, kSamples);
    });
    declare(app, "--exposure", "FACTOR", "default 1", [=](const std::string& text) {
        o->frame.exposure = static_cast<float>(parse_number("--exposure", text, kExposure));
    });
    declare(
        app, "--far", "march|planes|published",
        "how the far field is drawn; planes: shells and slices one by one; published: the same in "
        "the published shares; both as comparisons",
        [=](const std::string& text) { o->frame.far = parse_choice("--far", text, kFarSchemes); });
    declare(app, "--blades-distance", "METRES", "how far --tiers blades draws; default 200",
            [=](const std::string& text) {
                o->frame.blades_distance_m = parse_number("--blades-distance", text, kDistance);
            });
    declare(app, "--cull", "LIST",
            "none, or of frustum,orientation,distance,occlusion,samples: how unseen blades are "
            "found; default all but orientation",
            [=](const std::string& text) { o->frame.cull = parse_cull("--cull", text); });
    app.add_flag("--debug-gl", o->debug_gl,
                 "an OpenGL debug context; any message is a failure (exit 1)");
}

/// Hooks of the image tests, for both commands.
void declare_test_options(CLI::App& app, Options* o) {
    constexpr const char* kGroup = "For tests";
    declare(app, "--reference-distance", "METRES", "how far --tiers reference draws; default 60",
            [=](const std::string& text) {
                o->frame.reference_distance_m =
                    parse_number("--reference-distance", text, kDistance);
            })
        ->group(kGroup);
    declare(app, "--reference-grid", "N", "--tiers reference averages N x N frames; default 4",
            [=](const std::string& text) {
                o->frame.reference_grid =
                    static_cast<int>(parse_integer("--reference-grid", text, kGrid));
            })
        ->group(kGroup);
    declare(app, "--force-tier", "K", "only level K of the far tier, at every distance",
            [=](const std::string& text) {
                o->frame.force_far_level =
                    static_cast<int>(parse_integer("--force-tier", text, kLevel));
            })
        ->group(kGroup);
    declare(app, "--handover", "rank|off|hard|fade", "how a blade changes tier; default rank",
            [=](const std::string& text) {
                o->frame.handover = parse_choice("--handover", text, kHandovers);
            })
        ->group(kGroup);
}

constexpr std::array<std::pair<std::string_view, bool>, 1> kFormats = {{{"rgb24", true}}};

/// -o and what it may be instead of a file.
void declare_output(CLI::App& app, const std::string& value, Options* o) {
    declare(
        app, "-o,--output", value,
        "the picture; with --frames a name with %d or %04d in it; \"-\" is stdout, with --format",
        [=](const std::string& text) {
            if (text.empty() || text.find('\0') != std::string::npos)
                throw option_error("--output", text, "the name of a file");
            if (text.front() == '-' && text != "-")
                throw option_error("--output", text,
                                   fmt::format("the name of a file (./{} for one with a dash)",
                                               base::printable(text)));
            o->output = text;
        })
        ->required();
    declare(app, "--format", "rgb24",
            "what -o - writes: 3 bytes a pixel, row by row from the top, picture after picture, as "
            "ffmpeg's rawvideo reads them",
            [=](const std::string& text) { o->raw = parse_choice("--format", text, kFormats); });
}

void declare_render(CLI::App& app, Options* o) {
    const std::string extensions = fmt::format("{}", fmt::join(picture_extensions(), "|"));
    declare_path(app, "SCENE", "PATH", "scene file, or directory with scene.toml", &o->scene);
    app.get_option("SCENE")->required();
    declare_output(app, "OUT.(" + extensions + ")", o);
    declare_frame_options(app, o);
    declare(app, "--aov", "LIST",
            "color,depth,tier,coverage,tangent,normal,rank: channels of an .exr",
            [=](const std::string& text) { o->aovs = parse_aovs("--aov", text); });
    declare_path(app, "--stats", "FILE", "times and counts as JSON", &o->stats);
    app.add_flag("--wait-in-passes", o->frame.wait_in_passes,
                 "each pass of --stats waits for the GPU: its time is its own, in software too; "
                 "costs the overlap of passes");
    app.add_flag(
        "--count-steps", o->frame.count_steps,
        "--stats counts the steps of the far field's rays and the texels that they read; slower");
    declare(app, "--path", "NAME", "a camera path of the scene", [=](const std::string& text) {
        if (text.empty())
            throw option_error("--path", text, "a path of the scene");
        o->path = text;
    })->excludes("--camera");
    declare_path(app, "--camera-matrices", "FILE",
                 "a camera as two matrices, JSON: {\"view_from_world\": [16 numbers, row by row], "
                 "\"clip_from_view\": [16]}",
                 &o->camera_matrices)
        ->excludes("--camera")
        ->excludes("--path");
    declare_path(app, "--replay", "FILE",
                 "the camera, the sun and the wind of a flight that `sward view --record` wrote; "
                 "without --frames the whole of it",
                 &o->replay)
        ->excludes("--camera")
        ->excludes("--path")
        ->excludes("--camera-matrices");
    declare_path(app, "--channels", "FILE",
                 "several pictures of every moment, as FILE lists them: OUT-NAME.png for each",
                 &o->channels)
        ->excludes("--size")
        ->excludes("--stats")
        ->excludes("--format");
    declare(app, "--frames", "FIRST:LAST",
            "a sequence, both ends included; frame i is drawn at "
            "--time + i * --fixed-timestep",
            [=](const std::string& text) { o->frames = parse_frames("--frames", text); });
    declare_path(app, "--tracks", "FILE.exr",
                 "what lay pressed at time 0, as --save-tracks wrote it; for scenes with [tracks]",
                 &o->tracks);
    declare_path(app, "--save-tracks", "FILE.exr", "writes what lies pressed at the end",
                 &o->save_tracks);
    declare_test_options(app, o);
    declare(app, "--lod-eye", "x,y,z", "tiers are chosen as if the eye stood here",
            [=](const std::string& text) { o->lod_eye = parse_eye("--lod-eye", text); })
        ->group("For tests");
    declare(app, "--frame-index", "N", "number of the first frame; default 0",
            [=](const std::string& text) {
                o->frame_index =
                    static_cast<std::uint32_t>(parse_integer("--frame-index", text, kIndex));
            })
        ->group("For tests");
    declare(app, "--warm", "N", "draw the first frame N times before the one that counts",
            [=](const std::string& text) {
                o->warm = static_cast<int>(parse_integer("--warm", text, kWarm));
            })
        ->group("For tests");
}

void declare_view(CLI::App& app, Options* o) {
    declare_path(app, "SCENE", "PATH",
                 "scene file, or directory with scene.toml; default: the one that ships",
                 &o->scene);
    declare_frame_options(app, o);
    declare_network(app, o);
    app.add_flag("--list-joysticks", o->list_joysticks,
                 "prints what is plugged in and what controls.toml does with it, and ends");
    declare(app, "--window", "WxH[+X+Y]",
            "the window's size and the place of its corner on the desktop, in pixels",
            [=](const std::string& text) { o->window = parse_window("--window", text); })
        ->excludes("--size");
    declare_path(app, "--record", "FILE",
                 "keeps the flight: inputs, poses, sun and wind at 60 steps a second", &o->record);
    declare_path(app, "--replay", "FILE", "shows a flight that was kept", &o->replay);
    for (const char* const kept : {"--replay", "--record"})
        app.get_option(kept)->excludes("--follow");
    app.get_option("--replay")
        ->excludes("--record")
        ->excludes("--camera")
        ->excludes("--native-fdm");
    declare_path(app, "--channels", "FILE",
                 "several pictures of every moment in one window, as FILE lists them", &o->channels)
        ->excludes("--size")
        ->excludes("--window");
    declare_models(app, o);
    declare_test_options(app, o);
    declare(app, "--frames", "N", "", [=](const std::string& text) {
        o->exit_after = static_cast<int>(parse_integer("--frames", text, kExitAfter));
    })->group(""); // hidden: the smoke test's way out
}

void declare_wind(CLI::App& app, Options* o) {
    declare_path(app, "SCENE", "PATH", "scene file, or directory with scene.toml", &o->scene);
    app.get_option("SCENE")->required();
    declare(app, "--time", "SECONDS", "simulated time",
            [=](const std::string& text) { o->time_s = parse_number("--time", text, kTime); });
    app.get_option("--time")->required();
    declare_path(app, "-o,--output", "OUT.exr",
                 "the picture; with --every a name with %d or %04d in it", &o->output);
    app.get_option("--output")->required();
    declare(app, "--every", "SECONDS", "a picture at 0 and each so many seconds up to --time",
            [=](const std::string& text) { o->every_s = parse_number("--every", text, kEvery); });
    declare(app, "--at", "x,z", "metres; what the window stands around; default 0,0",
            [=](const std::string& text) { o->at = parse_place("--at", text); });
    app.add_flag("--debug-gl", o->debug_gl,
                 "an OpenGL debug context; any message is a failure (exit 1)");
}

void declare_bench(CLI::App& app, Options* o) {
    declare(
        app, "SUITE", "all|far|near|tracks|wind", "what is measured; default all",
        [=](const std::string& text) { o->bench_suite = parse_choice("SUITE", text, kSuites); });
    declare_path(app, "--json", "FILE", "the figures as JSON", &o->bench_json);
    declare(app, "--size", "WxH", "pixels of the suites far and near; default 1280x720 and 512x384",
            [=](const std::string& text) {
                std::tie(o->bench_size.x, o->bench_size.y) = parse_size("--size", text);
            });
    app.add_flag("--full", o->bench_full,
                 "the near suite with seven million blades too: a gigabyte, minutes in software");
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return base::printable(text, 300);
}

/// CLI11's complaint in our form: one line that says what was found and what was expected.
base::Error usage_error(const CLI::ParseError& error, const CLI::App& app) {
    const auto commands = app.get_subcommands();
    const CLI::App& at = commands.empty() ? app : *commands.front();
    const std::string help =
        commands.empty() ? "`sward --help`" : fmt::format("`sward {} --help`", at.get_name());
    // An argument that nothing takes is worth more than what is missing because of it.
    const auto extras = app.remaining(true);
    if (const auto option = std::find_if(extras.begin(), extras.end(), base::is_option);
        option != extras.end())
        return {base::ExitCode::kUsage,
                fmt::format("{}: found an unknown option, expected what {} lists{}",
                            base::printable(*option), help, base::perhaps_option(at, *option))};
    if (!extras.empty())
        return option_error(at.get_name(), extras.front(), fmt::format("what {} lists", help));
    for (const CLI::Option* option : at.get_options()) {
        if (option->get_expected_max() == 1 && option->count() > 1)
            return {base::ExitCode::kUsage, fmt::format("{}: found {} times, expected once",
                                                        option->get_name(), option->count())};
        const std::string said = error.what();
        const std::string name = option->get_name();
        const bool missing =
            said == name + " is required" || said.starts_with(name + ": 1 required");
        if (missing)
            return {base::ExitCode::kUsage,
                    fmt::format("{}: found nothing, expected {}", name, option->get_type_name())};
    }
    return {base::ExitCode::kUsage,
            fmt::format("command line: found \"{}\", expected what {} lists",
                        one_line(error.what()), help)};
}

} // namespace

Options parse_options(int argc, const char* const* argv) {
    Options o;
    bool quiet = false, verbose = false;
    CLI::App app("Grassland from a blade at the wheel to the hill at the horizon.", "sward");
    app.set_version_flag("--version", "sward " SWARD_VERSION);
    app.fallthrough();
    app.require_subcommand(1);
    app.add_flag("-q,--quiet", quiet, "errors and warnings only");
    app.add_flag("-v,--verbose", verbose, "say more")->excludes("--quiet");
    CLI::App* const view = app.add_subcommand("view", "fly through a scene");
    CLI::App* const render =
        app.add_subcommand("render", "a picture or a sequence, without a window");
    CLI::App* const bench =
        app.add_subcommand("bench", "figures of this machine, held to their limits");
    CLI::App* const wind =
        app.add_subcommand("wind", "the wind around a place, as pictures of numbers");
    CLI::App* const info = app.add_subcommand(
        "info", "renderer, limits, versions, paths; or what a scene's terrain is");
    declare_path(
        *info, "SCENE", "PATH",
        "scene file, or directory with scene.toml: its extent, CRS, origin, heights and classes",
        &o.scene);
    declare_view(*view, &o);
    declare_render(*render, &o);
    declare_wind(*wind, &o);
    declare_bench(*bench, &o);
    base::refuse_flag_values(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        o.help = app.help();
        return o;
    } catch (const CLI::CallForVersion& version) {
        o.help = std::string(version.what()) + "\n";
        return o;
    } catch (const CLI::ParseError& error) {
        throw usage_error(error, app);
    } catch (const base::Error&) { // a value, perhaps of an option that there is not
        if (base::has_unknown_option(app))
            throw usage_error(CLI::ExtrasError(app.remaining(true)), app);
        throw;
    }
    o.command = view->parsed()     ? Command::kView
                : render->parsed() ? Command::kRender
                : wind->parsed()   ? Command::kWind
                : bench->parsed()  ? Command::kBench
                                   : Command::kInfo;
    static_cast<void>(info);
    o.verbosity = quiet     ? base::Verbosity::kQuiet
                  : verbose ? base::Verbosity::kVerbose
                            : base::Verbosity::kNormal;
    return o;
}

} // namespace sward::app
