// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "blades/blade_twin.h"
#include "blades/pages.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace sward::blades {

/// A sphere in a step: where it is at its end and was at its start (world metres, y above the
/// datum).
struct MovingSphere {
    glm::dvec3 centre{0};
    glm::dvec3 before{0};
    double radius_m = 0;
};

/// A sphere that a host drives.
struct HostSphere {
    glm::dvec3 centre{0}; ///< world metres, y above the datum
    double radius_m = 0;
};

/// What pushes blades: the scene's spheres on their paths, and what a host drives. No bound on
/// their number.
class Colliders {
public:
    using Ground = std::function<double(double x, double z)>; ///< height above the datum

    /// Takes the scene's objects that grass feels: spheres, and meshes packed with spheres
    /// (`packed`, by the scene's name of the mesh). Throws base::Error(kBadInput), naming the
    /// scene's file, for one without a radius or place.
    Colliders(const scene::Scene& scene,
              const std::map<std::filesystem::path, scene::SphereSet>& packed, Ground ground);

    /// Spheres that move and turn with an object of the scene: x (right), y (up), z (back) and
    /// radius in its own frame (m). Throws likewise.
    void add_body(const scene::ObjectSpec& object, std::span<const glm::vec4> spheres);

    /// The host's spheres from now on, at `time_s`; those of the same number in the call before
    /// came from there in a straight line since its time. Throws base::Error(kBadInput) for a
    /// radius that is not above 0 or a place that is not finite; the old ones stay.
    void set_host_spheres(std::vector<HostSphere> spheres, double time_s);

    /// Where the scene's object of this number stands from now on, at `time_s`: its own frame (x
    /// right, y up, z back) to the world. It came from where the call before had put it, in a
    /// straight line; with the first one it comes from nowhere. Of an object that grass does not
    /// feel: nothing.
    void set_body(std::size_t object, const glm::dmat4& world_from_body, double time_s);

    /// All of them in the step that ends at `time_s`.
    [[nodiscard]] std::vector<MovingSphere> at(double time_s, double step_s) const;
    /// Whether there may be any, at any time.
    [[nodiscard]] bool any() const { return !bodies_.empty() || !now_.empty(); }

private:
    struct Placed {
        glm::dmat4 before{1}, now{1};
        double before_s = 0, now_s = 0;
    };
    struct Body {
        scene::ObjectSpec object;
        std::vector<glm::vec4> spheres;
        std::size_t number = 0;       ///< of the object in its scene
        std::optional<Placed> placed; ///< by the host
    };
    /// Where a body's own frame is: x right, y up, z back, and its origin.
    [[nodiscard]] glm::dmat4 frame(const Body& body, double time_s) const;
    [[nodiscard]] glm::dvec3 host_place(std::size_t n, double time_s) const;

    std::string file_;
    std::map<std::string, scene::Path> paths_;
    Ground ground_;
    std::vector<Body> bodies_;
    std::vector<HostSphere> before_, now_;
    double before_s_ = 0, now_s_ = 0;
};

/// Which spheres each patch may meet in a step: the broad phase.
struct SphereLists {
    std::vector<std::uint32_t>
        lists; ///< for each patch of the pool its first number and their count; then the numbers
    std::vector<StepSphere>
        spheres;             ///< relative to the anchor; those that no patch meets are left out
    std::uint64_t pairs = 0; ///< of a patch and a sphere
};

struct Box {
    glm::dvec3 low{0}, high{0};
};
/// What a sphere sweeps in a step, grown by `reach_m`.
[[nodiscard]] Box swept_box(const MovingSphere& sphere, double reach_m);

/// Lists for a pool of `patches`; `meet`(sphere, found) calls found(patch) for every patch that it
/// may touch.
using Found = std::function<void(std::uint32_t patch)>;
[[nodiscard]] SphereLists
sphere_lists(std::size_t patches, std::span<const MovingSphere> spheres, glm::dvec3 anchor,
             const std::function<void(const MovingSphere&, const Found&)>& meet);

/// `reach_m`: how far the blades of a patch get from their roots. `anchor`: world metres.
[[nodiscard]] SphereLists sphere_lists(const Pages& pages, double side_m, double reach_m,
                                       std::span<const MovingSphere> spheres, glm::dvec3 anchor);

} // namespace sward::blades
