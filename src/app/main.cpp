// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>

#include "app/commands.h"
#include "app/options.h"
#include "base/error.h"
#include "base/file.h"
#include "base/last_words.h"
#include "base/log.h"
#include "sward/error.h"

namespace {

using sward::base::ExitCode;

void run(int argc, char** argv) {
    const sward::app::Options options = sward::app::parse_options(argc, argv);
    sward::base::set_verbosity(options.verbosity);
    switch (options.command) {
    case sward::app::Command::kHelp:
        std::fputs(options.help.c_str(), stdout);
        sward::app::flush_results();
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
        sward::app::run_info(options);
        break;
    }
}

ExitCode code_of(sward::ErrorKind kind) {
    switch (kind) {
    case sward::ErrorKind::kInside:
        return ExitCode::kFailure;
    case sward::ErrorKind::kUsage:
        return ExitCode::kUsage;
    case sward::ErrorKind::kBadInput:
        return ExitCode::kBadInput;
    case sward::ErrorKind::kOverLimit:
        return ExitCode::kOverLimit;
    case sward::ErrorKind::kIo:
        return ExitCode::kIo;
    case sward::ErrorKind::kNoGpu:
        return ExitCode::kNoGpu;
    }
    return ExitCode::kFailure;
}

int fail(ExitCode code, const std::string& message) {
    sward::base::log_error(message);
    return static_cast<int>(code);
}

} // namespace

SWARD_BEFORE_LIBRARIES("sward");

void sward::app::flush_results() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        throw base::Error(
            base::ExitCode::kIo,
            "stdout: cannot write: found a full or closed stream, expected room for the report");
}

int main(int argc, char** argv) {
    try {
        sward::base::install_signal_cleanup();
        run(argc, argv);
        return static_cast<int>(ExitCode::kDone);
    } catch (const sward::app::AlreadyReported& reported) {
        return reported.code;
    } catch (const sward::base::Error& error) {
        return fail(error.code(), error.what());
    } catch (const sward::Error& error) { // of the library's face
        return fail(code_of(error.kind()), error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::kOverLimit, "memory: found none left, expected room for the scene");
    } catch (
        const std::filesystem::filesystem_error& error) { // a working directory that is gone, say
        const std::string name = error.path1().empty()
                                     ? "working directory"
                                     : sward::base::printable(error.path1().native(), 300);
        return fail(ExitCode::kIo, name + ": cannot use: found " + error.code().message() +
                                       ", expected a file or directory that can be reached");
    } catch (const std::system_error& error) { // no thread, no handle
        return fail(ExitCode::kOverLimit, "system: found " + error.code().message() +
                                              ", expected room for a thread (ulimit -u, -v)");
    } catch (const std::exception& error) {
        return fail(ExitCode::kFailure,
                    "inside sward: " + sward::base::printable(error.what(), 300));
    }
}
