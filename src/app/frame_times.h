// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace sward::app {

/// Times of the last pictures, and how they are spread.
class FrameTimes {
public:
    void add(double ms);
    /// The time that a share of the last pictures did not exceed (0.5: the median), nearest rank; 0
    /// before the first.
    [[nodiscard]] double percentile(double share) const;

    static constexpr std::size_t kWindow = 256; ///< pictures: four seconds at 60 a second

private:
    std::array<double, kWindow> ms_{};
    std::size_t count_ = 0, next_ = 0;
};

} // namespace sward::app
