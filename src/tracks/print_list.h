// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/scene.h"
#include "shared/track.h"

namespace sward::tracks {

/// Height of the ground above the datum at world x, z (m).
using Ground = std::function<double(double x, double z)>;

/// A ball in a step: where it is at its end and was at its start (world metres, y above the datum).
struct Ball {
    glm::dvec3 centre{0}, before{0};
    double radius_m = 0;
};

/// A print in a step, in the world.
struct Print {
    glm::dvec2 now{0}, before{0};                ///< x, z (m)
    glm::vec2 turn_now{1, 0}, turn_before{1, 0}; ///< cosine and sine of its yaw
    glm::vec4 shape{0}; ///< half width; half depth or radius; lowest height of the underside (m);
                        ///< share of its load
    int kind = shared::kPrintBox;
    glm::dvec2 low{0}, high{0}; ///< of what it sweeps, grown by a cell

    /// As a page whose corner is there sees it.
    [[nodiscard]] shared::TrackPrint from(glm::dvec2 corner) const;
};

/// What touches the grass in a step (methods.md C4): the scene's feet on their paths, and balls
/// that others know of: objects of the scene, and what a host drives. Those whose underside stays
/// above the canopy are left out.
class PrintList {
public:
    PrintList(const scene::TrackSpec& spec, std::map<std::string, scene::Path> paths,
              double canopy_m, Ground ground);

    [[nodiscard]] std::vector<Print> at(double time_s, double step_s,
                                        std::span<const Ball> balls) const;
    [[nodiscard]] std::size_t leaps() const {
        return leaps_;
    } ///< ways within a step too long to be swept

    static constexpr double kMostSweep_m =
        64; ///< within a step: 3840 m/s. What is faster comes from nowhere

private:
    void add(std::vector<Print>& out, Print print) const;
    scene::TrackSpec spec_;
    std::map<std::string, scene::Path> paths_;
    double canopy_m_;
    Ground ground_;
    mutable std::size_t leaps_ = 0;
};

} // namespace sward::tracks
