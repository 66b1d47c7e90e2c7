// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/angles.h"

namespace sward::base {
namespace {

void expect_near(glm::dvec3 found, glm::dvec3 expected) {
    EXPECT_LT(glm::distance(found, expected), 1e-15);
}

TEST(Angles, AYawTurnsByTheCompass) {
    EXPECT_DOUBLE_EQ(180 * kDegree, std::numbers::pi);
    const glm::dvec3 north(0, 0, -1), east(1, 0, 0), south(0, 0, 1);
    expect_near(direction_of(0, 0), north);
    expect_near(direction_of(90, 0), east);
    expect_near(direction_of(37, 90), {0, 1, 0});
    for (const double yaw : {0.0, 37.0, 90.0, -125.0, 360.0}) {
        const Heading heading(yaw);
        const glm::dvec2 ahead = heading.ahead(), right = heading.right(), back = heading.back();
        expect_near(direction_of(yaw, 0), {ahead.x, 0, ahead.y});
        expect_near(direction_of(yaw + 90, 0), {right.x, 0, right.y});
        // A body that is turned looks where it heads, its axes where they are said to be.
        expect_near(heading.turn() * north, {ahead.x, 0, ahead.y});
        expect_near(heading.turn() * east, {right.x, 0, right.y});
        expect_near(heading.turn() * south, {back.x, 0, back.y});
        EXPECT_NEAR(glm::determinant(heading.turn()), 1, 1e-15); // no mirror
    }
}

} // namespace
} // namespace sward::base
