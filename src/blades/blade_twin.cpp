// SPDX-License-Identifier: Apache-2.0
#include "blades/blade_twin.h"

#include <array>
#include <cmath>

namespace sward::blades {

namespace {

constexpr std::array kSpeeds = {2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 28.0, 40.0}; // m/s
constexpr float kFitStep_s = 1.0f / 60;
constexpr int kFitSteps = 120;     // 2 s: the limpest is within exp(-6) of its rest
constexpr double kFitScale = 0.05; // of the canopy: tips that move less than this count by what
                                   // they are off, others by the share of it

/// Blades of a sample, and the wind's direction for each: by the golden angle, so that all are met
/// evenly.
struct Sample {
    const shared::BladeRecord* blade;
    glm::vec2 ahead;
};

std::vector<Sample> sample_of(const grass::GrassSet& set, int count) {
    std::vector<Sample> out;
    const std::size_t all = set.blades.size(),
                      taken = std::min<std::size_t>(all, static_cast<std::size_t>(count));
    for (std::size_t n = 0; n < taken; ++n) {
        const double angle = 2.39996322972865 * static_cast<double>(n);
        out.push_back({&set.blades[n * all / taken], {std::cos(angle), std::sin(angle)}});
    }
    return out;
}

glm::dvec2 simulated_tip(const std::vector<Sample>& sample, float canopy, float speed) {
    const shared::BladeStep rules = shared::plain_blade_step(kFitStep_s, canopy, 0);
    glm::dvec2 sum(0);
    for (const auto& [blade, ahead] : sample) {
        const shared::BladeBody body = shared::set_blade_body(rules, *blade, glm::vec3(0));
        glm::vec4 state(0);
        for (int i = 0; i < kFitSteps; ++i) {
            state = step_blade(rules, body, glm::vec3(0), speed * ahead, {}, state);
        }
        sum += glm::dvec2(glm::dot(glm::vec2(state.x, state.z), ahead), state.y);
    }
    return sum / static_cast<double>(sample.size());
}

glm::dvec2 warped_tip(const std::vector<Sample>& sample, float canopy, float speed,
                      float response) {
    glm::dvec2 sum(0);
    for (const auto& [blade, ahead] : sample) {
        const glm::vec3 offset = shared::bend_offset(blade->v2.y, canopy, speed * ahead, response);
        sum += glm::dvec2(glm::dot(glm::vec2(offset.x, offset.z), ahead), offset.y);
    }
    return sum / static_cast<double>(sample.size());
}

} // namespace

glm::vec4 step_blade(const shared::BladeStep& rules, const shared::BladeBody& body, glm::vec3 root,
                     glm::vec2 wind, std::span<const StepSphere> spheres, glm::vec4 state) {
    if (!shared::blade_moves(body)) {
        return glm::vec4(0);
    }
    glm::vec3 v2 = shared::state_tip(body, state);
    float eta = state.w;
    glm::vec3 v1 =
        shared::move_blade(rules, body, shared::checked_wind({wind.x, 0, wind.y}), v2, eta);
    const glm::vec3 moved = v2;
    bool touched = !spheres.empty();
    for (int round = 0; round < shared::kCollisionRounds && touched; ++round) {
        touched = false;
        for (const StepSphere& sphere : spheres) {
            const glm::vec4 now(glm::vec3(sphere.now_radius) - root, sphere.now_radius.w);
            const glm::vec3 before = glm::vec3(sphere.before) - root;
            touched = (shared::sphere_is_near(v1, v2, now, before) &&
                       shared::collide_blade(body, v1, v2, now, before)) ||
                      touched;
        }
    }
    return {v2 - body.calm2, shared::remember_push(rules, body, v2 - moved, eta)};
}

MeanTip mean_tip(const grass::GrassSet& set, double speed_mps, double response, int sample) {
    const auto blades = sample_of(set, sample);
    const auto speed = static_cast<float>(speed_mps);
    return {simulated_tip(blades, set.canopy_m, speed),
            warped_tip(blades, set.canopy_m, speed, static_cast<float>(response))};
}

double fit_response(const grass::GrassSet& set, int sample) {
    if (set.blades.empty()) {
        return 0.14 * (1.3 - 0.6);
    }
    const auto blades = sample_of(set, sample);
    std::array<glm::dvec2, kSpeeds.size()> truth;
    for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
        truth[i] = simulated_tip(blades, set.canopy_m, static_cast<float>(kSpeeds[i]));
    }
    const auto error = [&](double response) {
        double sum = 0;
        for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
            const glm::dvec2 off = warped_tip(blades, set.canopy_m, static_cast<float>(kSpeeds[i]),
                                              static_cast<float>(response)) -
                                   truth[i];
            const double least = kFitScale * set.canopy_m;
            sum += glm::dot(off, off) / (glm::dot(truth[i], truth[i]) + least * least);
        }
        return sum;
    };
    // Golden section on the logarithm: one valley, since every tip goes farther as the response
    // grows.
    double low = std::log(0.005), high = std::log(1.0);
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < 40; ++i) {
        const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
        (error(std::exp(a)) < error(std::exp(b)) ? high : low) =
            error(std::exp(a)) < error(std::exp(b)) ? b : a;
    }
    return std::exp(0.5 * (low + high));
}

} // namespace sward::blades
