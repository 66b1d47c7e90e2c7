// SPDX-License-Identifier: Apache-2.0
#include "app/frame_times.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sward::app {

void FrameTimes::add(double ms) {
    ms_[next_] = ms;
    next_ = (next_ + 1) % kWindow;
    count_ = std::min(count_ + 1, kWindow);
}

double FrameTimes::percentile(double share) const {
    if (count_ == 0)
        return 0;
    std::vector<double> sorted(
        ms_.begin(),
        ms_.begin() + static_cast<std::ptrdiff_t>(count_)); // before it is full they begin at 0
    const double wanted = std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(count_));
    const auto rank = std::max<std::size_t>(1, static_cast<std::size_t>(wanted)) - 1;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank),
                     sorted.end());
    return sorted[rank];
}

} // namespace sward::app
