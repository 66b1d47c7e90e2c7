// SPDX-License-Identifier: Apache-2.0
// How grass bends: the closed forms held to numerical integration, lengths to measured lengths.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "curve_length.h"
#include "shared/bend.h"
#include "shared/blade.h"

namespace sward::shared {
namespace {

/// B3 by integration: the curve whose tangent turns by theta = k s.
glm::dvec2 integrated_arc(double s, double stem, double intensity) {
    constexpr int kSteps = 4000;
    const double k = 0.5 * 3.14159265358979323846 * intensity / stem;
    const double step = s / kSteps;
    glm::dvec2 sum(0);
    for (int i = 0; i < kSteps; ++i) {
        const double theta = k * (i + 0.5) * step;
        sum += glm::dvec2(std::cos(theta), std::sin(theta)) * step;
    }
    return sum;
}

/// A blade as patches hold them: leans and bends within what the shipped presets allow.
struct RestBlade {
    vec3 v1, v2;
    float stem;
};
RestBlade random_blade(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    const float stem = 0.04f + 0.5f * unit(random);
    const float azimuth = 6.2831853f * unit(random);
    const float lean = 0.45f * unit(random);
    const float turn = 0.9f * unit(random);
    const auto toward = [&](float angle) {
        return vec3(std::sin(angle) * std::cos(azimuth), std::cos(angle),
                    std::sin(angle) * std::sin(azimuth));
    };
    const vec3 v1 = toward(lean) * (0.5f * stem);
    const vec3 v2 = v1 + toward(lean + turn) * (0.5f * stem);
    return {v1, v2, static_cast<float>(measured_length(v1, v2))};
}

constexpr float kIntensities[] = {-1.0f, -0.6f,  -0.02f, -1e-3f, -1e-6f, 0.0f, 1e-6f,
                                  1e-3f, 0.005f, 0.02f,  0.3f,   0.72f,  1.0f};

TEST(Bend, ArcEqualsIntegration) {
    for (const float stem : {0.03f, 0.3f, 2.0f}) {
        for (const float intensity : kIntensities) {
            for (const float share : {0.0f, 0.1f, 0.5f, 1.0f}) {
                const vec2 arc = bend_arc(share * stem, stem, intensity);
                const glm::dvec2 truth = integrated_arc(share * stem, stem, intensity);
                EXPECT_NEAR(arc.x, truth.x, 1e-5 * stem)
                    << stem << " " << intensity << " " << share;
                EXPECT_NEAR(arc.y, truth.y, 1e-5 * stem)
                    << stem << " " << intensity << " " << share;
            }
        }
    }
}

TEST(Bend, ArcKeepsLength) {
    for (const float intensity : kIntensities) {
        constexpr int kSteps = 200;
        const float stem = 0.4f;
        double length_so_far = 0;
        vec2 before(0.0f);
        for (int i = 1; i <= kSteps; ++i) {
            const float s = stem * static_cast<float>(i) / kSteps;
            const vec2 here = bend_arc(s, stem, intensity);
            length_so_far += glm::length(glm::dvec2(here) - glm::dvec2(before));
            EXPECT_NEAR(length_so_far, s, 2e-3 * stem) << intensity;
            EXPECT_LE(glm::length(here), s * (1 + 1e-5f)) << intensity;
            before = here;
        }
    }
}

TEST(Bend, ArcIsContinuousWhereTheSeriesTakesOver) {
    const float stem = 1.0f;
    const float switching = 1e-2f / (0.5f * kPi); // |k s| = 1e-2 at s = stem
    const vec2 below = bend_arc(stem, stem, switching * 0.9999f);
    const vec2 above = bend_arc(stem, stem, switching * 1.0001f);
    EXPECT_NEAR(below.x, above.x, 1e-6f);
    EXPECT_NEAR(below.y, above.y, 1e-5f);
    EXPECT_GT(above.y, 0.0f);
}

TEST(Bend, CalmIsExactAndSidesAreMirrored) {
    const vec2 calm = bend_arc(0.25f, 0.3f, 0.0f);
    EXPECT_EQ(calm.x, 0.25f);
    EXPECT_EQ(calm.y, 0.0f);
    for (const float intensity : kIntensities) {
        const vec2 here = bend_arc(0.2f, 0.3f, intensity);
        const vec2 there = bend_arc(0.2f, 0.3f, -intensity);
        EXPECT_TRUE(std::isfinite(here.x) && std::isfinite(here.y));
        EXPECT_EQ(here.x, there.x);
        EXPECT_EQ(here.y, -there.y);
    }
}

TEST(Bend, IntensityRisesAsTheSquareAndSaturates) {
    float before = bend_intensity(0.0f, 0.1f);
    EXPECT_EQ(before, 0.0f);
    for (float speed = 1.0f; speed <= 300.0f; speed += 1.0f) {
        const float here = bend_intensity(speed, 0.1f);
        EXPECT_GT(here, before) << speed;
        EXPECT_LT(here, 1.0f);
        before = here;
    }
    EXPECT_LE(bend_intensity(1e6f, 0.1f), 1.0f);
    // Drag: twice the wind bends four times as much, while blades still stand against it; later
    // much less.
    EXPECT_NEAR(bend_intensity(0.4f, 0.1f) / bend_intensity(0.2f, 0.1f), 4.0f, 0.02f);
    EXPECT_LT(bend_intensity(40.0f, 0.1f) / bend_intensity(20.0f, 0.1f), 1.35f);
}

/// Tip angle over 90 degrees of an elastic fibre clamped in a cross flow, and its Cauchy number
/// (drag of the upright fibre times length cubed over stiffness). Marched from the free tip, which
/// stands at `tip` (rad): force, moment and angle down to the root.
glm::dvec2 fibre(double tip) {
    double angle = tip, moment = 0, along = 0, up = 0, s = 0;
    for (const double step = 5e-4; angle > 0; s += step) {
        const double drag =
            std::cos(angle) * std::cos(angle); // square to the fibre: of the wind's component there
        along += drag * std::cos(angle) * step;
        up -= drag * std::sin(angle) * step;
        moment += (along * std::cos(angle) - up * std::sin(angle)) * step;
        angle -= moment * step;
    }
    return {tip / (0.5 * 3.14159265358979323846), s * s * s};
}

TEST(Bend, IntensityIsAnElasticFibresInDrag) {
    for (const double tip : {0.1, 0.2, 0.4, 0.8, 1.2, 1.4, 1.5}) {
        const glm::dvec2 found = fibre(tip);
        const float speed =
            static_cast<float>(std::sqrt(0.159 * found.y)); // I starts as Cauchy's / (3 pi)
        EXPECT_NEAR(bend_intensity(speed, 1.0f), found.x, 0.06) << tip;
    }
}

TEST(Bend, CanopyFallsWithTheWindAndNeverFlattens) {
    const float canopy = 0.35f;
    float before = canopy;
    for (float speed = 0.5f; speed <= 300.0f; speed += 0.5f) {
        const float here = canopy + bend_offset(canopy, canopy, vec2(0.6f, -0.8f) * speed, 0.17f).y;
        EXPECT_LT(here, before) << speed;
        EXPECT_GT(here, 0.6f * canopy) << speed;
        before = here;
    }
    EXPECT_LT(before, 0.66f * canopy); // and it does fall
    EXPECT_GT(bend_offset(canopy, canopy, vec2(1e6f, 0.0f), 0.17f).y, -0.4f * canopy);
}

TEST(Bend, OffsetFollowsTheWindAndKeepsDistanceToTheRoot) {
    const vec2 wind(3.0f, -4.0f);
    for (const float y : {0.01f, 0.1f, 0.3f}) {
        const vec3 offset = bend_offset(y, 0.3f, wind, 0.1f);
        EXPECT_GT(offset.x, 0.0f);
        EXPECT_NEAR(offset.x * wind.y, offset.z * wind.x, 1e-6f); // along the wind
        EXPECT_LT(offset.y, 0.0f);
        EXPECT_LE(glm::length(vec3(offset.x, y + offset.y, offset.z)), y * (1 + 1e-5f));
    }
    for (const vec3& none :
         {bend_offset(0.0f, 0.3f, wind, 0.1f), bend_offset(-0.1f, 0.3f, wind, 0.1f),
          bend_offset(0.2f, 0.3f, vec2(0.0f), 0.1f),
          grouped_offset(0.2f, vec2(0.3f, 0.35f), vec2(0.0f), 0.1f)}) {
        EXPECT_EQ(none, vec3(0.0f));
    }
}

TEST(Bend, TurnIsTheOffsetsDerivative) {
    const vec2 wind(3.0f, -4.0f);
    for (const float y : {0.02f, 0.1f, 0.29f}) {
        const float step = 2e-3f;
        const vec3 along = vec3(0.0f, 1.0f, 0.0f) + (bend_offset(y + step, 0.3f, wind, 0.1f) -
                                                     bend_offset(y - step, 0.3f, wind, 0.1f)) /
                                                        (2 * step);
        EXPECT_LT(glm::length(bend_turn(y, 0.3f, wind, 0.1f) - along), 1e-3f) << y;
        EXPECT_NEAR(glm::length(bend_turn(y, 0.3f, wind, 0.1f)), 1.0f, 1e-6f);
    }
    EXPECT_EQ(bend_turn(0.2f, 0.3f, vec2(0.0f), 0.1f), vec3(0.0f, 1.0f, 0.0f));
}

TEST(Bend, GroupedAndShellPutAnUprightTipAtOnePlace) {
    for (const float speed : {0.3f, 4.0f, 15.0f, 60.0f}) {
        for (const float stem : {0.15f, 0.3f}) {
            const vec2 wind = speed * vec2(0.8f, 0.6f);
            const vec3 shell = bend_offset(stem, 0.3f, wind, 0.1f);
            EXPECT_GT(shell.x, 0.0f);
            EXPECT_LT(glm::length(grouped_offset(stem, vec2(stem, 0.3f), wind, 0.1f) - shell),
                      1e-6f);
        }
    }
}

/// Flutter of a blade of 0.28 m at this time, in periods.
vec3 flutter_of(double time_s, float speed, float rank = 0.3f) {
    const double periods = time_s / kFlutterPeriod_s;
    return flutter_at(static_cast<float>(periods - std::floor(periods)),
                      vec4(0.28f, 0.6f, rank, 0.7f), flutter_amplitude(speed, 0.17f));
}

TEST(Flutter, StillInCalmGrowsWithTheWindAndSaturates) {
    EXPECT_EQ(flutter_of(3.3, 0.0f), vec3(0.0f));
    float before = 0;
    for (const float speed : {0.1f, 1.0f, 3.0f, 8.0f, 20.0f, 40.0f, 150.0f}) {
        float most = 0;
        for (int i = 0; i < 2000; ++i) {
            most = std::max(most, std::abs(flutter_of(0.01 * i, speed).x));
        }
        EXPECT_GT(most, before);
        EXPECT_LT(most, 0.2f);
        before = most;
    }
    EXPECT_LT(flutter_amplitude(0.1f, 0.17f), 1e-3f);
    EXPECT_LT(flutter_amplitude(80, 0.17f) / flutter_amplitude(20, 0.17f), 1.1f);
}

TEST(Flutter, IsAsFineAfterDaysAndHasNoSeam) {
    for (const double start : {0.0, 63.99, 127.995, 3 * 86400.0 - 0.003}) {
        double fastest = 0;
        for (int i = 0; i < 400; ++i) {
            const double time = start + 1e-4 * i;
            fastest = std::max<double>(
                fastest, glm::length(flutter_of(time + 1e-4, 20) - flutter_of(time, 20)));
        }
        EXPECT_GT(fastest, 1e-5) << start; // moves
        EXPECT_LT(fastest, 2e-3) << start; // without a jump: 0.4 rad at some 4 Hz
    }
    EXPECT_LT(glm::length(flutter_of(5 + 64.0 * 10000, 20) - flutter_of(5, 20)), 1e-3f);
}

TEST(Flutter, EachBladeHasItsOwnBeat) {
    EXPECT_GT(flutter_cycles(0.18f, 0.6f),
              2 * flutter_cycles(0.34f, 0.6f));                         // short ones are quicker
    EXPECT_GT(flutter_cycles(0.3f, 0.8f), flutter_cycles(0.3f, 0.35f)); // and stiff ones
    EXPECT_NEAR(flutter_cycles(0.27f, 0.6f) / kFlutterPeriod_s, 2.6f, 0.1f);
    EXPECT_EQ(flutter_cycles(0.01f, 1.0f) / kFlutterPeriod_s, 9.0f);
    // Blades of one length are spread over the beat at every moment.
    for (const double time : {0.0, 2.0, 100.0}) {
        int ahead = 0;
        for (int n = 0; n < 256; ++n) {
            ahead += flutter_of(time, 20, (static_cast<float>(n) + 0.5f) / 256).x > 0;
        }
        EXPECT_GT(ahead, 90);
        EXPECT_LT(ahead, 166);
    }
}

TEST(Flutter, KeepsLengthRootAndHeight) {
    std::mt19937 random(11);
    for (int n = 0; n < 200; ++n) {
        const RestBlade blade = random_blade(random);
        for (const float speed : {0.0f, 5.0f, 40.0f}) {
            const vec2 wind = speed * vec2(0.28f, 0.96f);
            vec3 v1 = blade.v1, v2 = blade.v2;
            pose_blade(v1, v2, vec4(blade.stem, 1.2f * blade.stem, 0.17f, 0.0f), wind);
            const vec3 posed = v2;
            const vec2 shift(0.17f * std::sin(static_cast<float>(n)), 0.06f);
            flutter_blade(v1, v2, blade.stem, speed > 0 ? shift : vec2(0.0f), wind);
            EXPECT_NEAR(measured_length(v1, v2) / blade.stem, 1.0, 0.01) << speed;
            EXPECT_GT(v2.y, 0.0f);
            EXPECT_LT(glm::length(v2 - posed), 0.3f * blade.stem);
            EXPECT_EQ(glm::length(v2 - posed) > 1e-3f * blade.stem, speed > 0) << speed;
        }
    }
}

TEST(Bend, KeepLengthRestoresTheArc) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int n = 0; n < 300; ++n) {
        const RestBlade blade = random_blade(random);
        // Stretched or shrunk, and pushed aside, the tip most: as a pose leaves it.
        const float scale = 0.5f + unit(random), push = 0.6f * blade.stem * unit(random);
        vec3 v1 = blade.v1 * scale + vec3(0.25f * push, 0.0f, 0.0f);
        vec3 v2 = blade.v2 * scale + vec3(push, -0.3f * push, 0.0f);
        keep_length(v1, v2, blade.stem);
        EXPECT_NEAR(measured_length(v1, v2) / blade.stem, 1.0, 0.01);
    }
}

