// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace sward::wind {

/// Steps of `step_s` that cover a time.
inline std::int64_t steps_for(double time_s, double step_s) {
    return static_cast<std::int64_t>(std::ceil(time_s / step_s - 1e-9));
}

/// Which states a buffer of cells holds, and where they lie: the latest at latest * step_s, the
/// previous one step before.
struct StateTag {
    std::int64_t latest = 0;
    std::int64_t first = 0; ///< the first state of its run, which has no other before it
    double step_s = 1;
    int cells = 0; ///< a side; 0: none
    double cell_m = 1;
    glm::ivec2 first_cell{0};

    /// Share of the latest state at a time; times outside the two states take the nearer one.
    [[nodiscard]] float share(double time_s) const {
        return latest == first ? 1.0f
                               : static_cast<float>(glm::clamp(
                                     time_s / step_s - static_cast<double>(latest - 1), 0.0, 1.0));
    }
};

} // namespace sward::wind
