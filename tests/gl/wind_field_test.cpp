// SPDX-License-Identifier: Apache-2.0
// The wind as a whole: ambient gusts, the window around the eye, and the answer that shaders and
// C++ share.
#include "base/error.h"
#include "gl/wind_fixture.h"
#include "wind/sources.h"
#include "wind/wind.h"

namespace sward::tests {
namespace {

using wind::Wind;

scene::WindSpec spec_of(double speed, double gust, int cells = 64) {
    scene::WindSpec spec;
    spec.speed_mps = speed;
    spec.gust = gust;
    spec.cells = cells;
    return spec;
}

/// A round pillar and a push beside it.
std::unique_ptr<PlainInputs> pillar() {
    auto inputs = std::make_unique<PlainInputs>();
    inputs->solid = [](glm::dvec2 p) { return glm::length(p) < 3; };
    return inputs;
}

class WindTest : public GlTest {
protected:
    /// What a shader gets at anchor-relative places.
    std::vector<glm::dvec2> on_gpu(const Wind& wind, glm::dvec2 anchor, double time_s,
                                   const std::vector<glm::vec4>& places) {
        shared::FrameConstants frame{};
        frame.wind = wind.field(anchor, time_s);
        gl::Buffer buffer(sizeof(frame));
        buffer.upload(&frame, sizeof(frame));
        buffer.bind_uniform(BIND_FRAME);
        wind.bind();
        std::vector<glm::dvec2> out;
        for (const glm::vec4& found :
             run_probe(shaders_, {"lib/wind.glsl"}, "    b.xy = wind_at(a.xy);", places)) {
            out.emplace_back(found.x, found.y);
        }
        return out;
    }
    static std::vector<glm::vec4> places_within(float reach, int count) {
        std::vector<glm::vec4> out;
        for (int i = 0; i < count; ++i) {
            const auto n = static_cast<std::uint64_t>(i);
            out.emplace_back(reach * (2 * unit_at(3, n, 0) - 1), reach * (2 * unit_at(3, n, 1) - 1),
                             0, 0);
        }
        return out;
    }
    struct Statistics {
        glm::dvec2 mean{0};
        double speed = 0, gust = 0;
    };
    static Statistics statistics(const Wind& wind, double time_s) {
        Statistics out;
        const int n = 100;
        double square = 0;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const glm::dvec2 here = wind.at(x * 41.3, y * 39.1, time_s);
                out.mean += here / (1.0 * n * n);
                out.speed += glm::length(here) / (n * n);
                square += glm::dot(here, here) / (n * n);
            }
        }
        out.gust = std::sqrt(0.5 * (square - glm::dot(out.mean, out.mean)));
        return out;
    }
    ShaderCopy shaders_;
};

TEST_F(WindTest, BlowsFromItsDirectionAtItsSpeed) {
    scene::WindSpec spec = spec_of(5, 0);
    spec.direction_deg = 270; // from the west: towards +x
    const Wind west(spec, 0.1);
    EXPECT_NEAR(west.at(10, 20, 0).x, 5, 1e-4);
    EXPECT_NEAR(west.at(10, 20, 5).y, 0, 1e-4);
    spec.direction_deg = 0; // from the north: towards +z
    EXPECT_NEAR(Wind(spec, 0.1).at(0, 0, 0).y, 5, 1e-4);
    const Wind calm(spec_of(0, 1), 0.1);
    EXPECT_EQ(calm.at(12, 34, 56), glm::dvec2(0));
}