TEST(Bend, KeepLengthSurvivesACollapsedBlade) {
    vec3 v1(0.0f), v2(0.0f);
    keep_length(v1, v2, 0.3f);
    EXPECT_TRUE(std::isfinite(v1.x) && std::isfinite(v2.y));
}

TEST(Pose, NearPoseKeepsArcLength) {
    std::mt19937 random(6);
    for (int n = 0; n < 200; ++n) {
        const RestBlade blade = random_blade(random);
        for (const float speed : {0.0f, 2.0f, 8.0f, 30.0f}) {
            vec3 v1 = blade.v1, v2 = blade.v2;
            pose_blade(v1, v2, vec4(blade.stem, blade.stem, 0.08f, 0.0f),
                       vec2(speed, 0.4f * speed));
            EXPECT_NEAR(measured_length(v1, v2) / blade.stem, 1.0, 0.01) << speed;
            EXPECT_GT(v2.y, 0.0f);
        }
    }
}

TEST(Pose, ShellPoseIsTheShellsWarp) {
    std::mt19937 random(7);
    const vec2 wind(5.0f, -3.0f);
    for (int n = 0; n < 100; ++n) {
        const RestBlade blade = random_blade(random);
        const float canopy = 1.1f * blade.stem;
        const vec4 shell(blade.stem, canopy, 0.1f, 1.0f);
        vec3 v1 = blade.v1, v2 = blade.v2;
        pose_blade(v1, v2, shell, wind);
        for (const float v : {0.0f, 0.5f, 1.0f}) {
            const vec3 rest = blade_curve(blade.v1, blade.v2, v);
            const vec3 warped = rest + bend_offset(rest.y, canopy, wind, 0.1f);
            EXPECT_LT(glm::length(blade_curve(v1, v2, v) - warped), 1e-6f * (1 + 10 * blade.stem))
                << v;
        }
        // Between these places a quadratic stays near the warped curve.
        for (const float v : {0.25f, 0.75f}) {
            const vec3 rest = blade_curve(blade.v1, blade.v2, v);
            const vec3 warped = rest + bend_offset(rest.y, canopy, wind, 0.1f);
            EXPECT_LT(glm::length(blade_curve(v1, v2, v) - warped), 0.02f * blade.stem) << v;
        }
    }
}

