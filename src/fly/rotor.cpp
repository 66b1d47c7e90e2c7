// SPDX-License-Identifier: Apache-2.0
#include "fly/rotor.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

#include "fly/motion.h"

namespace sward::fly {
namespace {

constexpr double kInduced = 1.15;      // of the ideal power: tips, and flow that is not even
constexpr double kInflow_s = 0.1;      // in which the flow follows the thrust
constexpr double kMostLift = 0.16;     // thrust coefficient over solidity at which blades stall
constexpr double kGovernor_per_s = 4;  // how fast the engine brings the rotor back to its speed
constexpr double kSlowest_share = 0.3; // of the proper speed: slower, it is no rotor any more
constexpr double kLeastGround = 0.6;   // of its radius: closer to the ground no rotor comes

/// Inflow of a hovering rotor that sinks along its axis, over that of hover; `x` is its climb over
/// the same. Momentum theory but for -2 < x < 0, where the wake is about the disc: there Leishman's
/// fit of measurements ("Principles of Helicopter Aerodynamics", 2.88).
double axial(double x) {
    if (x >= 0)
        return -x / 2 + std::sqrt(x * x / 4 + 1);
    if (x <= -2)
        return -x / 2 - std::sqrt(x * x / 4 - 1);
    return 1 + x * (-1.125 + x * (-1.372 + x * (-1.718 - 0.655 * x)));
}

/// A coefficient that grows no more past what blades carry.
double stalled(double coefficient, double most) {
    const double share = coefficient / most;
    return coefficient / std::pow(1 + std::pow(share, 6), 1.0 / 6);
}

} // namespace

double RotorSpec::area_m2() const {
    return glm::pi<double>() * radius_m * radius_m;
}

double RotorSpec::solidity() const {
    return blades * chord_m / (glm::pi<double>() * radius_m);
}

Rotor::Rotor(const RotorSpec& spec) : spec_(spec), rad_s_(spec.proper_rad_s()) {}

double Rotor::hover_inflow_mps(double thrust_n) const {
    return std::sqrt(std::max(thrust_n, 0.0) / (2 * kAir * spec_.area_m2()));
}

double Rotor::hover_blade_rad(double thrust_n) const {
    const double tip = spec_.tip_mps, coefficient = thrust_n / (kAir * spec_.area_m2() * tip * tip);
    return 3 * (2 * coefficient / (spec_.solidity() * spec_.lift_slope) +
                hover_inflow_mps(thrust_n) / tip / 2);
}

void Rotor::settle(double thrust_n) {
    rad_s_ = spec_.proper_rad_s();
    thrust_n_ = thrust_n;
    inflow_mps_ = hover_inflow_mps(thrust_n);
    engine_w_ = 0;
}

/// What the present thrust would have flow through the disc in the end.
double Rotor::induced(double thrust_n, const RotorAir& air) const {
    const double hover = std::max(0.1, hover_inflow_mps(thrust_n));
    const double x = air.climb_mps / hover, alone = axial(x);
    // Glauert: through a sphere about the disc flows what comes at it, whatever the direction. Of
    // an axial flow the fit says how much that is.
    const double along = x < 0 ? hover / alone : air.climb_mps + inflow_mps_;
    return hover * hover / std::max(0.2 * hover, std::hypot(air.aside_mps, along));
}

RotorLoad Rotor::step(double dt_s, double blade_rad, const RotorAir& air, double engine_w) {
    const double tip = rad_s_ * spec_.radius_m, area = spec_.area_m2(), sigma = spec_.solidity();
    inflow_mps_ += (induced(thrust_n_, air) - inflow_mps_) * std::min(1.0, dt_s / kInflow_s);
    // Cheeseman and Bennett, with their term of the speed.
    const double height = std::max(air.over_ground_m, kLeastGround * spec_.radius_m);
    const double near = std::pow(spec_.radius_m / (4 * height), 2) /
                        (1 + std::pow(air.aside_mps / std::max(0.5, inflow_mps_), 2));
    const double flow = inflow_mps_ * (1 - near);
    RotorLoad load;
    load.advance = std::min(0.5, air.aside_mps / tip);
    load.inflow = (air.climb_mps + flow) / tip;
    const double mu2 = load.advance * load.advance;
    const double coefficient =
        sigma * spec_.lift_slope / 2 * (blade_rad * (1.0 / 3 + mu2 / 2) - load.inflow / 2);
    const double carried = stalled(coefficient, sigma * kMostLift * (1 - load.advance));
    load.thrust_n = carried * kAir * area * tip * tip;
    const double profile =
        sigma * spec_.profile_drag / 8 * (1 + 4.65 * mu2) * kAir * area * tip * tip * tip;
    load.power_w = load.thrust_n * (kInduced * flow + air.climb_mps) + profile;
    thrust_n_ = load.thrust_n;
    const double lag_w =
        spec_.inertia_kgm2 * rad_s_ * kGovernor_per_s * (spec_.proper_rad_s() - rad_s_);
    engine_w_ = std::clamp(load.power_w + lag_w, 0.0, std::max(0.0, engine_w));
    rad_s_ += (engine_w_ - load.power_w) / (spec_.inertia_kgm2 * rad_s_) * dt_s;
    rad_s_ = std::clamp(rad_s_, kSlowest_share * spec_.proper_rad_s(), 1.3 * spec_.proper_rad_s());
    return load;
}

} // namespace sward::fly
