// SPDX-License-Identifier: Apache-2.0
#include "fly/helicopter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/constants.hpp>

#include "base/angles.h"

namespace sward::fly {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double kFinSlope = 3;      // lift of fin and tailplane over their angle, small and stubby
constexpr double kDamping = 0.8;     // of the pilot's help, share of the critical one
constexpr double kStandFade_mps = 4; // from twice this speed on nothing holds it over a place
constexpr double kMostStand = 8 * kDegree; // that it leans to come to stand
constexpr double kSlow_mps = 6;            // from twice this speed on the nose goes where it flies
constexpr double kSlowRotor = 0.97, kSlowRotorRange = 0.15; // of the proper speed
constexpr double kLean_s = 0.5;      // in which it leans against another push of the tail
constexpr double kSteady_mps = 1.5;  // climbs slower than this are stopped
constexpr double kSag_m = 0.04;      // of a skid under its share of the weight
constexpr double kSkidDamping = 0.7; // share of the critical one
constexpr double kSkidGrip = 0.5;    // on grass
constexpr double kHardest_mps = 4;   // a landing that the skids survive

double bank_of(const glm::dquat& turn) {
    return std::atan2(-(turn * dvec3(1, 0, 0)).y, (turn * dvec3(0, 1, 0)).y);
}

double pitch_of(const glm::dquat& turn) {
    return std::asin(std::clamp((turn * dvec3(0, 0, -1)).y, -1.0, 1.0));
}

} // namespace

Helicopter::Helicopter(const HelicopterSpec& spec, FlyLand land)
    : spec_(spec), land_(std::move(land)), rotor_(spec.rotor) {
    const double weight = spec_.mass_kg * kGravity;
    Rotor hover(spec_.rotor);
    hover.settle(weight);
    const RotorLoad load = hover.step(0, hover.hover_blade_rad(weight), {}, 1e9);
    hover_torque_ = load.power_w / hover.rad_s();
    put_on_ground(0, 0, 0);
}

double Helicopter::hover_lever() const {
    const dvec2 range = spec_.rotor.collective_deg * kDegree;
    return (rotor_.hover_blade_rad(spec_.mass_kg * kGravity) - range.x) / (range.y - range.x);
}

void Helicopter::put_on_ground(double x, double z, double yaw_deg) {
    start_ = {};
    start_.position = {x, land_.height(x, z) + spec_.skid_m, z};
    start_.turn = heading(yaw_deg);
    start_.on_ground = true;
    begin_again();
}

void Helicopter::put_in_air(const dvec3& position, double yaw_deg) {
    start_ = {};
    start_.position = position;
    start_.turn =
        heading(yaw_deg) *
        glm::angleAxis(hover_torque_ / spec_.tail_m / (spec_.mass_kg * kGravity), dvec3(0, 0, 1));
    start_.thrust_n = spec_.mass_kg * kGravity;
    begin_again();
}

void Helicopter::begin_again() {
    Motion::begin_again();
    rotor_.settle(now_.thrust_n);
    tail_n_ = now_.on_ground ? 0 : hover_torque_ / spec_.tail_m;
}

/// Its way through the air, in its own frame.
dvec3 Helicopter::through_air() const {
    return glm::inverse(now_.turn) * (now_.velocity_mps - land_.wind_at(now_.position));
}

/// 1 hands off and slow, where the help brings it to stand over a place.
double Helicopter::standing_share(const HelicopterStick& stick) const {
    if (now_.on_ground || spec_.help.stand_per_s <= 0)
        return 0;
    const double speed = glm::length(dvec2(now_.velocity_mps.x, now_.velocity_mps.z));
    const double hands_off = 1 - std::min(1.0, 5 * std::hypot(stick.pitch, stick.roll));
    return hands_off * std::clamp(2 - speed / kStandFade_mps, 0.0, 1.0);
}

/// Nose up and right side down (rad) that the stick asks for; the latter from where it leans
/// against the tail's push.
dvec2 Helicopter::wanted_lean(const HelicopterStick& stick) const {
    const double lean = spec_.help.lean_deg * kDegree;
    const double against = now_.on_ground ? 0 : -tail_n_ / (spec_.mass_kg * kGravity);
    dvec2 wanted(std::clamp(stick.pitch, -1.0, 1.0) * lean,
                 std::clamp(stick.roll, -1.0, 1.0) * lean + against);
    if (const double share = standing_share(stick); share > 0) {
        const dvec3 ahead = now_.ahead();
        const dvec2 nose = glm::normalize(dvec2(ahead.x, ahead.z) + dvec2(0, 1e-9));
        const dvec2 over(now_.velocity_mps.x, now_.velocity_mps.z);
        const double gain = spec_.help.stand_per_s / kGravity;
        const dvec2 stand(glm::dot(over, nose), -glm::dot(over, dvec2(-nose.y, nose.x)));
        wanted += share * glm::clamp(stand * gain, -kMostStand, kMostStand);
    }
    return wanted;
}

