// SPDX-License-Identifier: Apache-2.0
// Sources that a host moves, beside those of the scene.
#include <gtest/gtest.h>

#include "wind/force_list.h"

namespace sward::wind {
namespace {

using Source = scene::WindSource;

Source source(Source::Kind kind, double strength, double radius) {
    Source s;
    s.kind = kind;
    s.strength_mps = strength;
    s.radius_m = radius;
    return s;
}

TEST(Sources, WhatAHostMovesIsOnItsStraightLine) {
    scene::WindSpec spec;
    spec.sources = {source(Source::Kind::kFan, 4, 2)};
    ForceList list(spec, {}, [](double, double) { return 100.0; });
    scene::MovingWindSource wake;
    wake.source = source(Source::Kind::kWake, 12, 1.5);
    wake.source.where.place = {100, -20};
    wake.source.where.yaw_deg = 90;
    wake.source.length_m = 30;
    wake.velocity_mps = {12, 0};
    wake.time_s = 5;
    list.set_moving({wake});
    const auto forces = list.at(4.5, {10, 0}, 0.5);
    ASSERT_EQ(forces.size(), 2u); // the scene's first
    EXPECT_EQ(forces[0].kind, shared::kForceRing);
    EXPECT_EQ(forces[1].kind, shared::kForceWake);
    EXPECT_NEAR(forces[1].place.x, 100 - 6 - 10, 1e-4) << "half a second before";
    EXPECT_NEAR(forces[1].place.y, -20, 1e-4);
    EXPECT_NEAR(forces[1].along.x, 1, 1e-6);
    EXPECT_EQ(forces[1].speed_mps, 12);
    list.set_moving({});
    EXPECT_EQ(list.at(4.5, {10, 0}, 0.5).size(), 1u);
    EXPECT_FALSE(list.empty());
}

TEST(Sources, ARotorThatAHostMovesBlowsByItsSpeedAndHeight) {
    ForceList list({}, {}, [](double, double) { return 0.0; });
    EXPECT_TRUE(list.empty());
    scene::MovingWindSource rotor;
    rotor.source = source(Source::Kind::kRotor, 15, 5);
    rotor.source.height_m = 4;
    list.set_moving({rotor});
    EXPECT_FALSE(list.empty());
    const double low = list.at(0, {0, 0}, 0.5).at(0).speed_mps;
    EXPECT_NEAR(low, 15, 1);
    rotor.source.height_m = 80;
    list.set_moving({rotor});
    EXPECT_LT(list.at(0, {0, 0}, 0.5).at(0).speed_mps, 0.6 * low);
}

} // namespace
} // namespace sward::wind
