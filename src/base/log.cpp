// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/error.h"
#include "base/held_warnings.h"
#include "sward/log.h"

namespace sward::base {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMessageLimit = 16384;
constexpr auto kRedrawEvery = std::chrono::milliseconds(100);
constexpr std::size_t kBarWidth = 30;
constexpr std::size_t kNarrowestBar = 4;
constexpr std::size_t kUsualColumns = 80;

std::atomic<Verbosity> g_verbosity{Verbosity::kNormal};
std::mutex g_mutex; // guards stderr, g_bar and g_sink
LogSink g_sink;     // a host's, or empty
std::string g_bar;  // the bar that stands on the terminal's last line, or empty
thread_local HeldWarnings* t_held = nullptr;

/// Plain write(2): no buffer that a crash could lose, no locale.
void write_stderr(std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(STDERR_FILENO, text.data(), text.size());
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return; // nowhere left to complain
        text.remove_prefix(static_cast<std::size_t>(n));
    }
}

void write_line(LogLevel level, std::string_view prefix, std::string_view message) {
    const std::string text = printable(message, kMessageLimit);
    const std::lock_guard lock(g_mutex);
    if (g_sink) {
        g_sink(level, text);
        return;
    }
    const std::string line = fmt::format("{}{}\n", prefix, text);
    write_stderr(g_bar.empty() ? line : "\r\x1b[K" + line + g_bar);
}

std::size_t terminal_columns() {
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col
                                                                             : kUsualColumns;
}

bool has_sink() {
    const std::lock_guard lock(g_mutex);
    return static_cast<bool>(g_sink);
}

/// "12 s", "3 min 20 s", "1 h 5 min".
std::string readable_time(double seconds) {
    const auto whole = static_cast<long long>(seconds + 0.5);
    if (whole < 100)
        return fmt::format("{} s", whole);
    if (whole < 6000)
        return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

} // namespace

std::string progress_bar(std::string_view title, double share, double elapsed_s,
                         std::size_t columns) {
    share = std::clamp(share, 0.0, 1.0);
    const std::string time = share >= 1  ? "in " + readable_time(elapsed_s)
                             : share > 0 ? readable_time(elapsed_s * (1 / share - 1)) + " left"
                                         : std::string();
    const std::string tail = fmt::format("{:3.0f} % {}", std::floor(100 * share), time);
    // A line that wraps could not be drawn over: the bar gives way first, then the text is cut.
    const std::size_t rest = title.size() + tail.size() + 5; // blanks, brackets, the last column
    const std::size_t width = std::min(kBarWidth, columns > rest ? columns - rest : 0);
    const auto full = static_cast<std::size_t>(share * static_cast<double>(width));
    std::string line(title);
    if (width >= kNarrowestBar)
        line += fmt::format(" [{}{}]", std::string(full, '#'), std::string(width - full, '.'));
    line += " " + tail;
    return line.substr(0, columns > 0 ? columns - 1 : 0);
}

void set_verbosity(Verbosity verbosity) {
    g_verbosity = verbosity;
}

Verbosity verbosity() {
    return g_verbosity;
}

void log_error(std::string_view message) {
    write_line(LogLevel::kError, "error: ", message);
}

void log_warning(std::string_view message) {
    if (t_held)
        t_held->add(std::string(message));
    else
        write_line(LogLevel::kWarning, "warning: ", message);
}

HeldWarnings::HeldWarnings()
    : outer_(std::exchange(t_held, this)), exceptions_(std::uncaught_exceptions()) {}

HeldWarnings::~HeldWarnings() {
    t_held = outer_;
    if (std::uncaught_exceptions() > exceptions_)
        return;
    for (const std::string& warning : warnings_)
        log_warning(warning);
}

void HeldWarnings::add(std::string warning) {
    warnings_.push_back(std::move(warning));
}

void log_info(std::string_view message) {
    if (verbosity() != Verbosity::kQuiet)
        write_line(LogLevel::kInfo, "", message);
}

void log_debug(std::string_view message) {
    if (verbosity() == Verbosity::kVerbose || has_sink())
        write_line(LogLevel::kDebug, "", message);
}

struct Progress::State {
    std::string title;
    std::size_t total = 0;
    std::size_t done = 0;
    std::size_t tenths_told = 0;
    bool terminal = false;
    Clock::time_point start = Clock::now();
    Clock::time_point drawn{};

    void draw(bool finished);
    void tell_tenths();
};

void Progress::State::draw(bool finished) {
    const Clock::time_point now = Clock::now();
    if (!finished && now - drawn < kRedrawEvery)
        return;
    drawn = now;
    const double share = static_cast<double>(done) / static_cast<double>(total);
    const double elapsed_s = std::chrono::duration<double>(now - start).count();
    g_bar = progress_bar(title, share, elapsed_s, terminal_columns());
    write_stderr("\r\x1b[K" + g_bar);
}

void Progress::State::tell_tenths() {
    const std::size_t tenths = done * 10 / total;
    if (tenths <= tenths_told)
        return;
    tenths_told = tenths;
    write_stderr(fmt::format("{}: {} %\n", title, tenths * 10));
}

Progress::Progress(std::string title, std::size_t total) : state_(nullptr) {
    if (verbosity() == Verbosity::kQuiet || total == 0 || has_sink()) // a host shows its own
        return;
    state_ = new State;
    state_->title = printable(title);
    state_->total = total;
    state_->terminal = ::isatty(STDERR_FILENO) == 1;
    const std::lock_guard lock(g_mutex);
    if (state_->terminal)
        state_->draw(true);
}

Progress::~Progress() {
    if (!state_)
        return;
    const std::lock_guard lock(g_mutex);
    if (state_->terminal) {
        state_->draw(true);
        g_bar.clear();
        write_stderr("\n");
    }
    delete state_;
}

void Progress::advance(std::size_t steps) {
    if (!state_)
        return;
    const std::lock_guard lock(g_mutex);
    state_->done = std::min(state_->total, state_->done + steps);
    if (state_->terminal)
        state_->draw(false);
    else
        state_->tell_tenths();
}

} // namespace sward::base

namespace sward {

void set_log(LogSink sink) {
    const std::lock_guard lock(base::g_mutex);
    base::g_sink = std::move(sink);
}

} // namespace sward
