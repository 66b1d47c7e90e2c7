// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace sward::gl {

/// Times of the passes of one frame. One name a pass serves the timer, the debug group and the
/// statistics row.
class PassTimers {
public:
    struct Row {
        std::string name;
        double gpu_ms = 0;
        double cpu_ms = 0;
    };
    PassTimers() = default;
    ~PassTimers();
    PassTimers(const PassTimers&) = delete;
    PassTimers& operator=(const PassTimers&) = delete;

    /// `wait`: until the GPU is done, at both ends of each pass. Then cpu_ms is a pass's own time
    /// in software too.
    void begin_frame(bool wait = false);
    /// Rows of the frame begun last; a pass that ran more than once is summed. Waits for the GPU.
    [[nodiscard]] std::vector<Row> rows();

private:
    friend class PassScope;
    struct Entry {
        std::string name;
        std::uint32_t begin_query = 0, end_query = 0;
        double cpu_ms = 0;
    };
    std::uint32_t next_query();
    bool wait_ = false;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> queries_;
    std::size_t used_ = 0;
};

/// A pass from construction to destruction.
class PassScope {
public:
    PassScope(PassTimers& timers, const char* name);
    ~PassScope();
    PassScope(const PassScope&) = delete;
    PassScope& operator=(const PassScope&) = delete;

private:
    PassTimers& timers_;
    std::size_t entry_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace sward::gl
