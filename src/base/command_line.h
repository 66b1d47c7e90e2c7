// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"

namespace sward::base {

/// A word of a command line that begins as an option does.
[[nodiscard]] inline bool is_option(const std::string& word) {
    return word.size() > 1 && word.front() == '-';
}

/// "--sise" -> ", perhaps --size"; nothing where no option of `app` is near. `app` is a CLI::App: a
/// template, so that the core need not know CLI11.
template<class App>
[[nodiscard]] std::string perhaps_option(const App& app, const std::string& word) {
    std::vector<std::string> known;
    for (const auto* option : app.get_options())
        for (const std::string& name : option->get_lnames())
            known.push_back("--" + name);
    const std::string nearest =
        word.starts_with("--") ? nearest_name(word.substr(0, word.find('=')), known) : "";
    return nearest.empty() ? "" : ", perhaps " + nearest;
}

/// Words among what nothing took that begin as an option does.
template<class App> [[nodiscard]] bool has_unknown_option(const App& app) {
    const std::vector<std::string> words = app.remaining(true);
    return std::any_of(words.begin(), words.end(), is_option);
}

/// Refuses "--dry-run=no" and "-q=3": CLI11 would set a flag, or leave it, whatever the value says.
/// A name that takes a value in any command of `app` is none of a flag.
template<class App> void refuse_flag_values(const App& app, int argc, const char* const* argv) {
    std::vector<std::string> flags, others;
    const auto note = [&](const App& at) {
        for (const auto* option : at.get_options()) {
            std::vector<std::string>& names =
                option->get_items_expected_max() == 0 ? flags : others;
            for (const std::string& name : option->get_lnames())
                names.push_back("--" + name);
            for (const std::string& name : option->get_snames())
                names.push_back("-" + name);
        }
    };
    note(app);
    for (const App* command : app.get_subcommands({}))
        note(*command);
    const auto holds = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) {
        const std::string word = argv[i];
        const std::size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        if (equals != std::string::npos && holds(flags, name) && !holds(others, name))
            throw Error(ExitCode::kUsage, name + ": found \"" + printable(word.substr(equals + 1)) +
                                              "\", expected no value");
    }
}

} // namespace sward::base
