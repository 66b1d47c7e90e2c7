// SPDX-License-Identifier: Apache-2.0
#include "app/land_cover.h"

#include <memory>

namespace sward::app {
namespace {

constexpr double kSlopeStep_m = 0.5; // to both sides: the finest posts

} // namespace

CoverAt cover_of(const render::World& world) {
    if (!world.scene.terrain.surface.empty()) // a mesh has no ground below
        return [](glm::dvec2, glm::vec3) { return scene::GroundCover{}; };
    return [map = std::make_shared<scene::GroundCoverMap>(world.elevation, world.mask)](
               glm::dvec2 place, glm::vec3 normal) { return map->at(place, normal); };
}

glm::dvec3 normal_at(const Land& land, glm::dvec2 place) {
    const auto height = [&](double x, double z) { return land.height(place.x + x, place.y + z); };
    return glm::normalize(glm::dvec3(height(-kSlopeStep_m, 0) - height(kSlopeStep_m, 0),
                                     2 * kSlopeStep_m,
                                     height(0, -kSlopeStep_m) - height(0, kSlopeStep_m)));
}

} // namespace sward::app
