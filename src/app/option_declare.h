// SPDX-License-Identifier: Apache-2.0
// For the files that declare options: they alone include CLI11.
#pragma once

#include <functional>
#include <string>

#include <CLI/App.hpp>

#include "app/options.h"

namespace sward::app {

/// One option with a value. `name` as CLI11 takes it: "-o,--output".
CLI::Option* declare(CLI::App& app, const std::string& name, const std::string& value,
                     const std::string& help, std::function<void(const std::string&)> parse);

/// What `sward view` says to and hears from other programs and machines.
void declare_network(CLI::App& app, Options* o);
/// What one drives and flies in it.
void declare_models(CLI::App& app, Options* o);

} // namespace sward::app
