// SPDX-License-Identifier: Apache-2.0
#include "fly/motion.h"

namespace sward::fly {

using glm::dvec3;

dvec3 FlyLand::wind_at(const dvec3& place) const {
    const glm::dvec2 level = wind ? wind(place.x, place.z) : glm::dvec2(0);
    return {level.x, 0, level.y};
}

dvec3 to_air(const dvec3& v) {
    return {-v.z, v.x, -v.y};
}
dvec3 from_air(const dvec3& v) {
    return {v.y, -v.z, -v.x};
}

bool AircraftState::finite() const {
    return std::isfinite(glm::dot(position, position) + glm::dot(velocity_mps, velocity_mps) +
                         glm::dot(rates, rates));
}

glm::dquat heading(double yaw_deg) {
    return glm::angleAxis(-yaw_deg * kDegree, dvec3(0, 1, 0));
}

void turn_by(AircraftState& state, const dvec3& inertia_kgm2, const dvec3& moment) {
    const dvec3 momentum = inertia_kgm2 * state.rates;
    state.rates += (moment - glm::cross(state.rates, momentum)) / inertia_kgm2 * kStep_s;
    state.rates = glm::clamp(state.rates, -10.0, 10.0);
    const dvec3 by = from_air(state.rates) * kStep_s;
    const double angle = glm::length(by);
    if (angle > 1e-12)
        state.turn = glm::normalize(state.turn * glm::angleAxis(angle, by / angle));
}

} // namespace sward::fly
