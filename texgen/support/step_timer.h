// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include <fmt/format.h>

#include "base/log.h"

namespace sward::texgen {

/// Says at verbosity -v how long a step took.
class StepTimer {
public:
    explicit StepTimer(std::string name)
        : name_(std::move(name)), start_(std::chrono::steady_clock::now()) {}
    ~StepTimer() {
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start_;
        base::log_debug(fmt::format("{}: {:.2f} s", name_, took.count()));
    }
    StepTimer(const StepTimer&) = delete;
    StepTimer& operator=(const StepTimer&) = delete;

private:
    std::string name_;
    std::chrono::steady_clock::time_point start_;
};

} // namespace sward::texgen
