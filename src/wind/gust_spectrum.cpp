// SPDX-License-Identifier: Apache-2.0
#include "wind/gust_spectrum.h"

#include <cmath>
#include <complex>

#include "base/hash.h"

namespace sward::wind {

namespace {

using Complex = std::complex<double>;
constexpr double kTwoPi = 6.283185307179586;

/// Cooley and Tukey's transform in place, without scaling; `stride` between elements.
void transform(Complex* data, int n, int stride) {
    for (int i = 1, j = 0; i < n; ++i) {
        int bit = n >> 1;
        for (; j & bit; bit >>= 1) {
            j ^= bit;
        }
        j ^= bit;
        if (i < j) {
            std::swap(data[static_cast<std::ptrdiff_t>(i) * stride],
                      data[static_cast<std::ptrdiff_t>(j) * stride]);
        }
    }
    for (int length = 2; length <= n; length *= 2) {
        for (int k = 0; k < length / 2; ++k) {
            const Complex turn = std::polar(1.0, kTwoPi * k / length);
            for (int i = k; i < n; i += length) {
                Complex& a = data[static_cast<std::ptrdiff_t>(i) * stride];
                Complex& b = data[static_cast<std::ptrdiff_t>(i + length / 2) * stride];
                const Complex t = turn * b;
                b = a - t;
                a += t;
            }
        }
    }
}

/// A random field whose real and imaginary parts are independent and have the spectrum.
std::vector<Complex> random_stream(int n, double peak, std::uint64_t seed, std::uint64_t group) {
    std::vector<Complex> field(static_cast<std::size_t>(n) * n);
    const double shortest = n / 6.0; // waves of fewer cells would only be smeared by the advection
    for (int row = 0; row < n; ++row) {
        for (int column = 0; column < n; ++column) {
            const double kx = column <= n / 2 ? column : column - n,
                         ky = row <= n / 2 ? row : row - n;
            const double k = std::hypot(kx, ky);
            if (k < 1.5 || k > shortest) {
                continue;
            }
            const double energy = k * k * k / std::pow(peak * peak + k * k, 7.0 / 3.0);
            const double amplitude = std::sqrt(
                energy / (k * k * k)); // |psi| of one mode: energy / (2 pi k) = k^2 |psi|^2
            const auto place = static_cast<std::size_t>(row) * n + column;
            field[place] =
                std::polar(amplitude, kTwoPi * base::hash_unit(seed, 0x9057 + group, place));
        }
    }
    for (int row = 0; row < n; ++row) {
        transform(field.data() + static_cast<std::ptrdiff_t>(row) * n, n, 1);
    }
    for (int column = 0; column < n; ++column) {
        transform(field.data() + column, n, n);
    }
    return field;
}

} // namespace

void GustSpectrum::velocities(const std::array<double, kGustGroups>& phases, std::vector<float>& u,
                              std::vector<float>& v) const {
    const std::size_t count = static_cast<std::size_t>(side) * side;
    std::vector<double> psi(count, 0.0);
    for (std::size_t g = 0; g < stream.size(); ++g) {
        const double c = std::cos(phases[g]), s = std::sin(phases[g]);
        for (std::size_t i = 0; i < count; ++i) {
            psi[i] +=
                c * static_cast<double>(stream[g][i].x) + s * static_cast<double>(stream[g][i].y);
        }
    }
    u.resize(count);
    v.resize(count);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const std::size_t own = static_cast<std::size_t>(row) * side + column;
            const std::size_t east = static_cast<std::size_t>(row) * side + (column + 1) % side;
            const std::size_t south = static_cast<std::size_t>((row + 1) % side) * side + column;
            u[own] = static_cast<float>(psi[south] - psi[own]);
            v[own] = static_cast<float>(psi[own] - psi[east]);
        }
    }
}

GustSpectrum gust_spectrum(int side, double peak_waves, std::uint64_t seed) {
    GustSpectrum out;
    out.side = side;
    for (int g = 0; g < kGustGroups; ++g) {
        auto& stream = out.stream[static_cast<std::size_t>(g)];
        for (const Complex& value :
             random_stream(side, peak_waves, seed, static_cast<std::uint64_t>(g))) {
            stream.emplace_back(static_cast<float>(value.real()), static_cast<float>(value.imag()));
        }
    }
    std::vector<float> u, v;
    out.velocities({}, u, v);
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        sum += static_cast<double>(u[i]) * static_cast<double>(u[i]) +
               static_cast<double>(v[i]) * static_cast<double>(v[i]);
    }
    const double scale = 1 / std::sqrt(sum / (2.0 * static_cast<double>(u.size())));
    for (auto& stream : out.stream) {
        for (glm::vec2& value : stream) {
            value *= static_cast<float>(scale);
        }
    }
    return out;
}

} // namespace sward::wind
