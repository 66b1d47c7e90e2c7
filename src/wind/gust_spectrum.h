// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sward::wind {

inline constexpr int kGustGroups = 3;

/// Stream functions of gusts on a torus of `side` x `side` cells (a power of two): three groups of
/// a cosine and a sine part, with von Karman's energy spectrum (rising as k^3, falling as k^-5/3)
/// and independent random phases. Turning each group at a rate of its own gives an endless field of
/// the same statistics.
struct GustSpectrum {
    int side = 0;
    std::array<std::vector<glm::vec2>, kGustGroups>
        stream; ///< at north-west corners: cosine, sine part; m2/s for cells of 1 m

    /// Velocities on the faces for the groups' phases (rad): u = d psi / dz, v = -d psi / dx, free
    /// of divergence by construction.
    void velocities(const std::array<double, kGustGroups>& phases, std::vector<float>& u,
                    std::vector<float>& v) const;
};

/// `peak_waves`: waves that the strongest gusts fit into the torus. Scaled so that velocities at
/// phases 0 have root mean square 1 a component.
[[nodiscard]] GustSpectrum gust_spectrum(int side, double peak_waves, std::uint64_t seed);

} // namespace sward::wind
