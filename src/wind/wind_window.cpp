// SPDX-License-Identifier: Apache-2.0
// When the wind has a local window, how large it is, and its steps.
#include <algorithm>

#include "wind/wind.h"

namespace sward::wind {

/// Whether there is to be a window, and if so, that one of another size goes.
bool Wind::wants_window(double time_s) {
    if (!inputs_) {
        return false;
    }
    if (!inputs_->active()) {
        return window_ && time_s - stirred_s_ < kLinger_s;
    }
    stirred_s_ = time_s;
    const int cells =
        inputs_->only_moving() ? std::min(spec_.moving_cells, spec_.cells) : spec_.cells;
    if (window_ && window_->tag().cells != cells) {
        window_.reset();
        window_back_.reset();
    }
    cells_ = cells;
    return true;
}

/// 1, and towards 0 in the last second of a window in which nothing is local any more.
double Wind::window_fade(double time_s) const {
    return glm::clamp(stirred_s_ + kLinger_s - std::min(time_s, time_s_), 0.0, 1.0);
}

void Wind::advance_window(double time_s, glm::dvec2 eye, int most_steps) {
    if (!wants_window(time_s)) {
        window_.reset();
        window_back_.reset();
        return;
    }
    const auto ambient_at = [&](glm::dvec2 corner, double when) {
        return compose(corner, when, ambient_->tag(), StateTag{});
    };
    if (!window_) {
        window_ = std::make_unique<Window>(spec_, cells_, mean_);
        const std::int64_t first = steps_for(time_s_, spec_.step_s);
        step_ambient(static_cast<double>(first) * spec_.step_s);
        point_textures();
        bind();
        window_->begin(eye_.value_or(eye), first,
                       ambient_at(window_->corner_for(eye_.value_or(eye)),
                                  static_cast<double>(first) * spec_.step_s));
    }
    const glm::dvec2 from = eye_.value_or(eye);
    const double span = time_s - time_s_;
    for (int steps = 0; window_->tag().latest < steps_for(time_s, spec_.step_s) &&
                        (most_steps == 0 || steps < most_steps);
         ++steps) {
        const double when = window_->next_time_s();
        step_ambient(when);
        bind();
        const double share = span > 0 ? glm::clamp((when - time_s_) / span, 0.0, 1.0) : 1.0;
        const glm::dvec2 there = from + (eye - from) * share;
        window_->follow(there, ambient_at(window_->corner_for(there), when - spec_.step_s));
        window_->step(*inputs_, ambient_at(window_->corner(), when));
    }
}

} // namespace sward::wind
