// SPDX-License-Identifier: Apache-2.0
#include "base/last_words.h"

#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include <pthread.h>
#include <unistd.h>

#include "base/error.h"
#include "base/room.h"

namespace sward::base {
namespace {

const char* g_program = "";

/// What the libraries take for themselves before main() and at their first use. With less some of
/// them follow a null pointer.
constexpr std::size_t kLeastRoom = std::size_t{128} << 20;
constexpr const char* kNoRoom =
    "found too little memory or too few threads, expected room to run (ulimit -v, -u)";

/// Plain writes: there may be no memory to build a line in.
[[noreturn]] void end(ExitCode code, const char* reason) {
    for (const char* piece : {"error: ", g_program, ": ", reason, "\n"})
        (void)!::write(STDERR_FILENO, piece, std::strlen(piece));
    ::_exit(static_cast<int>(code));
}

[[noreturn]] void end_in_one_line() {
    try {
        if (std::current_exception())
            std::rethrow_exception(std::current_exception());
    } catch (const std::system_error&) {
        end(ExitCode::kOverLimit, kNoRoom);
    } catch (const std::bad_alloc&) {
        end(ExitCode::kOverLimit, kNoRoom);
    } catch (...) { // told below
    }
    end(ExitCode::kFailure, "a library gave up");
}

bool can_start_thread() {
    pthread_t thread;
    if (::pthread_create(
            &thread, nullptr, [](void*) -> void* { return nullptr; }, nullptr) != 0)
        return false;
    ::pthread_join(thread, nullptr);
    return true;
}

} // namespace

void install_last_words(const char* program) {
    g_program = program;
    std::set_terminate(end_in_one_line);
    if (!has_room(kLeastRoom) || !can_start_thread())
        end(ExitCode::kOverLimit, kNoRoom);
    ::setenv("OPENBLAS_NUM_THREADS", "1", 0); // comes with GDAL; nobody here multiplies matrices
}

} // namespace sward::base