TEST(Pose, HalfwayIsBetweenBoth) {
    std::mt19937 random(8);
    const RestBlade blade = random_blade(random);
    const vec2 wind(6.0f, 1.0f);
    vec3 tips[3];
    for (int i = 0; i < 3; ++i) {
        vec3 v1 = blade.v1, v2 = blade.v2;
        pose_blade(v1, v2, vec4(blade.stem, 0.3f, 0.1f, 0.5f * static_cast<float>(i)), wind);
        tips[i] = v2;
    }
    EXPECT_GT(glm::length(tips[0] - tips[2]), 1e-4f); // the poses differ, or this shows nothing
    EXPECT_LT(glm::length(tips[1] - 0.5f * (tips[0] + tips[2])), 1e-6f);
}

TEST(Blade, OutlineTapersAboutTheMiddle) {
    const BladeOutline grass{2, 1, 1, 1};
    for (const float v : {0.0f, 0.3f, 0.8f, 1.0f}) {
        const float left = blade_outline(0.0f, v, grass), right = blade_outline(1.0f, v, grass);
        EXPECT_FLOAT_EQ(blade_outline(0.5f, v, grass), 0.5f);
        EXPECT_NEAR(left + right, 1.0f, 1e-6f);
        EXPECT_NEAR(right - left, 1 - v * v, 1e-6f);
    }
}