TEST_F(WindTest, MeanSpeedAndGustsAreWhatTheSceneAsksFor) {
    for (const double speed : {2.0, 12.0}) {
        for (const double gust : {0.4, 1.0}) {
            Wind wind(spec_of(speed, gust), 0.1);
            for (const double time : {0.0, 6.0}) {
                wind.advance(time, {0, 0});
                wind.wait();
                const Statistics found = statistics(wind, time);
                EXPECT_NEAR(found.mean.x / speed, 1, 0.07) << speed << " " << gust << " " << time;
                EXPECT_NEAR(found.mean.y / speed, 0, 0.05);
                EXPECT_NEAR(found.speed / speed, 1, 0.07);
                EXPECT_NEAR(found.gust / (wind::AmbientTile::kGustShare * gust * speed), 1, 0.12);
            }
        }
    }
}

TEST_F(WindTest, GustsTravelAndChange) {
    Wind wind(spec_of(5, 0.6), 0.1);
    wind.advance(10, {0, 0});
    wind.wait();
    // Followed at the mean speed a gust hardly changes in some seconds; standing, one feels it
    // pass.
    double moving = 0, standing = 0;
    std::vector<glm::dvec2> before;
    for (int i = 0; i < 400; ++i) {
        before.push_back(wind.at(i * 17.0, i * 5.0, 10));
    }
    wind.advance(16, {0, 0});
    wind.wait();
    for (int i = 0; i < 400; ++i) {
        moving += glm::distance(wind.at(i * 17.0 + 6 * 4.9, i * 5.0, 16),
                                before[static_cast<std::size_t>(i)]);
        standing +=
            glm::distance(wind.at(i * 17.0, i * 5.0, 16), before[static_cast<std::size_t>(i)]);
    }
    EXPECT_LT(moving, 0.5 * standing);
    EXPECT_GT(moving, 0.01 * standing);
}

TEST_F(WindTest, TheTileDoesNotShow) {
    Wind wind(spec_of(5, 0.6), 0.1);
    // Correlation of the gusts at every distance that the eye could find them at again: along both
    // axes of both layers.
    const auto correlation = [&](glm::dvec2 shift) {
        double product = 0, square = 0;
        for (int i = 0; i < 4000; ++i) {
            const auto n = static_cast<std::uint64_t>(i);
            const glm::dvec2 place = 3000.0 * glm::dvec2(unit_at(5, n, 0), unit_at(5, n, 1));
            const glm::dvec2 a =
                wind.at(place.x, place.y, 0) - glm::dvec2(5 * (1 - 0.25 * 0.27 * 0.27), 0);
            const glm::dvec2 b = wind.at(place.x + shift.x, place.y + shift.y, 0) -
                                 glm::dvec2(5 * (1 - 0.25 * 0.27 * 0.27), 0);
            product += glm::dot(a, b);
            square += 0.5 * (glm::dot(a, a) + glm::dot(b, b));
        }
        return product / square;
    };
    EXPECT_GT(correlation({10, 0}), 0.6);
    double most = 0;
    const double tile = wind::AmbientTile::kCells * wind::AmbientTile::kCell_m;
    for (const double turn : {0.35, 0.35 + 2.39996322972865}) {
        for (const double scale : {1.0, 0.61803398874989}) {
            const glm::dvec2 along(std::cos(turn), std::sin(turn)), across(-along.y, along.x);
            most = std::max({most, std::abs(correlation(along * tile * scale)),
                             std::abs(correlation(across * tile * scale))});
        }
    }
    EXPECT_LT(most, 0.75); // a single tile: 1
}

TEST_F(WindTest, SameAnswerFromEveryAnchor) {
    Wind wind(spec_of(5, 0.7), 0.1);
    for (const double time : {0.0, 17.3}) {
        wind.advance(time, {0, 0});
        wind.wait();
        for (const glm::dvec2& place : {glm::dvec2(3, -8), glm::dvec2(-15000.25, 9876.5)}) {
            const glm::dvec2 truth = wind.at(place.x, place.y, time);
            for (const glm::dvec2& anchor :
                 {glm::dvec2(0), glm::dvec2(64, -128), glm::dvec2(-500, 700)}) {
                const glm::dvec2 base = glm::floor(place / 64.0) * 64.0 + anchor;
                const auto found =
                    on_gpu(wind, base, time, {glm::vec4(glm::vec2(place - base), 0, 0)});
                EXPECT_LT(glm::length(found[0] - truth), 1e-4 * glm::length(truth))
                    << time << " " << anchor.x;
            }
        }
    }
}

