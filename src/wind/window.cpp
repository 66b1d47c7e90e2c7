// SPDX-License-Identifier: Apache-2.0
#include "wind/window.h"

#include <cmath>

namespace sward::wind {

namespace {

constexpr double kCalm_mps = 6,
                 kCalmOfMean =
                     2; // air braked above this: eddies behind obstacles, dying gusts stay below

FluidSettings settings_of(const scene::WindSpec& spec, int cells, glm::dvec2 mean_mps) {
    FluidSettings settings;
    settings.cells = cells;
    settings.cell_m = spec.cell_m;
    settings.step_s = spec.step_s;
    settings.confinement = spec.confinement;
    settings.viscosity_m2s = spec.viscosity_m2s;
    settings.dissipation_per_s = spec.dissipation_per_s;
    settings.mean_mps = mean_mps;
    return settings;
}

double calm_of(const scene::WindSpec& spec) {
    return kCalm_mps + kCalmOfMean * spec.speed_mps * (1 + spec.gust);
}

} // namespace

void Window::set_mean(const scene::WindSpec& spec, glm::dvec2 mean_mps) {
    calm_mps_ = calm_of(spec);
    fluid_.set_mean(mean_mps);
}

Window::Window(const scene::WindSpec& spec, int cells, glm::dvec2 mean_mps)
    : fluid_(settings_of(spec, cells, mean_mps)), calm_mps_(calm_of(spec)) {
    tag_.step_s = spec.step_s;
    tag_.cells = cells;
    tag_.cell_m = spec.cell_m;
}

glm::ivec2 Window::first_for(glm::dvec2 eye) const {
    const glm::dvec2 centre =
        glm::round(eye / (tag_.cell_m * kMoveCells)) * static_cast<double>(kMoveCells);
    return glm::ivec2(glm::clamp(centre, glm::dvec2(-1e9), glm::dvec2(1e9))) - tag_.cells / 2;
}

glm::dvec2 Window::corner_for(glm::dvec2 eye) const {
    return glm::dvec2(first_for(eye)) * tag_.cell_m;
}

void Window::begin(glm::dvec2 eye, std::int64_t first, const shared::WindField& ambient) {
    tag_.latest = tag_.first = first;
    tag_.first_cell = first_for(eye);
    fluid_.move_to(tag_.first_cell, ambient);
}

void Window::follow(glm::dvec2 eye, const shared::WindField& ambient) {
    const glm::ivec2 first = first_for(eye);
    if (first != tag_.first_cell) {
        tag_.first_cell = first;
        fluid_.move_to(first, ambient);
    }
}

void Window::step(FluidInputs& inputs, const shared::WindField& ambient) {
    fluid_.step(inputs, next_time_s(), ambient, calm_mps_);
    ++tag_.latest;
}

} // namespace sward::wind
