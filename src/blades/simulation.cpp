// SPDX-License-Identifier: Apache-2.0
#include "blades/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace sward::blades {

Simulation::Simulation(const grass::GrassSet& set, double response, Settings settings)
    : settings_(settings), side_m_(set.side_m), variant_begin_(set.variant_begin),
      rules_(shared::plain_blade_step(static_cast<float>(settings.step_s), set.canopy_m, static_cast<float>(response))),
      pages_(set, settings.pages), pass_(set, pages_) {
    for (const shared::BladeRecord& blade : set.blades) {
        reach_m_ = std::max<double>(reach_m_, blade.shape.y);
    }
}

void Simulation::restart(double time_s, bool run_up) {
    pages_.clear();
    lives_from_ = static_cast<std::int64_t>(std::floor(time_s / settings_.step_s + 1e-6)) + 1;
    const auto back = run_up ? static_cast<std::int64_t>(std::ceil(kRunUp_s / settings_.step_s)) : 0;
    done_ = std::max<std::int64_t>(lives_from_ - 1 - back, 0);
}

void Simulation::blow(double time_s, const Inputs& inputs) const {
    std::optional<gl::PassScope> scope;
    if (inputs.timers) {
        scope.emplace(*inputs.timers, "wind");
    }
    inputs.wind.advance(time_s, {inputs.eye.x, inputs.eye.z}, inputs.most_wind_steps);
    inputs.wind.bind();
}

void Simulation::physics(double time_s, const shared::BladeStep& rules, const SphereLists& lists, const Inputs& inputs) {
    std::optional<gl::PassScope> scope;
    if (inputs.timers) {
        scope.emplace(*inputs.timers, "physics");
    }
    pass_.step(rules, inputs.wind.field({inputs.anchor.x, inputs.anchor.z}, time_s), lists);
}

void Simulation::step(std::int64_t number, const Inputs& inputs, bool run_up) {
    const double time_s = static_cast<double>(number) * settings_.step_s;
    blow(time_s, inputs);
    const auto spheres = inputs.colliders.at(time_s, settings_.step_s);
    const SphereLists lists = sphere_lists(pages_, side_m_, reach_m_, spheres, inputs.anchor);
    pairs_ += lists.pairs;
    shared::BladeStep rules = rules_;
    rules.time.w = run_up ? 1.0f : 0.0f;
    physics(time_s, rules, lists, inputs);
}

void Simulation::advance(double time_s, const Inputs& inputs) {
    pairs_ = 0;
    const auto target = static_cast<std::int64_t>(std::floor(time_s / settings_.step_s + 1e-6));
    const auto longest = static_cast<std::int64_t>(kRunUp_s / settings_.step_s);
    if (pages_.slots().empty() || !std::isfinite(time_s)) {
        blow(time_s, inputs);
        return;
    }
    if (done_ < 0 || target < done_ || target - done_ > longest) {
        restart(time_s, inputs.colliders.any());
    }
    pages_.update(inputs.surface, inputs.eye);
    pass_.place(pages_, side_m_, inputs.anchor);
    if (inputs.most_steps > 0 && lives_from_ <= done_) {
        done_ = std::max(done_, target - inputs.most_steps);
    }
    bool set_up = false;
    while (done_ < target) {
        ++done_;
        const bool run_up = done_ < lives_from_;
        step(done_, inputs, run_up);
        set_up = !run_up;
    }
    blow(time_s, inputs);
    if (!set_up) { // no step has looked after blades that begin
        shared::BladeStep rules = rules_;
        rules.time.x = 0;
        physics(time_s, rules, sphere_lists(pages_, side_m_, reach_m_, {}, inputs.anchor), inputs);
    }
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
