// SPDX-License-Identifier: Apache-2.0
#include "scene/ground_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "shared/surface.h"

namespace sward::scene {
namespace {

constexpr std::uint8_t kBare = 0x80, kShore = 0x40, kKind = 0x0f;
constexpr int kMostIsBare = 128; // of LandByte::kLandBare
constexpr int kSomeIsWater = 26; // a tenth, of LandByte::kLandWater
constexpr std::array<std::pair<LandByte, GroundKind>, 5> kKinds = {
    {{kLandRock, GroundKind::kRock},
     {kLandSand, GroundKind::kSand},
     {kLandGravel, GroundKind::kGravel},
     {kLandAsphalt, GroundKind::kAsphalt},
     {kLandWater, GroundKind::kWater}}};

} // namespace

GroundCoverMap::Texel GroundCoverMap::texel_of(double share, const std::uint8_t* land) {
    Texel texel;
    texel.share = static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    if (land == nullptr)
        return texel;
    if (land[kLandWater] >= kSomeIsWater)
        texel.land |= kShore;
    if (land[kLandBare] < kMostIsBare)
        return texel;
    texel.land |= kBare;
    int soil = 255; // what the others leave
    for (const auto& [byte, kind] : kKinds)
        soil -= land[byte];
    int most = soil;
    GroundKind ground = GroundKind::kSoil;
    for (const auto& [byte, kind] : kKinds)
        if (land[byte] > most) {
            most = land[byte];
            ground = kind;
        }
    texel.land |= static_cast<std::uint8_t>(ground);
    return texel;
}

GroundCoverMap::GroundCoverMap(const Heightfield& ground, const DensityMask& mask)
    : extent_(ground.extent_m()), width_(mask.width), height_(mask.height), first_(mask.first_m),
      size_(mask.size_m) {
    if (size_.x <= 0 || size_.y <= 0) { // spread over all of the posts
        size_ = extent_;
        first_ = -0.5 * extent_;
    }
    if (mask.bounded)
        outside_ = Texel{};
    if (mask.outside)
        outside_ = texel_of((*mask.outside)[0] / 255.0, mask.outside->data() + 1);
    texels_.reserve(mask.density.size());
    for (std::size_t n = 0; n < mask.density.size(); ++n)
        texels_.push_back(
            texel_of(static_cast<double>(mask.density[n]),
                     mask.land.empty() ? nullptr : mask.land.data() + n * kLandBytes));
}

GroundCover GroundCoverMap::at(glm::dvec2 place, glm::vec3 normal) const {
    GroundCover cover;
    if (!(std::abs(place.x) <= extent_.x / 2 && std::abs(place.y) <= extent_.y / 2))
        return cover; // no number too
    cover.known = true;
    if (texels_.empty()) {
        cover.grass = static_cast<double>(shared::slope_density(normal, glm::vec2(place)));
        return cover;
    }
    const glm::dvec2 at = glm::floor((place - first_) / size_ * glm::dvec2(width_, height_));
    const bool beyond = at.x < 0 || at.y < 0 || at.x >= width_ || at.y >= height_;
    const auto column = static_cast<std::size_t>(std::clamp(at.x, 0.0, width_ - 1.0));
    const auto row = static_cast<std::size_t>(std::clamp(at.y, 0.0, height_ - 1.0));
    const Texel texel =
        beyond && outside_ ? *outside_ : texels_[row * static_cast<std::size_t>(width_) + column];
    cover.grass = texel.share / 255.0;
    cover.grows = (texel.land & kBare) == 0;
    cover.shore = (texel.land & kShore) != 0;
    cover.ground = static_cast<GroundKind>(texel.land & kKind);
    return cover;
}

} // namespace sward::scene
