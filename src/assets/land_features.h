// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/heightfield.h"
#include "scene/land.h"

namespace sward::assets {

/// Areas or lines in the terrain's frame: x, z (m).
struct LandShapes {
    using Ring = std::vector<glm::dvec2>;
    std::vector<std::vector<Ring>>
        areas; ///< rings of each; what an odd number of them surrounds is inside
    std::vector<Ring> lines;
};

/// What a feature's file holds, GeoJSON or GeoPackage, warped from its own CRS into the frame of a
/// terrain that has one. Throws Error: kIo, kBadInput for another format, a layer or filter that
/// fails, a terrain or file without a CRS, or nothing of the kind asked for (lines where
/// `feature.width_m` is given, else areas); kOverLimit.
[[nodiscard]] LandShapes read_features(const scene::LandFeature& feature,
                                       const scene::Heightfield& ground);

/// Share of each texel of a grid that the shapes cover, a row at a time.
class FeatureRows {
public:
    /// `first`: x, z of the grid's corner; `texel`: its sides (m).
    FeatureRows(LandShapes shapes, double width_m, glm::dvec2 first, glm::dvec2 texel);
    /// Adds row `j` to `shares` (0..1 each).
    void cover(int j, std::vector<float>& shares) const;

private:
    struct Edge {
        glm::dvec2 from, to; ///< in texels
    };
    void cover_areas(int j, const std::vector<int>& edges, std::vector<float>& shares) const;
    void cover_lines(int j, const std::vector<int>& edges, std::vector<float>& shares) const;
    std::vector<Edge> edges_;
    std::vector<std::vector<int>> by_band_; ///< edges that reach a band of rows
    bool lines_ = false;
    glm::dvec2 texel_m_{1, 1};
    double half_m_ = 0; ///< of a line's width
};

} // namespace sward::assets
