// SPDX-License-Identifier: Apache-2.0
#include "app/child_process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>

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
[[noreturn]] void become(char* const* argv, pid_t parent, int output) {
    // kill -9 of the parent must not leave a bake of minutes behind.
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent)
        ::_exit(kCannotStart);
    const int null = ::open("/dev/null", O_RDONLY);
    if (null >= 0)
        ::dup2(null, STDIN_FILENO);
    if (output >= 0)
        ::dup2(output, STDERR_FILENO);
    ::dup2(STDERR_FILENO, STDOUT_FILENO); // stdout is for our own results
    ::execv(argv[0], argv);
    ::_exit(kCannotStart);
}

/// The reading end of a child's output, until it is closed there.
class Listener {
public:
    explicit Listener(const std::filesystem::path& program) {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
            throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run",
                                    std::strerror(errno), "room for a pipe");
    }
    ~Listener() {
        close_writing();
        ::close(ends_[0]);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    [[nodiscard]] int writing() const { return ends_[1]; }
    void close_writing() {
        if (ends_[1] >= 0)
            ::close(std::exchange(ends_[1], -1));
    }

    /// Hands on until the child, and all that it started, have closed their end.
    void hand_on(const std::function<void(std::string_view)>& listen) const {
        std::array<char, 4096> piece{};
        std::string line;
        while (true) {
            const ssize_t count = ::read(ends_[0], piece.data(), piece.size());
            if (count < 0 && errno == EINTR)
                continue;
            if (count <= 0)
                return;
            const std::string_view text(piece.data(), static_cast<std::size_t>(count));
            static_cast<void>(
                !::write(STDERR_FILENO, text.data(), text.size())); // nowhere to complain
            for (const char c : text) {
                if (c != '\n' && line.size() < kLongestLine) {
                    line += c;
                    continue;
                }
                listen(line);
                line.clear();
            }
        }
    }

private:
    static constexpr std::size_t kLongestLine = 4096;
    std::array<int, 2> ends_{-1, -1};
};

} // namespace

int run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                const std::function<void(std::string_view)>& listen) {
    if (::access(program.c_str(), X_OK) != 0)
        throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run", std::strerror(errno),
                                "the program beside sward");
    std::vector<std::string> words = {program.string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);

    std::optional<Listener> listener;
    if (listen)
        listener.emplace(program);
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0)
        become(argv.data(), parent, listener ? listener->writing() : -1);
    if (child < 0)
        throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run", std::strerror(errno),
                                "room for a process");
    if (listener) {
        listener->close_writing();
        listener->hand_on(listen);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw base::input_error(base::ExitCode::kIo, program, 0, "cannot wait",
                                    std::strerror(errno), "its end");
    if (WIFSIGNALED(status))
        throw base::input_error(
            base::ExitCode::kFailure, program, 0, "ended before it was done",
            fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status))),
            "its end with a result");
    if (WEXITSTATUS(status) == kCannotStart)
        throw base::input_error(base::ExitCode::kIo, program, 0, "cannot run",
                                "a program that does not start", "the program beside sward");
    return WEXITSTATUS(status);
}

} // namespace sward::app
