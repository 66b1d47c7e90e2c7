// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <thread>

namespace sward::texgen {

/// Threads that `--threads N` means: 0 is one a core.
[[nodiscard]] inline int resolve_threads(int requested) {
    return requested > 0 ? requested
                         : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// work(task, worker) for every task in [0, count), begun in rising order on at most `threads`
/// threads, the caller's among them, worker in [0, threads) and never twice at a time. Tasks write
/// to places of their own, so the result is the same at any number of threads, and where the system
/// gives no more of them. The first exception is rethrown once the tasks in work have ended; no
/// further one begins.
void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t task, int worker)>& work);

} // namespace sward::texgen