/// Tilt of the disc, back and right, that swash plate and help ask for; `blown`: that speed gives
/// it.
dvec2 Helicopter::cyclic(const HelicopterStick& stick, const dvec2& blown) const {
    const double most = spec_.cyclic_deg * kDegree, pace = spec_.help.attitude_per_s;
    if (pace <= 0)
        return most * glm::clamp(dvec2(stick.pitch, stick.roll), -1.0, 1.0);
    const dvec2 is(pitch_of(now_.turn), bank_of(now_.turn)), rates(now_.rates.y, now_.rates.x);
    const dvec2 spin = pace * pace * (wanted_lean(stick) - is) - 2 * kDamping * pace * rates;
    const double stiff = std::max(1.0, now_.thrust_n * spec_.hub_m + spec_.hub_knm * 1000);
    const dvec2 asked = spin * dvec2(spec_.inertia_kgm2.y, spec_.inertia_kgm2.x) / stiff;
    return glm::clamp(asked - standing_share(stick) * blown, -most, most);
}

/// Of the nose (rad/s) that the pedals ask for; fast, that of a turn without slip besides.
double Helicopter::wanted_rate(const HelicopterStick& stick, const dvec3& through) const {
    const double asked = std::clamp(stick.yaw, -1.0, 1.0) * spec_.help.turn_deg_per_s * kDegree;
    const double fast = std::clamp((-through.z - kSlow_mps) / kSlow_mps, 0.0, 1.0);
    if (fast <= 0)
        return asked;
    const double against = -tail_n_ / (spec_.mass_kg * kGravity);
    const double turn = kGravity * std::tan(std::clamp(bank_of(now_.turn) - against, -1.0, 1.0));
    return asked + fast * (turn - 0.5 * kGravity * std::atan2(-through.x, -through.z)) /
                       std::max(kSlow_mps, -through.z);
}

double Helicopter::blade_rad(const HelicopterStick& stick) const {
    const dvec2 range = spec_.rotor.collective_deg * kDegree;
    double lever = std::clamp(stick.lever, 0.0, 1.0);
    if (stick.engine) // a rotor that slows has been asked for more than the engine has
        lever *= 1 - spec_.help.rotor *
                         std::clamp((kSlowRotor - now_.rotor_share) / kSlowRotorRange, 0.0, 1.0);
    double angle = range.x + lever * (range.y - range.x);
    const double climb = now_.velocity_mps.y;
    if (!now_.on_ground && stick.engine && std::abs(climb) < kSteady_mps) {
        // Thrust by the angle, with the flow as it is: sigma a / 6 of the disc's.
        const RotorSpec& rotor = spec_.rotor;
        const double thrust_a_radian = rotor.solidity() * rotor.lift_slope / 6 * kAir *
                                       rotor.area_m2() * rotor.tip_mps * rotor.tip_mps;
        const double fade = 1 - std::abs(climb) / kSteady_mps;
        angle -= spec_.help.height_per_s * fade * climb * spec_.mass_kg / thrust_a_radian;
    }
    return std::clamp(angle, range.x, range.y);
}

/// Thrust along the disc's axis. The disc is blown back by speed and lags behind as the body turns.
void Helicopter::add_rotor(const HelicopterStick& stick, const dvec3& through, Sum& sum) {
    RotorAir air;
    air.climb_mps = through.y;
    const dvec2 aside(through.x, through.z);
    air.aside_mps = glm::length(aside);
    const dvec3 hub = now_.position + now_.turn * dvec3(0, spec_.hub_m, 0);
    air.over_ground_m = hub.y - land_.height(hub.x, hub.z);
    const double blade = blade_rad(stick);
    const RotorLoad load = rotor_.step(
        kStep_s, blade, air, stick.engine ? spec_.power_kw * 1000 * spec_.transmission : 0);
    dvec2 blown(0); // back, right
    if (air.aside_mps > 0.1)
        blown = dvec2(-aside.y, -aside.x) / air.aside_mps * load.advance *
                (8.0 / 3 * blade - 2 * load.inflow);
    dvec2 tilt = cyclic(stick, blown) + blown;
    const double lag = 16 / (spec_.lock * rotor_.rad_s());
    tilt -= lag * dvec2(now_.rates.y, now_.rates.x);
    tilt = glm::clamp(tilt, -0.35, 0.35);
    sum.force += load.thrust_n * glm::normalize(dvec3(tilt.y, 1, tilt.x));
    const double stiff = load.thrust_n * spec_.hub_m + spec_.hub_knm * 1000;
    sum.moment += dvec3(stiff * tilt.y, stiff * tilt.x, rotor_.engine_w() / rotor_.rad_s());
    now_.thrust_n = load.thrust_n;
    now_.inflow_mps = rotor_.inflow_mps();
    now_.engine_w = rotor_.engine_w();
    now_.rotor_share = rotor_.rad_s() / spec_.rotor.proper_rad_s();
    now_.rotor_rad = std::fmod(now_.rotor_rad + rotor_.rad_s() * kStep_s, glm::two_pi<double>());
    now_.tilt_back = tilt.x;
    now_.tilt_right = tilt.y;
}

