// SPDX-License-Identifier: Apache-2.0
#include "texgen/support/parallel.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <vector>

namespace sward::texgen {

void parallel_for(std::size_t count, int threads,
                  const std::function<void(std::size_t, int)>& work) {
    const int workers =
        static_cast<int>(std::min(static_cast<std::size_t>(std::max(threads, 1)), count));
    std::atomic<std::size_t> next{0};
    std::mutex guard;
    std::exception_ptr first;
    // Each worker takes the next task itself: the callers put the longest first.
    const auto run = [&](int worker) {
        try {
            for (std::size_t task = next++; task < count; task = next++)
                work(task, worker);
        } catch (...) {
            next = count;
            const std::lock_guard lock(guard);
            if (!first)
                first = std::current_exception();
        }
    };
    // Threads of our own: TBB's workers end the program where the system has none left. Here fewer
    // do the work then.
    std::vector<std::jthread> others;
    try {
        for (int worker = 1; worker < workers; ++worker)
            others.emplace_back(run, worker);
    } catch (const std::system_error&) {
    } catch (const std::bad_alloc&) {
    }
    run(0);
    others.clear(); // waits
    if (first)
        std::rethrow_exception(first);
}

} // namespace sward::texgen
