// SPDX-License-Identifier: Apache-2.0
#pragma once

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

} // namespace sward::base
