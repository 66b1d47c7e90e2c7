// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "app/option_declare.h"
#include "app/parse.h"

namespace sward::app {
namespace {

constexpr std::array<std::pair<std::string_view, drive::Surface>, drive::kSurfaces> kSurfaces = {
    {{"grass", drive::Surface::kGrass},
     {"wet", drive::Surface::kWetGrass},
     {"road", drive::Surface::kRoad},
     {"soil", drive::Surface::kSoil},
     {"sand", drive::Surface::kSand}}};

} // namespace

void declare_models(CLI::App& app, Options* o) {
    declare(app, "--drive", "VEHICLE", "car, tractor or a vehicle's file: the keyboard drives it",
            [=](const std::string& text) {
                if (text.empty() || text.find('\0') != std::string::npos)
                    throw option_error("--drive", text, "car, tractor or a vehicle's file");
                o->drive = text;
            })
        ->excludes("--replay")
        ->excludes("--native-fdm");
    declare(app, "--fly", "AIRCRAFT",
            "trainer, helicopter or an aircraft's file: the keyboard flies it",
            [=](const std::string& text) {
                if (text.empty() || text.find('\0') != std::string::npos)
                    throw option_error("--fly", text, "trainer, helicopter or an aircraft's file");
                o->fly = text;
            })
        ->excludes("--replay")
        ->excludes("--native-fdm")
        ->excludes("--drive");
    declare(
        app, "--tyres-on", "grass|wet|road|soil|sand",
        "what the vehicle's tyres stand on; default: what lies under each. wet: that, and its "
        "grass is wet",
        [=](const std::string& text) { o->tyres = parse_choice("--tyres-on", text, kSurfaces); })
        ->needs("--drive");
    app.add_flag("--no-wake", o->no_wake,
                 "what drives and flies moves no air: saves the wind's local window");
}

} // namespace sward::app