/// It pushes the tail to the right, against the rotor's torque.
void Helicopter::add_tail(const HelicopterStick& stick, const dvec3& through, Sum& sum) {
    const double torque = sum.moment.z, most = spec_.tail_kn * 1000 * std::pow(now_.rotor_share, 2);
    const double trim = hover_torque_ + spec_.help.torque * (torque - hover_torque_);
    double turning = -std::clamp(stick.yaw, -1.0, 1.0) * most;
    if (spec_.help.turn_per_s > 0)
        turning = -spec_.help.turn_per_s * spec_.inertia_kgm2.z *
                  (wanted_rate(stick, through) - now_.rates.z) / spec_.tail_m;
    const double push = std::clamp(trim / spec_.tail_m + turning, -most, most);
    tail_n_ += (trim / spec_.tail_m - tail_n_) * std::min(1.0, kStep_s / kLean_s);
    sum.force.x += push;
    sum.moment.z -= push * spec_.tail_m;
}

void Helicopter::add_body(const dvec3& through, Sum& sum) const {
    const double speed = glm::length(through), pressure = 0.5 * kAir * speed;
    sum.force -= pressure * spec_.flat_m2 * through;
    sum.moment.z += pressure * through.x * spec_.fin_m2 * kFinSlope * spec_.tail_m;
    sum.moment.y += pressure * through.y * spec_.tailplane_m2 * kFinSlope * spec_.tail_m;
}

/// Springs at the skids' ends; they hold no more than their load times their grip, nor more than
/// stops them within a step.
void Helicopter::add_skids(Sum& sum) {
    now_.on_ground = false;
    const dvec3 spin = now_.turn * from_air(now_.rates);
    const glm::dquat back = glm::inverse(now_.turn);
    const double share = spec_.mass_kg / 4, spring = share * kGravity / kSag_m;
    for (int corner = 0; corner < 4; ++corner) {
        const dvec3 foot((corner & 1 ? 0.5 : -0.5) * spec_.skid_track_m, -spec_.skid_m - kSag_m,
                         (corner & 2 ? 0.5 : -0.5) * spec_.skid_length_m);
        const dvec3 arm = now_.turn * foot, at = now_.position + arm;
        const double depth = land_.height(at.x, at.z) - at.y;
        if (depth <= 0)
            continue;
        now_.on_ground = true;
        const dvec3 velocity = now_.velocity_mps + glm::cross(spin, arm);
        const double load =
            std::max(0.0, spring * std::min(depth, 6 * kSag_m) -
                              2 * kSkidDamping * std::sqrt(spring * share) * velocity.y);
        const dvec2 slide(velocity.x, velocity.z);
        const double speed = glm::length(slide);
        const double hold = std::min(kSkidGrip * load, 0.5 * share * speed / kStep_s);
        dvec3 force(0, load, 0);
        if (speed > 1e-9)
            force -= dvec3(slide.x, 0, slide.y) / speed * hold;
        sum.force += back * force;
        sum.moment += to_air(back * glm::cross(arm, force));
    }
}

/// Whether nose, tail or the rotor is in the ground.
bool Helicopter::hits() const {
    const auto in_ground = [&](const dvec3& part) {
        const dvec3 at = now_.position + now_.turn * part;
        return land_.height(at.x, at.z) > at.y;
    };
    for (int i = 0; i < 8; ++i) {
        const double angle = i * glm::pi<double>() / 4;
        if (in_ground({spec_.rotor.radius_m * std::sin(angle), spec_.hub_m,
                       spec_.rotor.radius_m * std::cos(angle)}))
            return true;
    }
    return in_ground({0, -0.4, -0.25 * spec_.length_m}) || in_ground({0, -0.1, spec_.tail_m});
}

void Helicopter::step(const HelicopterStick& stick) {
    if (now_.crashed) {
        if (lain_long_enough())
            begin_again();
        return;
    }
    const bool flew = !now_.on_ground;
    const double sinking = -now_.velocity_mps.y;
    const dvec3 through = through_air();
    now_.airspeed_mps = glm::length(through);
    Sum sum;
    add_rotor(stick, through, sum);
    add_tail(stick, through, sum);
    add_body(through, sum);
    add_skids(sum);
    now_.velocity_mps += (now_.turn * sum.force / spec_.mass_kg - dvec3(0, kGravity, 0)) * kStep_s;
    now_.position += now_.velocity_mps * kStep_s;
    turn_by(now_, spec_.inertia_kgm2, sum.moment);
    if (!now_.finite() || !std::isfinite(now_.thrust_n)) {
        begin_again();
    } else if (hits() || (flew && now_.on_ground && sinking > kHardest_mps)) {
        now_.thrust_n = now_.inflow_mps = now_.engine_w = 0;
        crash();
    }
}

void Helicopter::advance(double dt_s, const HelicopterStick& asked) {
    HelicopterStick stick = asked;
    for (double* const part : {&stick.roll, &stick.pitch, &stick.yaw, &stick.lever})
        if (!std::isfinite(*part))
            *part = 0;
    take_steps(dt_s, [&] { step(stick); });
}

} // namespace sward::fly
