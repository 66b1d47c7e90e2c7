// SPDX-License-Identifier: Apache-2.0
// texgen: a species preset becomes a grass set (docs/texgen.md).
#include <exception>
#include <filesystem>
#include <new>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/last_words.h"
#include "base/log.h"
#include "texgen/cli/options.h"
#include "texgen/report/report.h"

namespace {

using namespace sward;

int run(int argc, char** argv) {
    const texgen::Options options = texgen::parse_options(argc, argv);
    if (!options.help.empty()) {
        texgen::print_result(options.help);
        return 0;
    }
    base::install_signal_cleanup();
    return options.run(options);
}

int fail(base::ExitCode code, const std::string& message) {
    base::log_error(message);
    return static_cast<int>(code);
}

} // namespace

SWARD_BEFORE_LIBRARIES("texgen");

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const base::Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(base::ExitCode::kOverLimit, "out of memory");
    } catch (const std::filesystem::filesystem_error& error) {
        const std::filesystem::path path =
            error.path1().empty() ? std::filesystem::path(".") : error.path1();
        return fail(base::ExitCode::kIo, base::printable(path.string(), 300) +
                                             ": cannot use: found " + error.code().message() +
                                             ", expected a place that exists");
    } catch (const std::system_error& error) { // no thread, no handle
        return fail(base::ExitCode::kOverLimit,
                    std::string("the system's limits: found ") + error.code().message() +
                        ", expected room for a thread: see --threads and ulimit");
    } catch (const std::exception& error) {
        return fail(base::ExitCode::kFailure, error.what());
    }
}
