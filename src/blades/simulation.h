// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blades/colliders.h"
#include "blades/pages.h"
#include "blades/physics_pass.h"
#include "gl/pass.h"
#include "wind/wind.h"

namespace sward::blades {

/// The living blades around an eye through time. Steps are counted from time 0, so that pictures may come at any rate; between
/// pictures the wind goes along step by step. What is drawn is the last whole step.
class Simulation {
public:
    static constexpr double kStep_s = 1.0 / 60;
    /// Longer than any trail stays: a start or a leap with colliders begins so long before, and only what they touch lives through it.
    static constexpr double kRunUp_s = 14;

    struct Settings {
        Pages::Settings pages;
        double step_s = kStep_s; ///< of the physics; cost falls as it grows, past 1/20 s stiff blades overshoot
    };
    /// `response`: of the grouped pose that blades begin in, 1 / (m/s).
    Simulation(const grass::GrassSet& set, double response, Settings settings);

    struct Inputs {
        wind::Wind& wind;
        const terrain::Surface& surface;
        const Colliders& colliders;
        glm::dvec3 eye{0};       ///< world metres, y above the datum
        glm::dvec3 anchor{0};    ///< of the bound frame constants (world metres)
        int most_steps = 0;      ///< in this call, 0: any number; those before the last ones are then left out
        int most_wind_steps = 0; ///< Wind::advance
        gl::PassTimers* timers = nullptr; ///< if any, gets the passes "wind" and "physics"
    };
    /// Pages in and out, and whole steps up to `time_s`; an earlier time begins anew. The wind then stands at `time_s`, and is bound.
    /// Before: frame constants and clipmap are bound. Throws as Wind::advance does.
    void advance(double time_s, const Inputs& inputs);

    [[nodiscard]] const Pages& pages() const { return pages_; }
    [[nodiscard]] PhysicsPass& pass() { return pass_; }
    [[nodiscard]] const PhysicsPass& pass() const { return pass_; }
    [[nodiscard]] std::uint64_t blades() const; ///< that have a state
    [[nodiscard]] std::int64_t steps() const { return done_; } ///< since time 0, those left out counted
    [[nodiscard]] std::uint64_t sphere_pairs() const { return pairs_; } ///< of a patch and a sphere, in the last call
    [[nodiscard]] const Settings& settings() const { return settings_; }

private:
    void restart(double time_s, bool run_up);
    void blow(double time_s, const Inputs& inputs) const;
    void step(std::int64_t number, const Inputs& inputs, bool run_up);
    void physics(double time_s, const shared::BladeStep& rules, const SphereLists& lists, const Inputs& inputs);

    Settings settings_;
    double side_m_, reach_m_ = 0;
    std::vector<std::uint32_t> variant_begin_;
    shared::BladeStep rules_;
    Pages pages_;
    PhysicsPass pass_;
    std::int64_t done_ = -1; ///< the last step's number
    std::int64_t lives_from_ = 0; ///< the first step after a run-up
    std::uint64_t pairs_ = 0;
};

} // namespace sward::blades
