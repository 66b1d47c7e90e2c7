// SPDX-License-Identifier: Apache-2.0
// Which texels of an image one texel of its next mip covers, along one axis.
#pragma once

#include <algorithm>
#include <vector>

namespace sward::texgen {

/// The at most three texels of a row of `from` that one texel of `to` covers, with their shares of
/// it.
struct Footprint {
    int index[3] = {};
    float share[3] = {};
    int count = 0;
};

[[nodiscard]] inline std::vector<Footprint> footprints(int from, int to) {
    std::vector<Footprint> all(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        const double low = static_cast<double>(i) * from / to,
                     high = static_cast<double>(i + 1) * from / to;
        Footprint& f = all[static_cast<std::size_t>(i)];
        for (int j = static_cast<int>(low); j < from && j < high && f.count < 3; ++j) {
            const double part = std::min(high, j + 1.0) - std::max(low, static_cast<double>(j));
            if (part <= 1e-9)
                continue;
            f.index[f.count] = j;
            f.share[f.count++] = static_cast<float>(part / (high - low));
        }
    }
    return all;
}

} // namespace sward::texgen
