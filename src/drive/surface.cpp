// SPDX-License-Identifier: Apache-2.0
#include "drive/surface.h"

namespace sward::drive {

Surface surface_of(const scene::GroundCover& cover) {
    using scene::GroundKind;
    if (!cover.known || !cover.bare())
        return cover.shore ? Surface::kWetGrass : Surface::kGrass;
    switch (cover.ground) {
    case GroundKind::kAsphalt:
        return Surface::kRoad;
    case GroundKind::kSand:
    case GroundKind::kWater:
        return Surface::kSand;
    case GroundKind::kSoil:
    case GroundKind::kRock:
    case GroundKind::kGravel:
        break;
    }
    return Surface::kSoil;
}

} // namespace sward::drive
