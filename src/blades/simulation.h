// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blades/colliders.h"
#include "blades/pages.h"
#include "blades/physics_pass.h"
#include "gl/pass.h"
#include "wind/wind.h"

namespace sward::blades {

/// Living blades through time, wherever they stand. Steps are counted from time 0, so that pictures
/// may come at any rate; between pictures the wind goes along step by step. What is drawn is the
/// last whole step.
class LivingBlades {
public:
    static constexpr double kStep_s = 1.0 / 60;
    /// Longer than any trail stays: a start or a leap with colliders begins so long before, and
    /// only what they touch lives through it.
    static constexpr double kRunUp_s = 14;

    struct Settings {
        Pages::Settings pages;
        double step_s =
            kStep_s; ///< of the physics; cost falls as it grows, past 1/20 s stiff blades overshoot
        StepPrograms programs = StepPrograms::kThree;
    };
    virtual ~LivingBlades() = default;
    LivingBlades(const LivingBlades&) = delete;
    LivingBlades& operator=(const LivingBlades&) = delete;

    struct Inputs {
        wind::Wind& wind;
        const terrain::Surface& surface;
        const Colliders& colliders;
        glm::dvec3 eye{0}; ///< world metres, y above the datum; the wind's window stands around it
        glm::dvec3 anchor{0}; ///< of the bound frame constants (world metres)
        int most_steps =
            0; ///< in this call, 0: any number; those before the last ones are then left out
        int most_wind_steps = 0;          ///< Wind::advance
        gl::PassTimers* timers = nullptr; ///< if any, gets the passes "wind" and "physics"
        std::span<const glm::dvec3> other_eyes = {}; ///< blades live around them too

        [[nodiscard]] std::vector<glm::dvec3> eyes() const {
            std::vector<glm::dvec3> all(other_eyes.begin(), other_eyes.end());
            all.insert(all.begin(), eye);
            return all;
        }
    };
    /// Pages in and out, and whole steps up to `time_s`; an earlier time begins anew. The wind then
    /// stands at `time_s`, and is bound. Before: frame constants and clipmap are bound. Throws as
    /// Wind::advance does.
    void advance(double time_s, const Inputs& inputs);

    [[nodiscard]] virtual PhysicsPass& pass() = 0;
    [[nodiscard]] virtual const PhysicsPass& pass() const = 0;
    [[nodiscard]] virtual std::uint64_t blades() const = 0; ///< that have a state
    [[nodiscard]] virtual std::size_t bytes() const { return pass().bytes(); } ///< of all buffers
    [[nodiscard]] virtual double
    reach_m() const = 0; ///< every blade nearer to one of the last eyes has one
    [[nodiscard]] std::int64_t steps() const {
        return done_;
    } ///< since time 0, those left out counted
    [[nodiscard]] std::uint64_t sphere_pairs() const {
        return pairs_;
    } ///< of a patch and a sphere, in the last call
    [[nodiscard]] const Settings& settings() const { return settings_; }

protected:
    /// `canopy_m` and `response` as BladeStep takes them.
    LivingBlades(Settings settings, double canopy_m, double response);
    [[nodiscard]] virtual bool no_room() const = 0;
    virtual void clear() = 0;
    /// Pages in and out, their places to the GPU.
    virtual void page(const Inputs& inputs) = 0;
    /// The broad phase.
    [[nodiscard]] virtual SphereLists meet(std::span<const MovingSphere> spheres,
                                           glm::dvec3 anchor) const = 0;

private:
    void restart(double time_s, bool run_up);
    void blow(double time_s, const Inputs& inputs) const;
    void step(double time_s, std::span<const MovingSphere> spheres, const shared::BladeStep& rules,
              const Inputs& inputs);

    Settings settings_;
    shared::BladeStep rules_;
    std::int64_t done_ = -1;      ///< the last step's number
    std::int64_t lives_from_ = 0; ///< the first step after a run-up
    std::uint64_t pairs_ = 0;
};

/// The living blades of a set around an eye.
class Simulation final : public LivingBlades {
public:
    /// `response`: of the grouped pose that blades begin in, 1 / (m/s).
    Simulation(const grass::GrassSet& set, double response, Settings settings);

    [[nodiscard]] const Pages& pages() const { return pages_; }
    [[nodiscard]] PhysicsPass& pass() override { return pass_; }
    [[nodiscard]] const PhysicsPass& pass() const override { return pass_; }
    [[nodiscard]] std::uint64_t blades() const override;
    [[nodiscard]] double reach_m() const override { return pages_.reach_m(); }

private:
    [[nodiscard]] bool no_room() const override { return pages_.slots().empty(); }
    void clear() override { pages_.clear(); }
    void page(const Inputs& inputs) override;
    [[nodiscard]] SphereLists meet(std::span<const MovingSphere> spheres,
                                   glm::dvec3 anchor) const override;

    double side_m_, blade_reach_m_ = 0;
    std::vector<std::uint32_t> variant_begin_;
    Pages pages_;
    PhysicsPass pass_;
};

} // namespace sward::blades
