// SPDX-License-Identifier: Apache-2.0
#include "wind/wind.h"

#include <cmath>

#include "base/hash.h"

namespace sward::wind {

namespace {
constexpr double kTwoPi = 6.283185307179586;
// Wavelengths of the gust fronts (m): the first are the large fronts one sees run over a field, the last its shimmer.
constexpr double kWavelengths_m[shared::kGustWaves] = {140, 83, 47, 29, 17, 9};
constexpr double kAmplitudes[shared::kGustWaves] = {0.27, 0.22, 0.18, 0.14, 0.11, 0.08};
} // namespace

Wind::Wind(const scene::WindSpec& spec, double response) : gust_(spec.gust), response_(response) {
    const double from = spec.direction_deg * kTwoPi / 360; // where it comes from, clockwise from north (-z)
    mean_ = glm::dvec2(-std::sin(from), std::cos(from)) * spec.speed_ms;
    const double heading = std::atan2(mean_.y, mean_.x);
    for (int i = 0; i < shared::kGustWaves; ++i) {
        const auto random = [&](std::uint64_t n) { return base::hash_unit(static_cast<std::uint64_t>(spec.seed), 0x9057, static_cast<std::uint64_t>(i) * 2 + n); };
        const double turn = (random(0) - 0.5) * 1.5; // fronts run within 43 degrees of the wind
        const double k = kTwoPi / kWavelengths_m[i];
        waves_[i].k = glm::dvec2(std::cos(heading + turn), std::sin(heading + turn)) * k;
        waves_[i].omega = k * std::max(spec.speed_ms, 0.5) * (0.8 + 0.06 * i); // shorter gusts decay, long ones lag the mean
        waves_[i].phase = random(1) * 2 * kTwoPi;
        waves_[i].amplitude = kAmplitudes[i];
    }
}

shared::WindField Wind::field(glm::dvec2 anchor, double time_s) const {
    shared::WindField field{};
    field.mean = {mean_.x, mean_.y, gust_, response_};
    for (int i = 0; i < shared::kGustWaves; ++i) {
        const Wave& wave = waves_[i];
        // The direction's sway uses half the phase: reduce modulo 4 pi, in double, before it becomes a float.
        const double phase = std::fmod(glm::dot(wave.k, anchor) - wave.omega * time_s + wave.phase, 2 * kTwoPi);
        field.waves[i] = {wave.k.x, wave.k.y, phase, wave.amplitude};
    }
    return field;
}

glm::dvec2 Wind::at(double x, double z, double time_s) const {
    return shared::wind_field_at(field({x, z}, time_s), glm::vec2(0));
}

} // namespace sward::wind
