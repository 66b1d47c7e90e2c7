// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sward::texgen {

/// Threads that `--threads N` means: 0 is one a core.
[[nodiscard]] inline int resolve_threads(int requested) {
    return requested > 0 ? requested
                         : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// work(task, worker) for every task in [0, count), in any order on `threads` workers, worker in
/// [0, threads). Tasks write to places of their own, so the result is the same at any number of
/// threads. The first exception is rethrown.
template<typename Work> void parallel_for(std::size_t count, int threads, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex guard;
    const auto run = [&](int worker) {
        try {
            for (std::size_t task = next++; task < count; task = next++)
                work(task, worker);
        } catch (...) {
            const std::lock_guard lock(guard);
            if (!failure)
                failure = std::current_exception();
            next = count;
        }
    };
    const int workers =
        static_cast<int>(std::min(static_cast<std::size_t>(std::max(threads, 1)), count));
    {
        std::vector<std::jthread> pool;
        for (int i = 1; i < workers; ++i)
            pool.emplace_back(run, i);
        run(0);
    }
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace sward::texgen
