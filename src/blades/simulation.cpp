// SPDX-License-Identifier: Apache-2.0
#include "blades/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sward::blades {

LivingBlades::LivingBlades(Settings settings, double canopy_m, double response)
    : settings_(settings),
      rules_(shared::plain_blade_step(static_cast<float>(settings.step_s),
                                      static_cast<float>(canopy_m), static_cast<float>(response))) {
}

void LivingBlades::restart(double time_s, bool run_up) {
    clear();
    lives_from_ = static_cast<std::int64_t>(std::floor(time_s / settings_.step_s + 1e-6)) + 1;
    const auto back =
        run_up ? static_cast<std::int64_t>(std::ceil(kRunUp_s / settings_.step_s)) : 0;
    done_ = std::max<std::int64_t>(lives_from_ - 1 - back, 0);
}

void LivingBlades::blow(double time_s, const Inputs& inputs) const {
    std::optional<gl::PassScope> scope;
    if (inputs.timers) {
        scope.emplace(*inputs.timers, "wind");
    }
    inputs.wind.advance(time_s, {inputs.eye.x, inputs.eye.z}, inputs.most_wind_steps);
    inputs.wind.bind();
}

void LivingBlades::step(double time_s, std::span<const MovingSphere> spheres,
                        const shared::BladeStep& rules, const Inputs& inputs) {
    std::optional<gl::PassScope> scope;
    if (inputs.timers) {
        scope.emplace(*inputs.timers, "physics"); // the broad phase is a part of it
    }
    const SphereLists lists = meet(spheres, inputs.anchor);
    pairs_ += lists.pairs;
    pass().step(rules, inputs.wind.field({inputs.anchor.x, inputs.anchor.z}, time_s), lists);
}

void LivingBlades::advance(double time_s, const Inputs& inputs) {
    pairs_ = 0;
    const auto target = static_cast<std::int64_t>(std::floor(time_s / settings_.step_s + 1e-6));
    const auto longest = static_cast<std::int64_t>(kRunUp_s / settings_.step_s);
    if (no_room() || !std::isfinite(time_s)) {
        blow(time_s, inputs);
        return;
    }
    if (done_ < 0 || target < done_ || target - done_ > longest) {
        restart(time_s, inputs.colliders.any());
    }
    page(inputs);
    if (inputs.most_steps > 0 && lives_from_ <= done_) {
        done_ = std::max(done_, target - inputs.most_steps);
    }
    shared::BladeStep rules = rules_;
    bool set_up = false;
    while (done_ < target) {
        ++done_;
        const bool run_up = done_ < lives_from_;
        rules.run_up = run_up ? 1 : 0;
        const double then_s = static_cast<double>(done_) * settings_.step_s;
        blow(then_s, inputs);
        step(then_s, inputs.colliders.at(then_s, settings_.step_s), rules, inputs);
        set_up = !run_up;
    }
    blow(time_s, inputs);
    if (!set_up) { // no step has looked after blades that begin
        rules = rules_;
        rules.step_s = 0;
        step(time_s, {}, rules, inputs);
    }
}

Simulation::Simulation(const grass::GrassSet& set, double response, Settings settings)
    : LivingBlades(settings, set.canopy_m, response), side_m_(set.side_m),
      variant_begin_(set.variant_begin), pages_(set, settings.pages),
      pass_(set, pages_, settings.programs) {
    for (const shared::BladeRecord& blade : set.blades) {
        blade_reach_m_ = std::max<double>(blade_reach_m_, blade.shape.y);
    }
}

void Simulation::page(const Inputs& inputs) {
    pages_.update(inputs.surface, inputs.eyes());
    pass_.place(pages_, side_m_, inputs.anchor);
}

SphereLists Simulation::meet(std::span<const MovingSphere> spheres, glm::dvec3 anchor) const {
    return sphere_lists(pages_, side_m_, blade_reach_m_, spheres, anchor);
}

std::uint64_t Simulation::blades() const {
    std::uint64_t sum = 0;
    for (const Pages::Page& page : pages_.slots()) {
        if (page.used) {
            const auto variant = static_cast<std::size_t>(page.variant);
            sum += variant_begin_[variant + 1] - variant_begin_[variant];
        }
    }
    return sum;
}

} // namespace sward::blades