TEST_F(WindTest, ShadersAndCppAnswerAlike) {
    Wind wind(spec_of(5, 0.7), 0.1, pillar());
    wind.advance(0.51, {4, -3}); // between states of both
    wind.wait();
    ASSERT_NE(wind.window(), nullptr);
    const glm::dvec2 anchor(64, 0);
    const auto places =
        places_within(90, 2000); // the window, its rim, and the ambient wind around it
    const auto found = on_gpu(wind, anchor, 0.51, places);
    int inside = 0;
    const Wind ambient_alone(spec_of(5, 0.7), 0.1);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec2 at = anchor + glm::dvec2(glm::vec2(places[i]));
        const glm::dvec2 truth = wind.at(at.x, at.y, 0.51);
        ASSERT_LT(glm::length(found[i] - truth), 2e-5 * (1 + glm::length(truth)))
            << at.x << " " << at.y;
        inside += glm::length(truth - ambient_alone.at(at.x, at.y, 0.51)) > 0.05;
    }
    EXPECT_GT(inside, 20);
    EXPECT_LT(glm::length(wind.at(0, 0, 0.51)), 1e-6); // within the pillar
}

TEST_F(WindTest, AnswersBeforeAnythingHasComeBack) {
    const Wind wind(spec_of(5, 0.5), 0.1);
    const glm::dvec2 first = wind.at(100, 200, 0);
    EXPECT_GT(glm::length(first), 1);
    EXPECT_LT(glm::length(first), 12);
    const auto found = on_gpu(wind, {64, 192}, 0, {glm::vec4(36, 8, 0, 0)});
    EXPECT_LT(glm::length(found[0] - first), 1e-4);
}

TEST_F(WindTest, FramesPerSecondChangeNoBit) {
    const double end = 0.75;
    std::vector<std::vector<glm::vec4>> local, ambient;
    for (const double rate : {30.0, 60.0, 144.0, 4.0}) {
        Wind wind(spec_of(6, 0.8), 0.1, pillar());
        for (int frame = 0; frame / rate <= end; ++frame) {
            wind.advance(frame / rate, {0, 0});
        }
        wind.advance(end, {0, 0});
        local.push_back(wind.window()->fluid().cells().read_all<glm::vec4>(64 * 64));
        ambient.push_back(wind.ambient().cells().read_all<glm::vec4>(256 * 256));
        EXPECT_EQ(wind.lag_s(end), 0);
    }
    for (std::size_t i = 1; i < local.size(); ++i) {
        EXPECT_EQ(local[i], local[0]) << i;
        EXPECT_EQ(ambient[i], ambient[0]) << i;
    }
}

TEST_F(WindTest, GoingBackBeginsAnew) {
    Wind wind(spec_of(6, 0.8), 0.1, pillar());
    wind.advance(0.4, {0, 0});
    const auto first = wind.window()->fluid().cells().read_all<glm::vec4>(64 * 64);
    wind.advance(1.7, {0, 0});
    EXPECT_NE(wind.window()->fluid().cells().read_all<glm::vec4>(64 * 64), first);
    wind.advance(0.4, {0, 0});
    EXPECT_EQ(wind.window()->fluid().cells().read_all<glm::vec4>(64 * 64), first);
    wind.wait();
    EXPECT_LT(glm::length(wind.at(0, 0, 0.4)), 1e-6);
}

