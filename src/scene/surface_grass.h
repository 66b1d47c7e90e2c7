// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include <glm/glm.hpp>

#include "scene/species.h"

namespace sward::scene {

enum class Placement { kSingle, kTufts, kMixed };
inline constexpr std::array<const char*, 3> kPlacementNames = {"single", "tufts", "mixed"};

/// J8's outlines, in the order of shared/surface_blade.h.
enum class BladeShape { kQuad, kTriangle, kQuadratic, kTriangleTip, kDandelion };
inline constexpr std::array<const char*, 5> kBladeShapeNames = {"quad", "triangle", "quadratic",
                                                                "triangle-tip", "dandelion"};

/// Of a mesh's grass where the scene says nothing.
[[nodiscard]] inline Species surface_species() {
    Species out;
    out.tuft_share = 0.5;
    out.tuft_radius_m = {0.05, 0.05};
    out.tuft_blades = {12, 12};
    out.length_m = {0.15, 0.35};
    out.width_m = {0.004, 0.007};
    out.stiffness = {0.4, 0.8};
    return out;
}

/// Grass on a mesh: [surface_grass] of a scene. Colours are linear reflectances.
struct SurfaceGrassSpec {
    std::string set; ///< a grass set that the blades are of, as GrassSpec::set; empty: what follows
                     ///< describes them, and there is no far field
    double density_per_m2 = 600; ///< blades; cost of placing and drawing grows with it
    Placement placement = Placement::kMixed;
    Species species = surface_species(); ///< but for what is_of_surface() leaves out
    double tuft_gather = 0; ///< how the blades of a tuft lean: 1 to its middle (locks of hair), -1
                            ///< outwards (tussocks), 0 any way
    double slope_deg = 180; ///< grass stands where the surface leans at most so far from level;
                            ///< 180: underneath as well
    double thin_out_m = 60; ///< distance from which an eighth of the blades is drawn, eight times
                            ///< as wide (J7); 0: always all. Cost grows with it
    double droop = 0.25;    ///< gravity's shift of a tip of stiffness 1 over the blade's height
    double lean = 0.15;     ///< shift of a tip to its front over the blade's height, on average
    BladeShape shape = BladeShape::kQuadratic;
    double tip_tau = 0.75; ///< v where a triangle-tip begins
    int teeth = 5;         ///< of a dandelion's leaf
    double tooth_depth = 0.6;
    glm::dvec3 ground_colour{0.085, 0.062, 0.040}; ///< of the mesh under grass
    glm::dvec3 bare_colour{0.17, 0.155, 0.135};    ///< of the mesh beyond slope_deg
    int seed = 1;

    [[nodiscard]] double share_in_tufts() const {
        return placement == Placement::kSingle  ? 0
               : placement == Placement::kTufts ? 1
                                                : species.tuft_share;
    }
};

} // namespace sward::scene
