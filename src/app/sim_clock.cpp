// SPDX-License-Identifier: Apache-2.0
#include "app/sim_clock.h"

#include <algorithm>
#include <cmath>

namespace sward::app {

SimClock::Tick SimClock::tick(double elapsed_s) {
    const double elapsed = std::isfinite(elapsed_s) ? elapsed_s : 0;
    Tick tick;
    tick.real_s = fixed_s_.value_or(std::clamp(elapsed, 0.0, kLongest_s));
    tick.dt_s = paused_ ? steps_ * step_s_ : tick.real_s * rate_;
    steps_ = 0;
    time_s_ += tick.dt_s;
    return tick;
}

void SimClock::single_step() {
    paused_ = true;
    ++steps_;
}

void SimClock::slower() {
    rate_ = std::max(kSlowest, rate_ / 2);
}

void SimClock::faster() {
    rate_ = std::min(kFastest, rate_ * 2);
}

} // namespace sward::app