TEST_F(WindTest, TheWindowFollowsTheEye) {
    Wind wind(spec_of(6, 0.5), 0.1, pillar());
    for (int i = 0; i <= 30; ++i) {
        const glm::dvec2 eye(i * 2.0, -i * 1.0); // 60 m in half a second, twice the window's side
        wind.advance(i / 60.0, eye);
        const glm::dvec2 centre = wind.window()->corner() + 0.5 * 64 * 0.5;
        EXPECT_LE(glm::length(centre - eye), 0.5 * wind::Window::kMoveCells * 0.5 * 1.5 + 1e-9);
    }
    wind.wait();
    const glm::dvec2 here = wind.at(60, -30, 0.5);
    EXPECT_TRUE(std::isfinite(here.x) && glm::length(here) < 15);
}

TEST_F(WindTest, ALaggingWindowIsBoundedAndCatchesUp) {
    Wind wind(spec_of(6, 0.5), 0.1, pillar());
    wind.advance(0, {0, 0});
    wind.advance(1, {0, 0}, 3);
    EXPECT_NEAR(wind.lag_s(1), 1 - 3 / 60.0, 1e-6);
    wind.advance(1, {0, 0});
    EXPECT_LT(wind.lag_s(1), 1e-6);
}

TEST_F(WindTest, WhatAHostMovesHasASmallWindowThatFades) {
    scene::Scene scene;
    scene.wind = spec_of(0, 0, 160);
    scene.wind.moving_cells = 96;
    scene.wind.step_s = 0.05;
    auto inputs =
        std::make_unique<wind::Sources>(scene, wind::Meshes{}, [](double, double) { return 0.0; });
    wind::Sources& host = *inputs;
    Wind wind(scene.wind, 0.1, std::move(inputs));
    wind.advance(0.1, {0, 0});
    EXPECT_EQ(wind.window(), nullptr);
    scene::MovingWindSource rotor;
    rotor.source.kind = scene::WindSource::Kind::kRotor;
    rotor.source.strength_mps = 10;
    rotor.source.radius_m = 3;
    rotor.source.height_m = 3;
    host.set_moving({rotor});
    wind.advance(1, {0, 0});
    ASSERT_NE(wind.window(), nullptr);
    EXPECT_EQ(wind.window()->tag().cells, 96);
    wind.wait();
    const double blown = wind.at(4, 0, 1).x;
    EXPECT_GT(blown, 6);
    const float rim = wind.field({0, 0}, 1).window_rim;
    scene::WindArrow arrow;
    arrow.tip = {20, 0};
    host.set_arrows({arrow}); // something of the scene's: the whole window, begun anew
    wind.advance(2, {0, 0});
    EXPECT_EQ(wind.window()->tag().cells, 160);
    wind.wait();
    EXPECT_NEAR(wind.at(4, 0, 2).x, blown, 0.1 * blown) << "the small one was large enough";
    host.set_arrows({});
    wind.advance(2.1, {0, 0});
    EXPECT_EQ(wind.window()->tag().cells, 96);
    host.set_moving({});
    wind.advance(6, {0, 0});
    ASSERT_NE(wind.window(), nullptr) << "what was stirred dies away";
    EXPECT_EQ(wind.field({0, 0}, 6).window_rim, rim);
    wind.advance(7, {0, 0});
    EXPECT_GT(wind.field({0, 0}, 7).window_rim, 50 * rim);
    wind.advance(7.2, {0, 0});
    EXPECT_EQ(wind.window(), nullptr);
}

TEST_F(WindTest, RefusesWhatIsNoTime) {
    Wind wind(spec_of(6, 0.5), 0.1);
    for (const double time : {static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
        EXPECT_THROW(wind.advance(time, {0, 0}), base::Error);
    }
    EXPECT_THROW(wind.advance(1, {NAN, 0}), base::Error);
    wind.advance(-5, {0, 0}); // before the beginning: the beginning
    wind.advance(0, {0, 0});
    wind.advance(1e7, {0, 0}); // a leap is not stepped through
    wind.wait();
    EXPECT_LT(glm::length(wind.at(3, 4, 1e7)), 15);
}

} // namespace
} // namespace sward::tests
