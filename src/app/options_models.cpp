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

/// What is shipped, or a file; `kinds` says so.
CLI::Option* declare_model(CLI::App& app, const std::string& name, const std::string& value,
                           const std::string& kinds, std::string* model) {
    return declare(app, name, value, kinds + ": the keyboard steers it",
                   [=](const std::string& text) {
                       if (text.empty() || text.find('\0') != std::string::npos)
                           throw option_error(name, text, kinds);
                       *model = text;
                   })
        ->excludes("--replay")
        ->excludes("--native-fdm");
}

} // namespace

void declare_models(CLI::App& app, Options* o) {
    declare_model(app, "--drive", "VEHICLE", "car, tractor or a vehicle's file", &o->drive);
    declare_model(app, "--fly", "AIRCRAFT", "trainer, helicopter or an aircraft's file", &o->fly)
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
