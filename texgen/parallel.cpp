// SPDX-License-Identifier: Apache-2.0
#include "texgen/parallel.h"

#include <atomic>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace sward::texgen {

void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t, int)>& work) {
    const int workers =
        static_cast<int>(std::min(static_cast<std::size_t>(std::max(threads, 1)), count));
    if (workers == 0)
        return;
    // Else TBB never starts more threads than cores, whatever the arena holds.
    const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(std::max(workers, resolve_threads(0))));
    tbb::task_arena arena(workers); // one of its own for each call: no task waits on another's worker
    std::atomic<std::size_t> next{0};
    // Each worker takes the next task itself: TBB would halve the range, and the callers put the longest first.
    const auto run = [&](int worker) {
        try {
            for (std::size_t task = next++; task < count; task = next++)
                work(task, worker);
        } catch (...) {
            next = count;
            throw;
        }
    };
    arena.execute([&] { tbb::parallel_for(0, workers, run, tbb::simple_partitioner()); });
}

} // namespace sward::texgen
