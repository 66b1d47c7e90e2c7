// SPDX-License-Identifier: Apache-2.0
// What an aeroplane and a helicopter have alike: a frame, six degrees of freedom at a fixed step,
// and what a crash is.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/angles.h"

namespace sward::fly {

inline constexpr double kGravity = 9.81; // m/s2
inline constexpr double kAir = 1.225;    // kg/m3, at sea level
using base::kDegree;

/// What is flown over and through, world metres.
struct FlyLand {
    std::function<double(double x, double z)> height;
    std::function<glm::dvec2(double x, double z)> wind; ///< m/s to the east and south; null: none
    [[nodiscard]] glm::dvec3 wind_at(const glm::dvec3& place) const;
};

/// Aerodynamic axes (ahead, right, down) from ours (right, up, behind), and back.
[[nodiscard]] glm::dvec3 to_air(const glm::dvec3& v);
[[nodiscard]] glm::dvec3 from_air(const glm::dvec3& v);

struct AircraftState {
    glm::dvec3 position{0};      ///< of the centre of mass
    glm::dquat turn{1, 0, 0, 0}; ///< of its frame (x right, y up, z behind) in the world
    glm::dvec3 velocity_mps{0};  ///< over the ground
    glm::dvec3 rates{0};         ///< roll, pitch, yaw (rad/s): right side down, nose up, nose right
    double airspeed_mps = 0;
    bool on_ground = false, crashed = false;
    [[nodiscard]] glm::dvec3 ahead() const { return turn * glm::dvec3(0, 0, -1); }
    [[nodiscard]] bool finite() const;
};

/// Its nose to `yaw_deg`, level.
[[nodiscard]] glm::dquat heading(double yaw_deg);
/// A step by Euler's equations about the axes of inertia; `moment` about roll, pitch, yaw (N m).
void turn_by(AircraftState& state, const glm::dvec3& inertia_kgm2, const glm::dvec3& moment);

inline constexpr double kStep_s = 1.0 / 240;
inline constexpr double kMost_s = 0.25; ///< in one call: a stopped program must not leap
inline constexpr double kCrashed_s = 3; ///< that what has crashed lies where it did

/// What goes on by whole steps of a state, whatever the pictures' rate.
template<class State> class Motion {
protected:
    void begin_again() {
        now_ = before_ = start_;
        crashed_s_ = 0;
    }
    /// Calls `step` for each step that is due.
    template<class Step> void take_steps(double dt_s, const Step& step) {
        owed_s_ += std::isfinite(dt_s) ? std::clamp(dt_s, 0.0, kMost_s) : 0.0;
        while (owed_s_ >= kStep_s) {
            owed_s_ -= kStep_s;
            before_ = now_;
            step();
        }
    }
    /// Of what has crashed: one more step of lying there. True once that is over.
    [[nodiscard]] bool lain_long_enough() {
        crashed_s_ += kStep_s;
        return crashed_s_ > kCrashed_s;
    }
    void crash() {
        now_.crashed = true;
        now_.velocity_mps = now_.rates = glm::dvec3(0);
        before_ = now_;
    }
    /// Between the last two steps, as far as the next one is due.
    [[nodiscard]] State shown() const {
        const double share = std::clamp(owed_s_ / kStep_s, 0.0, 1.0);
        State between = now_;
        between.position = before_.position + (now_.position - before_.position) * share;
        between.turn = glm::slerp(before_.turn, now_.turn, share);
        return between;
    }

    State before_, now_; ///< of the last two steps
    State start_;        ///< where it begins, and after a crash begins again

private:
    double owed_s_ = 0, crashed_s_ = 0;
};

} // namespace sward::fly
