// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

namespace sward::fly {

/// A main rotor's measures.
struct RotorSpec {
    double radius_m = 5.03, chord_m = 0.254;
    int blades = 2;
    double tip_mps = 215;             ///< at its proper speed
    double lift_slope = 5.7;          ///< of the blade's section, a radian
    double profile_drag = 0.01;       ///< its drag coefficient
    double inertia_kgm2 = 220;        ///< about its axis
    glm::dvec2 collective_deg{0, 15}; ///< blade angle, lever down and up

    [[nodiscard]] double area_m2() const;
    [[nodiscard]] double solidity() const; ///< share of the disc that is blade
    [[nodiscard]] double proper_rad_s() const { return tip_mps / radius_m; }
};

/// What flows through a rotor, in its own axes.
struct RotorAir {
    double climb_mps = 0; ///< its way along its axis, up
    double aside_mps = 0; ///< and across
    double over_ground_m = 1e9;
};

struct RotorLoad {
    double thrust_n = 0;
    double power_w = 0; ///< that it takes; below 0 the wind drives it
    double advance = 0; ///< aside over tip speed
    double inflow = 0;  ///< what flows through it over tip speed, down
};

/// Blade elements and momentum: thrust by the angle of the blades and what flows through the disc,
/// what flows by the thrust, a moment later. Near the ground the disc is held up by less flow; in
/// fast descent it is in its own wake, then it is a windmill.
class Rotor {
public:
    explicit Rotor(const RotorSpec& spec);

    /// As it hovers with this thrust, far from the ground.
    void settle(double thrust_n);
    /// A step at a blade angle. `engine_w`: what the engine gives at most; 0: it is off, and the
    /// rotor turns freely. What it gives is governed so that the rotor keeps its speed.
    RotorLoad step(double dt_s, double blade_rad, const RotorAir& air, double engine_w);
    /// The blade angle of a thrust in hover, far from the ground.
    [[nodiscard]] double hover_blade_rad(double thrust_n) const;
    [[nodiscard]] double hover_inflow_mps(double thrust_n) const;

    [[nodiscard]] double rad_s() const { return rad_s_; }
    [[nodiscard]] double inflow_mps() const { return inflow_mps_; } ///< that it induces
    [[nodiscard]] double engine_w() const { return engine_w_; }     ///< that it gets

private:
    [[nodiscard]] double induced(double thrust_n, const RotorAir& air) const;
    RotorSpec spec_;
    double rad_s_ = 0, inflow_mps_ = 0, engine_w_ = 0;
    double thrust_n_ = 0;
};

} // namespace sward::fly
