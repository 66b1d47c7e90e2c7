// SPDX-License-Identifier: Apache-2.0
#include "fly/aeroplane.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "base/angles.h"

namespace sward::fly {
namespace {

using glm::dvec3;

constexpr double kSlowest_mps = 1;   // slower air gives angles no sense
constexpr double kSag_m = 0.1;       // of a wheel under its share of the weight
constexpr double kGearDamping = 0.5; // share of the critical one
constexpr double kRolling = 0.04, kBraked = 0.45, kSideways = 0.7; // of a tyre's load, on grass
constexpr double kSteer = 20 * kDegree;                            // of the nose wheel
constexpr double kHardest_mps = 5; // a landing that the gear survives
constexpr double kStallBlend = 40; // how sharply the flow leaves the wing, 1/rad

} // namespace

Aeroplane::Aeroplane(const AeroplaneSpec& spec, FlyLand land)
    : spec_(spec), land_(std::move(land)) {
    const double half = spec_.gear_track_m / 2, low = -spec_.gear_m - kSag_m;
    wheels_ = {Wheel{{0, low, -spec_.gear_ahead_m}},
               Wheel{{-half, low, spec_.gear_back_m}, 0, 0, true},
               Wheel{{half, low, spec_.gear_back_m}, 0, 0, true}};
    const double whole = spec_.gear_ahead_m + spec_.gear_back_m, weight = spec_.mass_kg * kGravity;
    wheels_[0].load_n = weight * spec_.gear_back_m / whole;
    wheels_[1].load_n = wheels_[2].load_n = weight * spec_.gear_ahead_m / whole / 2;
    trim();
    put_on_ground(0, 0, 0);
}

/// Level flight at cruising speed: lift is weight, no moment, pull is drag.
void Aeroplane::trim() {
    const Derivatives& air = spec_.air;
    const double pressure = 0.5 * kAir * spec_.cruise_mps * spec_.cruise_mps;
    const double lift = spec_.mass_kg * kGravity / (pressure * spec_.wing_m2);
    trim_attack_ = (lift - air.lift_zero) / air.lift_slope;
    trim_elevator_ = -(air.pitch_zero + air.pitch_slope * trim_attack_) / air.pitch_elevator;
    const double aspect = spec_.span_m * spec_.span_m / spec_.wing_m2;
    const double drag = (air.drag_zero + lift * lift / (glm::pi<double>() * air.oswald * aspect)) *
                        pressure * spec_.wing_m2;
    const double most = std::min(spec_.static_pull_kn * 1000,
                                 spec_.propeller * spec_.power_kw * 1000 / spec_.cruise_mps);
    cruise_throttle_ = std::clamp(drag / most, 0.0, 1.0);
}

void Aeroplane::put_on_ground(double x, double z, double yaw_deg) {
    start_ = {};
    start_.position = {x, land_.height(x, z) + spec_.gear_m, z};
    start_.turn = heading(yaw_deg);
    start_.on_ground = true;
    begin_again();
}

void Aeroplane::put_in_air(const dvec3& position, double yaw_deg) {
    start_ = {};
    start_.position = position;
    start_.turn = heading(yaw_deg) * glm::angleAxis(trim_attack_, dvec3(1, 0, 0));
    start_.velocity_mps =
        base::direction_of(yaw_deg, 0) * spec_.cruise_mps + land_.wind_at(position);
    begin_again();
}

/// Lift, drag and moments of the air that it moves through, and the propeller's pull.
void Aeroplane::add_air(const Stick& stick, Sum& sum) {
    const Derivatives& air = spec_.air;
    const dvec3 through = now_.velocity_mps - land_.wind_at(now_.position);
    const dvec3 v = to_air(glm::inverse(now_.turn) * through);
    const double speed = glm::length(v), pull_speed = std::max(kSlowest_mps, v.x);
    now_.airspeed_mps = speed;
    now_.pull_n =
        std::clamp(stick.throttle, 0.0, 1.0) *
        std::min(spec_.static_pull_kn * 1000, spec_.propeller * spec_.power_kw * 1000 / pull_speed);
    dvec3 force(now_.pull_n, 0, 0), moment(0);
    now_.attack_rad = now_.slip_rad = 0;
    now_.stalled = false;
    if (speed > kSlowest_mps) {
        const double attack = std::atan2(v.z, v.x),
                     slip = std::asin(std::clamp(v.y / speed, -1.0, 1.0)),
                     stall = spec_.stall_deg * kDegree;
        now_.attack_rad = attack;
        now_.slip_rad = slip;
        now_.stalled = std::abs(attack) > stall;
        // From an attached flow to a flat plate's, over the angle of stall (Beard and McLain,
        // "Small Unmanned Aircraft", 4.9).
        const double a = std::exp(-kStallBlend * (attack - stall)),
                     b = std::exp(kStallBlend * (attack + stall));
        const double apart = std::isfinite(a * b) ? (1 + a + b) / ((1 + a) * (1 + b)) : 1;
        const double plate =
            2 * std::copysign(1.0, attack) * std::sin(attack) * std::sin(attack) * std::cos(attack);
        const double lift = (1 - apart) * (air.lift_zero + air.lift_slope * attack) + apart * plate;
        const double aspect = spec_.span_m * spec_.span_m / spec_.wing_m2;
        const double over =
            std::max(0.05, now_.position.y - land_.height(now_.position.x, now_.position.z)) * 16 /
            spec_.span_m;
        const double near_ground =
            over * over / (1 + over * over); // of the induced drag (McCormick, "Aerodynamics,
                                             // Aeronautics and Flight Mechanics", 7.6)
        const double induced =
            (1 - apart) * near_ground * lift * lift / (glm::pi<double>() * air.oswald * aspect);
        const double drag = air.drag_zero + induced +
                            apart * 2 * std::sin(attack) * std::sin(attack) + 0.5 * slip * slip;
        const double pressure = 0.5 * kAir * speed * speed * spec_.wing_m2;
        force += pressure * dvec3(-drag * std::cos(attack) + lift * std::sin(attack),
                                  air.side_slip * slip,
                                  -drag * std::sin(attack) - lift * std::cos(attack));
        const dvec3 deflection =
            dvec3(stick.roll, -stick.pitch, stick.yaw) * spec_.throw_deg * kDegree +
            dvec3(0, trim_elevator_, 0);
        const dvec3 rate =
            now_.rates * dvec3(spec_.span_m, spec_.chord_m, spec_.span_m) / (2 * speed);
        const double roll = air.roll_slip * slip + air.roll_rate * rate.x + air.roll_yaw * rate.z +
                            air.roll_aileron * deflection.x;
        const double pitch = air.pitch_zero + air.pitch_slope * attack + air.pitch_rate * rate.y +
                             air.pitch_elevator * deflection.y;
        const double yaw = air.yaw_slip * slip + air.yaw_roll * rate.x + air.yaw_rate * rate.z +
                           air.yaw_rudder * deflection.z;
        moment = pressure * dvec3(spec_.span_m * roll, spec_.chord_m * pitch, spec_.span_m * yaw);
    }
    sum.force += now_.turn * from_air(force);
    sum.moment += moment;
}

/// Springs and tyres. A tyre holds no more than its load times its grip, nor more than stops it
/// within a step.
void Aeroplane::add_wheels(const Stick& stick, Sum& sum) {
    now_.on_ground = false;
    wheels_[0].steer = std::clamp(stick.yaw, -1.0, 1.0) * kSteer;
    const dvec3 spin = now_.turn * from_air(now_.rates);
    for (const Wheel& wheel : wheels_) {
        const dvec3 arm = now_.turn * wheel.foot, foot = now_.position + arm;
        const double depth = land_.height(foot.x, foot.z) - foot.y;
        if (depth <= 0)
            continue;
        now_.on_ground = true;
        const dvec3 velocity = now_.velocity_mps + glm::cross(spin, arm);
        const double spring = wheel.load_n / kSag_m, mass = wheel.load_n / kGravity;
        const double load =
            std::max(0.0, spring * std::min(depth, 4 * kSag_m) -
                              2 * kGearDamping * std::sqrt(spring * mass) * velocity.y);
        dvec3 roll = now_.turn * glm::angleAxis(-wheel.steer, dvec3(0, 1, 0)) * dvec3(0, 0, -1);
        roll = glm::normalize(dvec3(roll.x, 0, roll.z) + dvec3(0, 0, 1e-9));
        const dvec3 side(-roll.z, 0, roll.x);
        const double along = glm::dot(velocity, roll), across = glm::dot(velocity, side);
        const double hold = load * (wheel.braked ? kRolling + (kBraked - kRolling) *
                                                                  std::clamp(stick.brake, 0.0, 1.0)
                                                 : kRolling);
        const auto stopped = [&](double speed, double most) {
            return -std::clamp(0.5 * mass * speed / kStep_s, -most, most);
        };
        const dvec3 force = dvec3(0, load, 0) + roll * stopped(along, hold) +
                            side * stopped(across, kSideways * load);
        sum.force += force;
        sum.moment += to_air(glm::inverse(now_.turn) * glm::cross(arm, force));
    }
}

/// Whether nose, tail or a wing's tip is in the ground.
bool Aeroplane::hits() const {
    const double half = spec_.span_m / 2, nose = -0.35 * spec_.length_m,
                 tail = 0.62 * spec_.length_m;
    for (const dvec3& part : {dvec3(-half, 0.6, 0), dvec3(half, 0.6, 0), dvec3(0, -0.2, nose),
                              dvec3(0, 0.2, tail), dvec3(0, 0.9, 0)}) {
        const dvec3 at = now_.position + now_.turn * part;
        if (land_.height(at.x, at.z) > at.y)
            return true;
    }
    return false;
}

void Aeroplane::step(const Stick& stick) {
    if (now_.crashed) {
        if (lain_long_enough())
            begin_again();
        return;
    }
    const bool flew = !now_.on_ground;
    const double sinking = -now_.velocity_mps.y;
    Sum sum;
    sum.force = {0, -spec_.mass_kg * kGravity, 0};
    add_air(stick, sum);
    add_wheels(stick, sum);
    now_.velocity_mps += sum.force / spec_.mass_kg * kStep_s;
    now_.position += now_.velocity_mps * kStep_s;
    turn_by(now_, spec_.inertia_kgm2, sum.moment);
    if (!now_.finite())
        begin_again();
    else if (hits() || (flew && now_.on_ground && sinking > kHardest_mps))
        crash();
}

void Aeroplane::advance(double dt_s, const Stick& stick) {
    take_steps(dt_s, [&] { step(stick); });
}

} // namespace sward::fly
