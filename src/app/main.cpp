// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "app/commands.h"
#include "app/options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/log.h"

namespace {

using sward::base::ExitCode;

void run(int argc, char** argv) {
    const sward::app::Options options = sward::app::parse_options(argc, argv);
    sward::base::set_verbosity(options.verbosity);
    switch (options.command) {
    case sward::app::Command::kHelp:
        std::fputs(options.help.c_str(), stdout);
        break;
    case sward::app::Command::kView:
        sward::app::run_view(options);
        break;
    case sward::app::Command::kRender:
        sward::app::run_render(options);
        break;
    case sward::app::Command::kWind:
        sward::app::run_wind(options);
        break;
    case sward::app::Command::kBench:
        sward::app::run_bench(options);
        break;
    case sward::app::Command::kInfo:
        sward::app::run_info();
        break;
    }
}

int fail(ExitCode code, const std::string& message) {
    sward::base::log_error(message);
    return static_cast<int>(code);
}

} // namespace

int main(int argc, char** argv) {
    try {
        sward::base::install_signal_cleanup();
        run(argc, argv);
        return static_cast<int>(ExitCode::kDone);
    } catch (const sward::app::AlreadyReported& reported) {
        return reported.code;
    } catch (const sward::base::Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::kFailure, "memory: found none left, expected room for the scene");
    } catch (const std::exception& error) {
        return fail(ExitCode::kFailure,
                    "inside sward: " + sward::base::printable(error.what(), 300));
    }
}
