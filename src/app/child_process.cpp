// SPDX-License-Identifier: Apache-2.0
#include "app/child_process.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

namespace sward::app {
namespace {

constexpr int kCannotStart = 127; // as a shell says it

/// After fork and before exec only async-signal-safe calls are allowed: the drivers' threads may
/// hold any lock.
[[noreturn]] void become(char* const* argv, pid_t parent) {
    // kill -9 of the parent must not leave a bake of minutes behind.
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent)
        ::_exit(kCannotStart);
    const int null = ::open("/dev/null", O_RDONLY);
    if (null >= 0)
        ::dup2(null, STDIN_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO); // stdout is for our own results
    ::execv(argv[0], argv);
    ::_exit(kCannotStart);
}

} // namespace

int run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
    if (::access(program.c_str(), X_OK) != 0)
        throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run", std::strerror(errno),
                                "the program beside sward");
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);

    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0)
        become(argv.data(), parent);
    if (child < 0)
        throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run", std::strerror(errno),
                                "room for a process");
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw base::input_error(base::ExitCode::kIo, program, 0, "cannot wait",
                                    std::strerror(errno), "its end");
    if (WIFSIGNALED(status))
        throw base::input_error(base::ExitCode::kFailure, program, 0, "ended before it was done",
                                fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status))), "its end with a result");
    if (WEXITSTATUS(status) == kCannotStart)
        throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run", "a program that does not start", "the program beside sward");
    return WEXITSTATUS(status);
}

} // namespace sward::app
