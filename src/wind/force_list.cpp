// SPDX-License-Identifier: Apache-2.0
#include "wind/force_list.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angles.h"

namespace sward::wind {
namespace {

using shared::WindForce;
using Kind = scene::WindSource::Kind;

using std::numbers::pi;
constexpr double kGravity = 9.81;           // m/s2
constexpr double kAirDensity = 1.225;       // kg/m3
constexpr double kContraction = 0.70710678; // of a rotor's wake
constexpr double kCoreDiameters = 6;        // potential core of a round jet
constexpr double kRingRadii = 1.5; // the outwash is fastest here, in radii of the jet that arrives
constexpr double kReachRadii = 6;  // of rings and vortices whose file gives none
constexpr double kJetRadii = 4;    // length of a jet's driven core likewise
// Rates (1/s). Air passes an arrow's disc in 2 radii / strength; by then exp(-4) of the difference
// is left.
constexpr double kArrowRate = 4;
constexpr double kJetRate = 4;
constexpr double kWakeRate = 1;
// Inflow draws vorticity together as fast as it flows in: the push must hold the speed against
// that.
constexpr double kVortexRate = 0.5, kInflowRate = 20;

glm::dvec2 heading(double yaw_deg) {
    return base::Heading(yaw_deg).ahead();
}

void set_place(WindForce& force, glm::dvec2 place, glm::dvec2 along) {
    force.place = glm::vec2(place);
    force.along = glm::vec2(along);
}

/// What pushes along its direction.
void set_push(WindForce& force, int kind, double speed, double rate_per_s) {
    force.kind = kind;
    force.speed_mps = static_cast<float>(speed);
    force.rate_per_s = static_cast<float>(rate_per_s);
}

void set_extent(WindForce& force, double radius_m, double reach_m) {
    force.radius_m = static_cast<float>(radius_m);
    force.reach_m = static_cast<float>(reach_m);
}

WindForce arrow_force(const scene::WindArrow& arrow, glm::dvec2 origin, double least_m) {
    WindForce force{};
    const double radius = std::max(arrow.radius_m, least_m);
    set_place(force, arrow.tip - origin, glm::normalize(arrow.tip - arrow.root));
    set_extent(force, radius, 0);
    set_push(force, shared::kForceDisc, arrow.strength_mps,
             kArrowRate * arrow.strength_mps / (2 * radius));
    return force;
}

/// Kind and lengths of a radial or tangential source of one speed.
void set_ring(WindForce& force, int kind, double speed, double radius, double reach) {
    set_extent(force, radius, reach > 0 ? reach : kReachRadii * radius);
    set_push(force, kind, speed, 0);
}

} // namespace

Outwash rotor_outwash(const scene::WindSource& rotor, double height_m) {
    const double area = pi * rotor.radius_m * rotor.radius_m;
    const double wake = rotor.strength_mps
                            ? *rotor.strength_mps
                            : 2 * std::sqrt(*rotor.mass_kg * kGravity / (2 * kAirDensity * area));
    const double jet_radius = kContraction * rotor.radius_m;
    const double slowed =
        std::hypot(1.0, std::max(height_m, 0.0) / (kCoreDiameters * 2 * jet_radius));
    return {wake / slowed, kRingRadii * jet_radius * slowed};
}

ForceList::ForceList(const scene::WindSpec& spec, Paths paths, GroundHeight ground)
    : sources_(spec.sources), paths_(std::move(paths)), ground_(std::move(ground)) {
    set_arrows(spec.arrows);
}

void ForceList::set_arrows(std::vector<scene::WindArrow> arrows) {
    arrows_ = std::move(arrows);
    spans_ = arrow_spans(arrows_);
}

WindForce ForceList::force_of(const scene::WindSource& source, double time_s,
                              glm::dvec2 origin) const {
    const Carried at = carried_at(source.where, paths_, time_s);
    const double radius = source.radius_m;
    double strength = source.strength_mps.value_or(0);
    WindForce force{};
    set_place(force, at.place - origin, heading(at.yaw_deg));
    switch (source.kind) {
    case Kind::kRotor: {
        const double ground = at.agl ? 0 : ground_(at.place.x, at.place.y);
        const Outwash outwash =
            rotor_outwash(source, source.height_m.value_or(at.height_m - ground));
        set_ring(force, shared::kForceRing, outwash.speed_mps, outwash.radius_m, source.reach_m);
        force.reach_m = std::max(force.reach_m, static_cast<float>(1.5 * outwash.radius_m));
        break;
    }
    case Kind::kFan:
        set_ring(force, shared::kForceRing, strength, radius, source.reach_m);
        break;
    case Kind::kCyclone:
        set_ring(force, shared::kForceVortex, strength, radius, source.reach_m);
        force.rate_per_s = static_cast<float>((kVortexRate + kInflowRate * source.inflow) *
                                              std::max(strength / radius, 0.5));
        // Its sign is the turn: an inflow of 0 keeps one.
        force.inflow =
            static_cast<float>(std::max(source.inflow, 1e-6) * (source.clockwise ? 1 : -1));
        force.velocity = glm::vec2(at.velocity);
        break;
    case Kind::kJet: {
        const double length = source.length_m > 0 ? source.length_m : kJetRadii * radius;
        set_extent(force, radius, length);
        set_push(force, shared::kForceStrip, strength, kJetRate * strength / length);
        break;
    }
    case Kind::kWake: {
        const double speed = glm::length(at.velocity);
        if (speed > 1e-3)
            set_place(force, at.place - origin, at.velocity / speed);
        if (!source.strength_mps)
            strength = speed;
        set_extent(force, radius, source.length_m);
        set_push(force, shared::kForceWake, strength, kWakeRate * strength / radius);
        break;
    }
    case Kind::kWave: {
        const double k = 2 * pi / source.wavelength_m;
        set_extent(force, radius, radius);
        set_push(force, shared::kForceWave, strength, 0);
        force.wave_number = static_cast<float>(k);
        force.wave_phase = static_cast<float>(
            -std::fmod(k * source.travel_mps.value_or(strength) * time_s, 2 * pi));
        break;
    }
    }
    return force;
}

std::vector<WindForce> ForceList::at(double time_s, glm::dvec2 origin, double least_m) const {
    std::vector<WindForce> forces;
    for (std::size_t i = 0; i < arrows_.size(); ++i)
        if (time_s >= spans_[i].start_s && time_s < spans_[i].end_s && arrows_[i].strength_mps > 0)
            forces.push_back(arrow_force(arrows_[i], origin, least_m));
    const auto add = [&](const scene::WindSource& source) {
        WindForce force = force_of(source, time_s, origin);
        force.radius_m = std::max(force.radius_m, static_cast<float>(least_m));
        if (force.speed_mps > 0)
            forces.push_back(force);
    };
    for (const scene::WindSource& source : sources_)
        if (time_s >= source.start_s && time_s < source.end_s)
            add(source);
    for (const scene::MovingWindSource& moving : moving_) {
        scene::WindSource source = moving.source;
        source.where.place += moving.velocity_mps * (time_s - moving.time_s);
        add(source);
    }
    return forces;
}

glm::vec4 force_bounds(const WindForce& force) {
    const glm::vec2 place = force.place, along = force.along;
    const int kind = force.kind;
    glm::vec2 other = place;
    float reach = force.radius_m;
    if (kind == shared::kForceStrip)
        other = place + along * force.reach_m;
    else if (kind == shared::kForceWake) {
        other = place - along * force.reach_m;
        reach *= 2 * shared::wake_at(force.reach_m / force.radius_m).y;
    } else if (kind != shared::kForceDisc)
        reach = force.reach_m;
    return {glm::min(place, other) - reach, glm::max(place, other) + reach};
}

bool relaxes(const WindForce& force) {
    return force.rate_per_s > 0;
}

bool brings_air(const WindForce& force) {
    return force.kind >= shared::kForceRing;
}

} // namespace sward::wind
