// SPDX-License-Identifier: Apache-2.0
#include "terrain/mask_mips.h"

#include <algorithm>
#include <array>

namespace sward::terrain {
namespace {

/// Shares of the finer texels 2 i, 2 i + 1, 2 i + 2 in coarse texel i of n.
std::array<float, 3> shares(int i, int fine) {
    const int n = std::max(1, fine / 2);
    if (fine == 1)
        return {1, 0, 0};
    if (fine % 2 == 0)
        return {0.5f, 0.5f, 0};
    const float whole = static_cast<float>(2 * n + 1);
    return {static_cast<float>(n - i) / whole, static_cast<float>(n) / whole,
            static_cast<float>(i + 1) / whole};
}

} // namespace

std::vector<float> next_mip(const std::vector<float>& texels, glm::ivec2& size) {
    const glm::ivec2 half = glm::max(size / 2, glm::ivec2(1));
    std::vector<float> mip(static_cast<std::size_t>(half.x) * static_cast<std::size_t>(half.y));
    for (int y = 0; y < half.y; ++y) {
        const auto down = shares(y, size.y);
        for (int x = 0; x < half.x; ++x) {
            const auto along = shares(x, size.x);
            float sum = 0;
            for (int v = 0; v < 3; ++v)
                for (int u = 0; u < 3; ++u) {
                    const int i = std::min(2 * x + u, size.x - 1),
                              j = std::min(2 * y + v, size.y - 1);
                    sum += down[static_cast<std::size_t>(v)] * along[static_cast<std::size_t>(u)] *
                           texels[static_cast<std::size_t>(j) * static_cast<std::size_t>(size.x) +
                                  static_cast<std::size_t>(i)];
                }
            mip[static_cast<std::size_t>(y) * static_cast<std::size_t>(half.x) +
                static_cast<std::size_t>(x)] = sum;
        }
    }
    size = half;
    return mip;
}

std::vector<std::uint8_t> next_mip(const std::vector<std::uint8_t>& texels, glm::ivec2& size) {
    constexpr std::size_t kChannels = 4;
    const glm::ivec2 half = glm::max(size / 2, glm::ivec2(1));
    std::vector<std::uint8_t> mip(static_cast<std::size_t>(half.x) *
                                  static_cast<std::size_t>(half.y) * kChannels);
    std::uint8_t* out = mip.data();
    for (int y = 0; y < half.y; ++y) {
        const auto down = shares(y, size.y);
        for (int x = 0; x < half.x; ++x) {
            const auto along = shares(x, size.x);
            std::array<float, kChannels> sum{0.5f, 0.5f, 0.5f, 0.5f}; // to the nearest byte
            for (int v = 0; v < 3; ++v)
                for (int u = 0; u < 3; ++u) {
                    const float weight =
                        down[static_cast<std::size_t>(v)] * along[static_cast<std::size_t>(u)];
                    if (weight <= 0)
                        continue;
                    const auto at =
                        (static_cast<std::size_t>(2 * y + v) * static_cast<std::size_t>(size.x) +
                         static_cast<std::size_t>(2 * x + u)) *
                        kChannels;
                    for (std::size_t channel = 0; channel < kChannels; ++channel)
                        sum[channel] += weight * static_cast<float>(texels[at + channel]);
                }
            for (const float part : sum)
                *out++ = static_cast<std::uint8_t>(part);
        }
    }
    size = half;
    return mip;
}

int mip_count(glm::ivec2 size) {
    int count = 1;
    for (int side = std::max(size.x, size.y); side > 1; side /= 2)
        ++count;
    return count;
}

} // namespace sward::terrain
