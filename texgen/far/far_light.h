// SPDX-License-Identifier: Apache-2.0
// Rays through a canopy and the light of what they meet: the far table's raw numbers, from blades
// or from anything else that rays can be cast through.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "grass/grass_set.h"
#include "scene/image.h"
#include "texgen/patch/patch.h"
#include "texgen/patch/rays.h"

namespace sward::texgen {

/// What a ray meets, as shade_grass asks for it.
struct GrassHit {
    shared::vec3 albedo{0};
    shared::vec3 tangent{0, 1, 0}; ///< unit, as bent
    double height = 0;             ///< at rest, 0 ground .. 1 top of the canopy
    double along = 0;              ///< place along the blade, 0 root .. 1 tip
    std::size_t species = 0;       ///< index of Canopy::looks
};

/// First hit of a ray that comes down from the canopy's top; `number` names the ray, for casters
/// that need a random number.
using Caster = std::function<std::optional<GrassHit>(const SampleRay& ray, std::uint64_t number)>;

/// A canopy that tiles the plane.
struct Canopy {
    double side_m = 0;
    double top_m = 0;
    std::vector<shared::GrassAppearance> looks;
    /// One caster a variant, of the canopy bent along +x by bend_offset of this intensity (0: at
    /// rest). Asked once an intensity; what it holds is freed before the next.
    std::function<std::vector<Caster>(double lean)> bent;
};

/// Blades bent as their shell images are (pose_blade), shaded in the mean of all blades' colours,
/// as pixels that hold many of them show them. `patch` must outlive it.
[[nodiscard]] Canopy blade_canopy(const Patch& patch, double canopy_m);

/// Sums of rays from one view elevation and lean azimuth.
struct ViewSums {
    int rays = 0;
    int hits = 0;
    int shaded = 0;    ///< hits among them whose light was summed
    double height = 0; ///< of the hits
    double along = 0;
    glm::dvec3 sky{0};           ///< of the shaded hits
    std::vector<glm::dvec3> sun; ///< likewise; sun elevation-major
    void add(const ViewSums& other);
};

/// Which rays: numbers [first, end), at a view elevation. Without a lean azimuth the views spread
/// over all azimuths.
struct ViewRays {
    double elevation_deg = 90;
    std::optional<double> lean_azimuth_deg; ///< every other ray sees the mirrored canopy
    int first = 0;
    int end = 0;
    int count = 0;       ///< of all batches of this view: variants in blocks of consecutive rays
    int shade_every = 1; ///< light costs more than rays
    double lean = 0;     ///< bend intensity: what it does to the canopy's light (canopy_sway)
};
[[nodiscard]] ViewSums cast_view(const Canopy& canopy, const std::vector<Caster>& casters,
                                 const ViewRays& rays);

/// The axes of every table that texgen makes, and no samples. `elevations_deg`: of the view,
/// falling.
[[nodiscard]] grass::FarLight light_axes(const std::vector<float>& elevations_deg);

/// Writes a view's mean into its image. `even`: the mirrored view is the same, so that both halves
/// of the sun's azimuths are one.
void store_view(const ViewSums& sums, bool even, std::size_t image, grass::FarLight& light);

/// far.exr: columns are sun azimuths within sun elevations, rows view elevations within lean
/// azimuths within leans; float channels, axes in the metadata.
[[nodiscard]] scene::Image far_light_picture(const grass::FarLight& light);

} // namespace sward::texgen
