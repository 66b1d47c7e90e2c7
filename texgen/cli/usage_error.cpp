// SPDX-License-Identifier: Apache-2.0
#include "texgen/cli/usage_error.h"

#include <algorithm>
#include <vector>

#include <CLI/App.hpp>
#include <fmt/format.h>

#include "base/command_line.h"

namespace sward::texgen {

base::Error usage(std::string_view option, std::string_view found, std::string_view expected) {
    return base::Error(base::ExitCode::kUsage, fmt::format("{}: found \"{}\", expected {}", option,
                                                           base::printable(found), expected));
}

base::Error usage_error(const CLI::App& app, const CLI::ParseError& problem) {
    const auto commands = app.get_subcommands();
    const CLI::App& at = commands.empty() ? app : *commands.front();
    const std::string command = commands.empty() ? "texgen" : "texgen " + at.get_name();
    const std::vector<std::string> extras = app.remaining(true);
    const auto option = std::ranges::find_if(extras, base::is_option);
    if (option != extras.end())
        return base::Error(
            base::ExitCode::kUsage,
            fmt::format("{}: found an unknown option, expected what `{} --help` lists{}",
                        base::printable(*option), command, base::perhaps_option(at, *option)));
    if (!extras.empty())
        return usage(command, extras.front(), fmt::format("what `{} --help` lists", command));
    const std::string said = problem.what();
    for (const CLI::Option* each : at.get_options()) {
        const std::string name = each->get_name();
        if (each->get_expected_max() == 1 && each->count() > 1)
            return base::Error(
                base::ExitCode::kUsage,
                fmt::format("{}: found {} times, expected once", name, each->count()));
        if (said == name + " is required" || said.starts_with(name + ": 1 required"))
            return base::Error(base::ExitCode::kUsage, fmt::format("{}: found nothing, expected {}",
                                                                   name, each->get_type_name()));
    }
    return base::Error(base::ExitCode::kUsage, base::printable(said, 200));
}

} // namespace sward::texgen
