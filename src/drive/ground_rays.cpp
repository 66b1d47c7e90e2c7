// SPDX-License-Identifier: Apache-2.0
#include "drive/ground_rays.h"

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

namespace sward::drive {
namespace {

constexpr int kPieces = 4;    // of a ray: a spring's travel and a wheel
constexpr int kHalvings = 16; // below a tenth of a millimetre
constexpr double kSlope_m = 0.15;

} // namespace

glm::dvec3 GroundRays::normal(double x, double z) const {
    const double east = height_(x + kSlope_m, z) - height_(x - kSlope_m, z),
                 south = height_(x, z + kSlope_m) - height_(x, z - kSlope_m);
    return glm::normalize(glm::dvec3(-east, 2 * kSlope_m, -south));
}

void* GroundRays::castRay(const btVector3& from, const btVector3& to,
                          btVehicleRaycasterResult& result) {
    const glm::dvec3 a = origin_ + glm::dvec3(from.x(), from.y(), from.z()),
                     way = glm::dvec3(to.x(), to.y(), to.z()) -
                           glm::dvec3(from.x(), from.y(), from.z());
    const auto above = [&](double share) {
        const glm::dvec3 at = a + way * share;
        return at.y - height_(at.x, at.z);
    };
    double high = 0, low = 0;
    if (above(0) > 0) {
        int piece = 1;
        while (piece <= kPieces && above(static_cast<double>(piece) / kPieces) > 0)
            ++piece;
        if (piece > kPieces)
            return nullptr;
        high = static_cast<double>(piece - 1) / kPieces;
        low = static_cast<double>(piece) / kPieces;
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (high + low);
            (above(middle) > 0 ? high : low) = middle;
        }
    }
    const glm::dvec3 hit = a + way * low, up = normal(hit.x, hit.z), local = hit - origin_;
    result.m_distFraction = static_cast<btScalar>(low);
    result.m_hitPointInWorld.setValue(static_cast<btScalar>(local.x),
                                      static_cast<btScalar>(local.y),
                                      static_cast<btScalar>(local.z));
    result.m_hitNormalInWorld.setValue(static_cast<btScalar>(up.x), static_cast<btScalar>(up.y),
                                       static_cast<btScalar>(up.z));
    return &btTypedConstraint::getFixedBody();
}

} // namespace sward::drive
