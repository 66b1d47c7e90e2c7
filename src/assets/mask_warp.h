// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "assets/image_file.h"
#include "scene/heightfield.h"
#include "scene/land.h"

namespace sward::assets {

inline constexpr int kClasses = 65536; ///< 16-bit landcover

/// What a pixel's value stands for: its density, and its class where the mask is a landcover.
class MaskTable {
public:
    /// Empty: values are densities.
    explicit MaskTable(const std::map<int, scene::LandClass>& classes);
    [[nodiscard]] bool by_class() const { return !densities_.empty(); }
    /// 0 for NaN: no grass where there is no value.
    [[nodiscard]] float density(float value) const;

private:
    std::vector<float> densities_; ///< by class
};

struct MaskArea {
    glm::dvec2 low{0}, high{0}; ///< x, z (m)
    bool whole = false;         ///< the terrain's own: the mask covers all of it
};
/// The part of the terrain that a placed mask may cover. Throws Error(kBadInput) naming `path`
/// where it covers nothing of it.
[[nodiscard]] MaskArea mask_area(const Channel& channel, const scene::Heightfield& ground,
                                 const std::filesystem::path& path);
/// The finer side of a placed mask's pixels, as most of the area has it (m); NaN where nothing is
/// known.
[[nodiscard]] double finest_pixel_m(const Channel& channel, const MaskArea& area);

/// The mask spread over the whole terrain, pixel for pixel.
[[nodiscard]] scene::DensityMask spread_mask(Channel channel, const MaskTable& table);

/// The mask where it belongs: over the part of the terrain that it covers, about as fine as the
/// finer of its pixels and the terrain's posts. Each texel is the mean of the pixels under it, so
/// that a road keeps its share of a texel that is wider; where pixels are the wider ones, densities
/// are interpolated and classes keep their borders. Throws Error(kBadInput) naming `path` where it
/// covers nothing of the terrain.
[[nodiscard]] scene::DensityMask warp_mask(const Channel& channel, const MaskTable& table,
                                           const scene::Heightfield& ground,
                                           const std::filesystem::path& path);

} // namespace sward::assets
