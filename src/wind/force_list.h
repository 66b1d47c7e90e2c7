// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "scene/scene.h"
#include "shared/wind_force.h"
#include "wind/arrow_times.h"
#include "wind/carrier.h"

namespace sward::wind {

/// Height of the ground above the datum (m) at world x, z.
using GroundHeight = std::function<double(double x, double z)>;

/// Where the air meets the ground below a rotor.
struct Outwash {
    double speed_mps = 0;
    double radius_m = 0; ///< of the ring where it is highest
};

/// Momentum theory: a disc that carries a weight T drives air through it at sqrt(T / (2 rho A)),
/// which contracts to 0.707 of the radius at twice that speed. Beyond six of its diameters a round
/// jet slows as 1 / height and widens, momentum kept; the ground turns it outwards at the speed it
/// arrives with.
[[nodiscard]] Outwash rotor_outwash(const scene::WindSource& rotor, double height_m);

/// What pushes the air, from time to a list. Forces of arrows first, then of sources, each in the
/// order of the file, then of what a host moves.
class ForceList {
public:
    ForceList(const scene::WindSpec& spec, Paths paths, GroundHeight ground);

    void set_arrows(std::vector<scene::WindArrow> arrows);
    void set_moving(std::vector<scene::MovingWindSource> moving) { moving_ = std::move(moving); }
    [[nodiscard]] bool empty() const {
        return arrows_.empty() && sources_.empty() && moving_.empty();
    }
    /// Whether all that there is, if anything, is a host's.
    [[nodiscard]] bool only_moving() const { return arrows_.empty() && sources_.empty(); }
    /// Those that act at `time_s`. Places are relative to `origin` (world x, z, m); radii are at
    /// least `least_m`, so that no force falls between the faces of a grid.
    [[nodiscard]] std::vector<shared::WindForce> at(double time_s, glm::dvec2 origin,
                                                    double least_m) const;

private:
    [[nodiscard]] shared::WindForce force_of(const scene::WindSource& source, double time_s,
                                             glm::dvec2 origin) const;

    std::vector<scene::WindArrow> arrows_;
    std::vector<Span> spans_;
    std::vector<scene::WindSource> sources_;
    std::vector<scene::MovingWindSource> moving_;
    Paths paths_;
    GroundHeight ground_;
};

/// The rectangle outside which a force does nothing: least x, z, most x, z (m), in the force's own
/// frame of reference.
[[nodiscard]] glm::vec4 force_bounds(const shared::WindForce& force);
/// Whether it relaxes the air to a velocity; whether it brings or takes air. A vortex does both.
[[nodiscard]] bool relaxes(const shared::WindForce& force);
[[nodiscard]] bool brings_air(const shared::WindForce& force);

} // namespace sward::wind
