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
#include "tracks/underside.h"

namespace sward::tracks {

/// Height of the ground above the datum at world x, z (m).
using Ground = std::function<double(double x, double z)>;

/// A ball in a step: where it is at its end and was at its start (world metres, y above the datum).
struct Ball {
    glm::dvec3 centre{0}, before{0};
    double radius_m = 0;
};

/// A mesh in a step: its own frame (x right, y up, z back) to the world at the step's end and at
/// its start. More or less upright: it presses as its underside says.
struct Body {
    std::size_t mesh = 0; ///< by its number among the undersides
    glm::dmat4 now{1}, before{1};
};

/// What moves among the grass beside the scene's feet.
struct Touching {
    std::span<const Ball> balls = {};
    std::span<const Body> bodies = {};
};

/// A print in a step, in the world.
struct Print {
    glm::dvec2 now{0}, before{0};                ///< x, z (m)
    glm::vec2 turn_now{1, 0}, turn_before{1, 0}; ///< cosine and sine of its yaw
    glm::vec4 shape{0}; ///< half width; half depth or radius; lowest height of the underside, of a
                        ///< mesh of its origin (m); share of its load
    int kind = shared::kPrintBox, map = 0;
    glm::vec2 tilt{0};          ///< of a mesh: TrackPrint's
    glm::dvec2 low{0}, high{0}; ///< of what it sweeps, grown by a cell

    /// As a page whose corner is there sees it.
    [[nodiscard]] shared::TrackPrint from(glm::dvec2 corner) const;
};

/// What touches the grass in a step (methods.md C4): the scene's feet on their paths, and balls and
/// meshes that others know of: objects of the scene, and what a host drives. Those whose underside
/// stays above the canopy are left out.
class PrintList {
public:
    PrintList(const scene::TrackSpec& spec, std::map<std::string, scene::Path> paths,
              double canopy_m, Ground ground);

    /// The meshes that Body::mesh counts.
    void set_meshes(std::span<const scene::Mesh* const> meshes);
    /// For the passes and their twin (shared/track_map.h).
    [[nodiscard]] const std::vector<glm::vec4>& maps() const { return maps_.texels; }

    [[nodiscard]] std::vector<Print> at(double time_s, double step_s,
                                        const Touching& touching) const;
    [[nodiscard]] std::size_t leaps() const {
        return leaps_;
    } ///< ways within a step too long to be swept

    static constexpr double kMostSweep_m =
        64; ///< within a step: 3840 m/s. What is faster comes from nowhere
    static constexpr double kMostReach_m = 1000; ///< of a print: what is larger is cut to it

private:
    /// `reach_m` of what it covers around its place, in plan.
    void add(std::vector<Print>& out, Print print, double reach_m) const;
    void add_shape(std::vector<Print>& out, Print print) const;
    void add_body(std::vector<Print>& out, const Body& body) const;
    scene::TrackSpec spec_;
    std::vector<Underside> undersides_;
    UndersideMaps maps_{{glm::vec4(0)}, {}};
    std::map<std::string, scene::Path> paths_;
    double canopy_m_;
    Ground ground_;
    mutable std::size_t leaps_ = 0;
};

} // namespace sward::tracks
