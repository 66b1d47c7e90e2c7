// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

namespace sward::app {

/// The viewer's time: by the clock or by a fixed step, slowed, standing, or a step at a time.
class SimClock {
public:
    /// `fixed_s`: simulated from picture to picture, whatever the clock says. `step_s`: what a
    /// single step is.
    SimClock(double start_s, double step_s, std::optional<double> fixed_s)
        : step_s_(step_s), fixed_s_(fixed_s), time_s_(start_s) {}

    /// How far a picture goes on.
    struct Tick {
        double real_s = 0; ///< what moves a free camera: also while time stands
        double dt_s = 0;   ///< simulated
    };
    /// Before a picture; `elapsed_s` since the one before. After a stop time does not leap:
    /// kLongest_s at most.
    Tick tick(double elapsed_s);

    void toggle_pause() { paused_ = !paused_; }
    void pause() { paused_ = true; }
    /// Stands still, but for one step with the next picture. Calls add up.
    void single_step();
    /// Half, twice the pace; between a sixteenth and four.
    void slower();
    void faster();
    void real_time() { rate_ = 1; }

    [[nodiscard]] bool paused() const { return paused_; }
    [[nodiscard]] double rate() const { return rate_; }
    [[nodiscard]] double time_s() const { return time_s_; }
    /// Time, as another says it: a replay's.
    void set_time(double time_s) { time_s_ = time_s; }

    static constexpr double kLongest_s = 0.25, kSlowest = 1.0 / 16, kFastest = 4;

private:
    double step_s_;
    std::optional<double> fixed_s_;
    double time_s_;
    double rate_ = 1;
    int steps_ = 0; ///< asked for while it stands
    bool paused_ = false;
};

} // namespace sward::app