TEST(Blade, AHeadStandsOnItsStalk) {
    const BladeOutline flower{8, 0.1f, 0.8f, 0.5f};
    EXPECT_NEAR(blade_width_at(0.4f, flower), 0.1f, 1e-3f);
    EXPECT_NEAR(blade_width_at(0.9f, flower), 1, 1e-6f);                 // the head's middle
    EXPECT_NEAR(blade_width_at(0.85f, flower), std::sqrt(0.75f), 1e-5f); // an ellipse
    EXPECT_NEAR(blade_width_at(1, flower), 0, 1e-3f);
    // Half of a mesh's stations stand on the head, in rising order.
    EXPECT_FLOAT_EQ(blade_station(0.5f, flower), 0.8f);
    for (int i = 0; i < 16; ++i)
        EXPECT_LT(blade_station(static_cast<float>(i) / 16, flower),
                  blade_station(static_cast<float>(i + 1) / 16, flower));
    EXPECT_FLOAT_EQ(blade_station(0.3f, {2, 1, 1, 1}), 0.3f);
}

TEST(Blade, TangentIsTheCurvesDerivative) {
    std::mt19937 random(9);
    for (int n = 0; n < 50; ++n) {
        const RestBlade blade = random_blade(random);
        for (const float v : {0.05f, 0.5f, 0.95f}) {
            const vec3 ahead = blade_curve(blade.v1, blade.v2, v + 0.01f) -
                               blade_curve(blade.v1, blade.v2, v - 0.01f);
            EXPECT_GT(glm::dot(blade_tangent(blade.v1, blade.v2, v), glm::normalize(ahead)),
                      0.9999f);
        }
    }
    EXPECT_EQ(blade_tangent(vec3(0.0f), vec3(0.0f), 0.5f),
              vec3(0.0f, 1.0f, 0.0f)); // no NaN for a blade of no length
}

} // namespace
} // namespace sward::shared
