// SPDX-License-Identifier: Apache-2.0
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "app/option_declare.h"
#include "app/parse.h"

namespace sward::app {

CLI::Option* declare(CLI::App& app, const std::string& name, const std::string& value,
                     const std::string& help, std::function<void(const std::string&)> parse) {
    return app.add_option_function<std::string>(name, std::move(parse), help)->type_name(value);
}

namespace {

/// Several machines, one flight.
void declare_machines(CLI::App& app, Options* o) {
    constexpr const char* kForm = "udp:PORT or udp:HOST:PORT, such as udp:5570";
    declare(app, "--master", "udp:[HOST:]PORT",
            "other machines follow this flight and draw the same moment: they come to this port. "
            "Without HOST from this machine alone",
            [=](const std::string& text) { o->master = parse_endpoint("--master", text, kForm); });
    declare(app, "--follow", "udp:[HOST:]PORT",
            "draws what the master at that address flies, bit for bit from its beginning on",
            [=](const std::string& text) {
                o->follow = parse_endpoint("--follow", text, kForm);
                if (o->follow->port == 0)
                    throw option_error("--follow", text, kForm);
            })
        ->excludes("--master")
        ->excludes("--native-fdm")
        ->excludes("--camera")
        ->excludes("--time")
        ->excludes("--density");
}

} // namespace

void declare_network(CLI::App& app, Options* o) {
    declare(app, "--native-fdm", "udp:[HOST:]PORT",
            "the eye is where another program's aircraft is: FlightGear's net_fdm, as JSBSim and "
            "FlightGear send it. Without HOST from this machine alone",
            [=](const std::string& text) {
                o->native_fdm = parse_endpoint("--native-fdm", text,
                                               "udp:PORT or udp:HOST:PORT, such as udp:5550");
            });
    declare(app, "--udp-out", "udp:HOST:PORT",
            "tells a program once a picture the ground's height, what stands on it and the wind, "
            "under the aircraft",
            [=](const std::string& text) {
                o->udp_out =
                    parse_endpoint("--udp-out", text, "udp:HOST:PORT, such as udp:127.0.0.1:5560");
                if (o->udp_out->host.empty() || o->udp_out->port == 0)
                    throw option_error("--udp-out", text,
                                       "udp:HOST:PORT, such as udp:127.0.0.1:5560");
            });
    declare_machines(app, o);
}

} // namespace sward::app
