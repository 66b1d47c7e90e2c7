// SPDX-License-Identifier: Apache-2.0
#include "assets/sqlite_budget.h"

#include <sqlite3.h>

namespace sward::assets {
namespace {

// Reading a row takes some 25 steps of SQLite's machine: room for two million, and a little more
// than a second.
constexpr std::int64_t kMostSteps = 50'000'000;
constexpr int kStepsAtOnce = 100'000;

/// Below 0: nothing is bounded. Of the thread, for a connection may outlive the budget under which
/// it was opened: PROJ keeps its own.
thread_local std::int64_t steps_left = -1;

int count_steps(void*) {
    if (steps_left < 0)
        return 0;
    steps_left = steps_left > kStepsAtOnce ? steps_left - kStepsAtOnce : 0;
    return steps_left == 0;
}

int watch(sqlite3* database, const char**, const sqlite3_api_routines*) {
    sqlite3_progress_handler(database, kStepsAtOnce, count_steps, nullptr);
    return SQLITE_OK;
}

/// The form in which SQLite takes an extension's entry.
void (*entry())() {
    return reinterpret_cast<void (*)()>(watch);
}

} // namespace

SqliteBudget::SqliteBudget() {
    steps_left = kMostSteps;
    sqlite3_auto_extension(entry());
}

SqliteBudget::~SqliteBudget() {
    sqlite3_cancel_auto_extension(entry());
    steps_left = -1;
}

bool SqliteBudget::spent() const {
    return steps_left == 0;
}

} // namespace sward::assets
