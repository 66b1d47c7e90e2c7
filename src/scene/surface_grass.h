// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace sward::scene {

enum class Placement { kSingle, kTufts, kMixed };

/// J8's outlines, in the order of shared/surface_blade.h.
enum class BladeShape { kQuad, kTriangle, kQuadratic, kTriangleTip, kDandelion };

/// Grass on a mesh: [surface_grass] of a scene. Pairs are from and to, drawn evenly. Colours are
/// linear reflectances.
struct SurfaceGrassSpec {
    std::string set; ///< a grass set that the blades are of, as GrassSpec::set; empty: what follows
                     ///< describes them, and there is no far field
    double density_per_m2 = 600; ///< blades; cost of placing and drawing grows with it
    Placement placement = Placement::kMixed;
    double tuft_share = 0.5;     ///< of the blades that stand in tufts, for kMixed
    int tuft_blades = 12;        ///< blades a tuft on average
    double tuft_radius_m = 0.05; ///< about its centre, along the surface
    double tuft_gather = 0; ///< how the blades of a tuft lean: 1 to its middle (locks of hair), -1
                            ///< outwards (tussocks), 0 any way
    double slope_deg = 180; ///< grass stands where the surface leans at most so far from level;
                            ///< 180: underneath as well
    glm::dvec2 blade_height_m{0.15, 0.35};
    glm::dvec2 blade_width_m{0.004, 0.007}; ///< at the widest
    glm::dvec2 stiffness{0.4, 0.8};         ///< 0 limp .. 1 stiff
    double thin_out_m = 60; ///< distance from which an eighth of the blades is drawn, eight times
                            ///< as wide (J7); 0: always all. Cost grows with it
    double droop = 0.25;    ///< gravity's shift of a tip of stiffness 1 over the blade's height
    double lean = 0.15;     ///< shift of a tip to its front over the blade's height, on average
    BladeShape shape = BladeShape::kQuadratic;
    double tip_tau = 0.75; ///< v where a triangle-tip begins
    int teeth = 5;         ///< of a dandelion's leaf
    double tooth_depth = 0.6;
    glm::dvec3 root_colour{0.052, 0.088, 0.022};
    glm::dvec3 tip_colour{0.078, 0.152, 0.032};
    glm::dvec3 dry_colour{0.215, 0.175, 0.080};
    double dry_share = 0.07; ///< of the blades that are dry
    double variation = 0.45; ///< of hue and value between blades
    double translucency = 0.45;
    glm::dvec3 ground_colour{0.085, 0.062, 0.040}; ///< of the mesh under grass
    glm::dvec3 bare_colour{0.17, 0.155, 0.135};    ///< of the mesh beyond slope_deg
    int seed = 1;

    [[nodiscard]] double share_in_tufts() const {
        return placement == Placement::kSingle  ? 0
               : placement == Placement::kTufts ? 1
                                                : tuft_share;
    }
};

} // namespace sward::scene
