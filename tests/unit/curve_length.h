// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shared/blade.h"

namespace sward::shared {

/// Length of a blade's curve (root at 0) by 512 chords: what the estimates are held to.
inline double measured_length(vec3 v1, vec3 v2) {
    constexpr int kPieces = 512;
    double sum = 0;
    glm::dvec3 before(0);
    for (int i = 1; i <= kPieces; ++i) {
        const glm::dvec3 here(blade_curve(v1, v2, static_cast<float>(i) / kPieces));
        sum += glm::length(here - before);
        before = here;
    }
    return sum;
}

} // namespace sward::shared
