// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Vehicle/btVehicleRaycaster.h>
#include <glm/glm.hpp>

namespace sward::drive {

/// The ground as wheels meet it: a height over x and z, world metres. No triangles: it is the very
/// function that is drawn.
class GroundRays : public btVehicleRaycaster {
public:
    explicit GroundRays(std::function<double(double x, double z)> height)
        : height_(std::move(height)) {}
    /// Where Bullet's own origin lies: its floats stay small.
    void set_origin(const glm::dvec3& origin) { origin_ = origin; }
    /// The first place on the way that is at or below the ground; null where there is none.
    void* castRay(const btVector3& from, const btVector3& to,
                  btVehicleRaycasterResult& result) override;

    [[nodiscard]] double height(double x, double z) const { return height_(x, z); }
    /// Unit, upwards, by the slope over a wheel's length.
    [[nodiscard]] glm::dvec3 normal(double x, double z) const;

private:
    std::function<double(double, double)> height_;
    glm::dvec3 origin_{0};
};

} // namespace sward::drive
