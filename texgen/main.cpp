// SPDX-License-Identifier: Apache-2.0
// texgen: a species preset becomes a grass set (docs/texgen.md).
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>

#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "texgen/options.h"
#include "texgen/report.h"

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

/// What no handler of ours can catch: an exception in a library's thread or before main().
[[noreturn]] void end_in_one_line() {
    const auto end = [](base::ExitCode code, std::string_view line) {
        (void)!::write(STDERR_FILENO, line.data(), line.size());
        ::_exit(static_cast<int>(code));
    };
    constexpr std::string_view kNoRoom = "error: texgen: found too little memory or too few threads, expected room to start (ulimit -v, -u)\n";
    try {
        if (std::current_exception())
            std::rethrow_exception(std::current_exception());
    } catch (const std::system_error&) {
        end(base::ExitCode::kOverLimit, kNoRoom);
    } catch (const std::bad_alloc&) {
        end(base::ExitCode::kOverLimit, kNoRoom);
    } catch (...) {
    }
    end(base::ExitCode::kFailure, "error: texgen: a library gave up\n");
    std::abort();
}

/// Runs before the libraries' own beginnings: some start threads there, and where they cannot, they end the program.
void before_libraries(int, char**, char**) {
    std::set_terminate(end_in_one_line);
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0); // comes with GDAL; nobody here multiplies matrices
}
__attribute__((section(".preinit_array"), used)) void (*const g_before_libraries)(int, char**, char**) = before_libraries;

int fail(base::ExitCode code, const std::string& message) {
    base::log_error(message);
    return static_cast<int>(code);
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const base::Error& error) {
        return fail(error.code(), error.what());
    } catch (const std::bad_alloc&) {
        return fail(base::ExitCode::kOverLimit, "out of memory");
    } catch (const std::filesystem::filesystem_error& error) {
        const std::filesystem::path path = error.path1().empty() ? std::filesystem::path(".") : error.path1();
        return fail(base::ExitCode::kIo, base::printable(path.string(), 300) + ": cannot use: found " + error.code().message() +
                                             ", expected a place that exists");
    } catch (const std::system_error& error) { // no thread, no handle
        return fail(base::ExitCode::kOverLimit, std::string("the system's limits: found ") + error.code().message() +
                                                    ", expected room for a thread: see --threads and ulimit");
    } catch (const std::exception& error) {
        return fail(base::ExitCode::kFailure, error.what());
    }
}
