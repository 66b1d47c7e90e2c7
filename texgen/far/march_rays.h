// SPDX-License-Identifier: Apache-2.0
// The march on the CPU: rays through a set's textures as the shader walks them, for the fit of its
// correction.
#pragma once

#include <vector>

#include "shared/march.h"
#include "texgen/far/march_builder.h"

namespace sward::texgen {

/// What a ray that meets grass at this height of the canopy brings: mostly that it has, and a
/// little how high up, where there is more light. Any such function would do whose mean tells both
/// how much is seen of the grass and how deep; coverage has to be right where ground is seen.
[[nodiscard]] double found_at(double height, double canopy);

/// What the march reads of a texel.
struct MarchTexel {
    float density = 0;
    float albedo = 0;     ///< luminance, times the density
    glm::vec3 tangent{0}; ///< likewise
};

/// What a ray reads of one of the march's textures, mip by mip.
class MarchTexels {
public:
    MarchTexels(const MarchImages& images, bool repeat_v);
    /// Trilinear, repeating along u and, if asked, along v: as the GPU reads it.
    [[nodiscard]] MarchTexel at(glm::vec3 place, float mip) const;

private:
    struct Mip {
        int width, height;
        std::vector<MarchTexel> texels;
    };
    [[nodiscard]] MarchTexel in_mip(glm::vec3 place, const Mip& mip) const;
    std::vector<Mip> mips_;
    bool repeat_v_;
};

/// A set's march and its textures as rays read them, by kind.
struct MarchTextureSet {
    const MarchData& data;
    std::vector<MarchTexels> kinds;

    explicit MarchTextureSet(const MarchData& of);
};

struct MarchCase {
    int kind = 0;
    double mip = 0, elevation_deg = 0, density = 1;
};

/// Sums over marched rays.
struct Marched {
    double found = 0; ///< found_at of what they meet
    double seen = 0;  ///< share of the view that is grass
    double light = 0; ///< of that: its radiance, as the march shades it
};

/// Means of what the march sees with a factor on its optical depth.
class MarchMean {
public:
    MarchMean(const MarchTextureSet& textures, const MarchCase& which, int rays);
    [[nodiscard]] Marched at(double factor, bool light_too = false) const;

private:
    [[nodiscard]] shared::MarchPath path_of(int number, float& variant) const;
    [[nodiscard]] Marched walk(int number, float factor, bool light_too) const;

    const MarchData& data_;
    const MarchTexels& texels_;
    MarchCase case_;
    int rays_;
    double footprint_;
};

} // namespace sward::texgen
