// SPDX-License-Identifier: Apache-2.0
// A handler may do next to nothing, so it hands the signal to a thread that removes the temporaries
// and ends the process.
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include "base/end_at_once.h"
#include "base/file.h"
#include "base/pending_registry.h"

namespace sward::base {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

std::atomic<std::int64_t> g_first_ms{0};
std::array<int, 2> g_pipe{-1, -1};

// One death of a parent with several threads is told more than once (PR_SET_PDEATHSIG): a repeat so
// soon is not impatience.
constexpr std::int64_t kRepeat_ms = 500;

std::int64_t now_ms() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now); // async-signal-safe
    return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000 + 1;
}

extern "C" void on_signal(int signal) {
    const int saved = errno;
    const std::int64_t now = now_ms();
    std::int64_t first = 0;
    if (!g_first_ms.compare_exchange_strong(first, now)) {
        if (now - first > kRepeat_ms)
            ::_exit(128 + signal); // asked again: leave at once
        errno = saved;
        return;
    }
    const auto number = static_cast<unsigned char>(signal);
    if (::write(g_pipe[1], &number, 1) != 1)
        ::_exit(128 + signal);
    errno = saved;
}

void wait_for_signal() {
    unsigned char number = 0;
    while (::read(g_pipe[0], &number, 1) != 1)
        if (errno != EINTR)
            return;
    remove_all_pending();
    ::_exit(128 + number);
}

} // namespace

void end_at_once(int code) {
    remove_all_pending();
    ::_exit(code);
}

void install_signal_cleanup() {
    static std::atomic<bool> installed{false};
    if (installed.exchange(true) || ::pipe2(g_pipe.data(), O_CLOEXEC) != 0)
        return;
    std::thread(wait_for_signal).detach();
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    for (const int signal : kSignals) {
        struct sigaction old {};
        ::sigaction(signal, nullptr, &old);
        if (old.sa_handler != SIG_IGN) // nohup asked for that
            ::sigaction(signal, &action, nullptr);
    }
    // Past the size limit of `ulimit -f` a write shall fail, not kill: the error names the file.
    ::signal(SIGXFSZ, SIG_IGN);
    ::signal(SIGPIPE, SIG_IGN);
}

} // namespace sward::base
