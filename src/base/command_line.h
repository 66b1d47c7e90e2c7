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

/// A flag has no value: CLI11 takes `--flag=3` for three of it, and `--flag=false` for none. Of the
/// flags of `app`, which has not parsed yet, and of the command that is named. Throws
/// Error(kUsage).
template<class App> void refuse_flag_values(const App& app, int argc, const char* const* argv) {
    const App* command = nullptr;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--")
            return;
        if (!command && !is_option(word))
            for (const App* const one : app.get_subcommands([](const App*) { return true; }))
                command = one->get_name() == word ? one : command;
        const std::size_t sign = word.find('=');
        if (!word.starts_with("-") || sign == std::string::npos)
            continue;
        const std::string name = word.substr(0, sign);
        const auto* option = command ? command->get_option_no_throw(name) : nullptr;
        if (!option)
            option = app.get_option_no_throw(name);
        if (option && option->get_expected_max() == 0)
            throw Error(ExitCode::kUsage, name + ": found \"" +
                                              printable(word.substr(sign + 1), 300) +
                                              "\", expected no value: it is a flag");
    }
}

} // namespace sward::base
