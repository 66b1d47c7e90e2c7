// SPDX-License-Identifier: Apache-2.0
// The fluid solver held to what is known of fluids: no divergence, nothing through walls, decay at
// the analytic rate, a vortex street at its Strouhal number, the same bits every time.
#include "gl/wind_fixture.h"

namespace sward::tests {
namespace {

using wind::Fluid;
using wind::FluidSettings;

constexpr double kTwoPi = 6.283185307179586;
constexpr double kNoBrake_mps = 200;

class WindFluid : public GlTest {
protected:
    /// A torus one wave wide with Taylor and Green's vortices of speed 1 m/s.
    static Fluid taylor_green(FluidSettings settings, glm::dvec2 mean = {0, 0}) {
        settings.periodic = true;
        Fluid fluid(settings);
        const int n = settings.cells;
        std::vector<float> u, v;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                u.push_back(static_cast<float>(mean.x + std::sin(kTwoPi * x / n) *
                                                            std::cos(kTwoPi * (y + 0.5) / n)));
                v.push_back(static_cast<float>(mean.y - std::cos(kTwoPi * (x + 0.5) / n) *
                                                            std::sin(kTwoPi * y / n)));
            }
        }
        fluid.set_state(u, v);
        return fluid;
    }
    static void run(Fluid& fluid, PlainInputs& inputs, int steps, glm::vec2 mean = {0, 0},
                    int first = 0) {
        for (int i = first + 1; i <= first + steps; ++i) {
            fluid.step(inputs, i * fluid.settings().step_s, steady_wind(mean), kNoBrake_mps);
        }
    }
};

TEST_F(WindFluid, TaylorGreenDecaysAtItsRate) {
    FluidSettings settings;
    settings.cells = 64;
    settings.cell_m = 0.1;
    settings.step_s = 0.05;
    settings.viscosity_m2s = 0.01;
    Fluid fluid = taylor_green(settings);
    PlainInputs none;
    const double before = FluidState(fluid).mean_square();
    const double side = settings.cells * settings.cell_m, k = kTwoPi / side;
    const int steps =
        static_cast<int>(side / settings.step_s); // a wave's length at the greatest speed
    double last = before;
    for (int i = 0; i < steps; ++i) {
        run(fluid, none, 1);
        const double now = FluidState(fluid).mean_square();
        EXPECT_LE(now, last);
        last = now;
    }
    const double rate = std::log(before / last) / (steps * settings.step_s);
    EXPECT_NEAR(rate / (4 * settings.viscosity_m2s * k * k), 1, 0.05);
}

TEST_F(WindFluid, WithoutViscosityEnergyHardlyFallsAndNeverGrows) {
    FluidSettings settings;
    settings.cells = 64;
    settings.cell_m = 0.1;
    settings.step_s = 0.05;
    Fluid fluid =
        taylor_green(settings, {0.7, -0.4}); // carried along, so that every interpolation is asked
    PlainInputs none;
    const double before = FluidState(fluid).mean_square();
    double last = before;
    for (int i = 0; i < 128; ++i) {
        run(fluid, none, 1);
        const double now = FluidState(fluid).mean_square();
        ASSERT_LE(now, last * (1 + 1e-6)) << i;
        last = now;
    }
    EXPECT_GT(last, 0.98 * before);
}

TEST_F(WindFluid, AUniformFlowStaysUniform) {
    const WindTextures textures;
    for (const bool periodic : {true, false}) {
        FluidSettings settings;
        settings.cells = 64;
        settings.periodic = periodic;
        settings.confinement = 0.3;
        settings.mean_mps = {3, -1.5};
        Fluid fluid(settings);
        PlainInputs none;
        if (periodic) {
            fluid.set_state(std::vector<float>(64 * 64, 3.0f), std::vector<float>(64 * 64, -1.5f));
        } else {
            fluid.move_to({-32, -32}, steady_wind({3, -1.5f}));
        }
        run(fluid, none, 50, {3, -1.5f});
        const FluidState state(fluid);
        for (std::size_t i = 0; i < state.u_.size(); ++i) {
            ASSERT_NEAR(state.u_[i], 3, 1e-4) << periodic;
            ASSERT_NEAR(state.v_[i], -1.5, 1e-4) << periodic;
        }
    }
}

TEST_F(WindFluid, LeavesNoDivergenceAndNothingGoesThroughWalls) {
    const WindTextures textures;
    // A wall thinner than the coarse levels' cells, a block, and a ring that shuts air in.
    const auto solid = [](glm::dvec2 p) {
        const double ring = glm::distance(p, {16, 12});
        return (std::abs(p.x + 10) < 0.5 && std::abs(p.y) < 30) ||
               (std::abs(p.x - 12) < 6 && std::abs(p.y + 20) < 4) || (ring > 6 && ring < 7.5);
    };
    FluidSettings settings;
    settings.cells = 200;
    settings.confinement = 0.3;
    Fluid fluid(settings);
    PlainInputs inputs;
    inputs.solid = solid;
    fluid.move_to({-100, -100}, steady_wind({4, 1}));
    for (int i = 0; i < 12; ++i) {
        run(fluid, inputs, i < 8 ? 1 : 13, {4, 1},
            i < 8 ? i : 8 + 13 * (i - 8)); // the impulsive start too
        EXPECT_LT(divergence_share(fluid, solid), 1e-3) << i;
    }
    const FluidState state(fluid);
    int faces = 0;
    const auto is_solid = [&](int x, int y) {
        return solid(state.grid.origin_m + (glm::dvec2(x, y) + 0.5) * state.grid.cell_m);
    };
    for (int y = fluid.inner_first(); y < fluid.inner_first() + fluid.inner_side(); ++y) {
        for (int x = fluid.inner_first() + 1; x < fluid.inner_first() + fluid.inner_side(); ++x) {
            if (is_solid(x, y) || is_solid(x - 1, y)) {
                ASSERT_EQ(state.u(x, y), 0) << x << " " << y;
                ++faces;
            }
            if (is_solid(y, x) || is_solid(y, x - 1)) {
                ASSERT_EQ(state.v(y, x), 0) << y << " " << x;
            }
        }
    }
    EXPECT_GT(faces, 500);
    EXPECT_GT(state.fastest(), 5); // the air goes around
}

TEST_F(WindFluid, EverySizeIsSolved) {
    const WindTextures textures;
    for (const int cells : {16, 17, 31, 34, 63, 129, 258}) {
        FluidSettings settings;
        settings.cells = cells;
        Fluid fluid(settings);
        PlainInputs inputs;
        const double radius = 0.06 * cells;
        inputs.solid = [=](glm::dvec2 p) { return glm::length(p) < radius; };
        fluid.move_to(glm::ivec2(-cells / 2), steady_wind({4, 1}));
        run(fluid, inputs, 6, {4, 1});
        EXPECT_LT(divergence_share(fluid, inputs.solid), 1e-3) << cells;
        EXPECT_GT(fluid.inner_side(), cells * 2 / 3);
        EXPECT_GT(FluidState(fluid).fastest(), 4.3) << cells;
    }
}

TEST_F(WindFluid, AMovingSolidCarriesItsVelocity) {
    const WindTextures textures;
    FluidSettings settings;
    settings.cells = 64;
    Fluid fluid(settings);
    PlainInputs inputs;
    inputs.solid = [](glm::dvec2 p) { return glm::length(p) < 3; };
    inputs.solid_velocity = {2, -1};
    fluid.move_to({-32, -32}, steady_wind({0, 0}));
    run(fluid, inputs, 5);
    const FluidState state(fluid);
    EXPECT_EQ(state.u(32, 32), 2);
    EXPECT_EQ(state.v(32, 32), -1);
    EXPECT_GT(state.u(32 + 7, 32), 0.5); // pushed ahead of it
    EXPECT_LT(divergence_share(fluid, inputs.solid), 1e-3);
}

TEST_F(WindFluid, ACircleShedsAVortexStreet) {
    const WindTextures textures;
    FluidSettings settings;
    settings.cells = 192;
    settings.cell_m = 0.25;
    settings.step_s = 1.0 / 15;
    Fluid fluid(settings);
    const double diameter = 5, speed = 4;
    PlainInputs inputs;
    inputs.solid = [&](glm::dvec2 p) { return glm::distance(p, {-12, 0.1}) < diameter / 2; };
    fluid.move_to({-96, -96}, steady_wind({4, 0}));
    std::vector<double> across; // speed across the stream, three diameters behind
    for (int i = 0; i < 600; ++i) {
        run(fluid, inputs, 1, {4, 0}, i);
        float v = 0;
        const auto grid = fluid.grid();
        grid.v->read(
            &v, sizeof(v),
            PlainInputs::stored(grid, {96 + static_cast<int>((-12 + 3 * diameter) / 0.25), 96}) *
                sizeof(float));
        across.push_back(static_cast<double>(v));
    }
    // Rising crossings of 0 in the last part.
    std::vector<double> crossings;
    for (std::size_t i = across.size() / 3; i + 1 < across.size(); ++i) {
        if (across[i] < 0 && across[i + 1] >= 0) {
            crossings.push_back(static_cast<double>(i) + across[i] / (across[i] - across[i + 1]));
        }
    }
    ASSERT_GE(crossings.size(), 4u);
    const double period = (crossings.back() - crossings.front()) /
                          static_cast<double>(crossings.size() - 1) * settings.step_s;
    const double strouhal = diameter / period / speed;
    RecordProperty("strouhal", std::to_string(strouhal));
    EXPECT_GT(strouhal, 0.15);
    EXPECT_LT(strouhal, 0.25);
}

TEST_F(WindFluid, AbsurdForcesPassAndCalmReturns) {
    const WindTextures textures;
    FluidSettings settings;
    settings.cells = 96;
    settings.confinement = 0.3;
    settings.mean_mps = {4, 0};
    Fluid fluid(settings);
    PlainInputs inputs;
    fluid.move_to({-48, -48}, steady_wind({4, 0}));
    int kind = 0;
    inputs.push = [&](const wind::FluidGrid& grid, std::vector<float>& u, std::vector<float>& v) {
        for (int y = 40; y < 60; ++y) {
            for (int x = 40; x < 60; ++x) {
                const std::size_t at = PlainInputs::stored(grid, {x, y});
                u[at] += kind == 0 ? 1e6f : kind == 1 ? NAN : kind == 2 ? INFINITY : -1e38f;
                v[at] -= kind == 3 ? INFINITY : 1e6f;
            }
        }
    };
    const double calm_mps = 6 + 2 * 4;
    inputs.loudest = 1e6;
    for (int i = 0; i < 40; ++i) {
        kind = i % 4;
        fluid.step(inputs, i / 60.0, steady_wind({4, 0}), calm_mps);
        ASSERT_LT(FluidState(fluid).fastest(), 300) << i;
    }
    EXPECT_GT(FluidState(fluid).fastest(), 100);
    inputs.push = {};
    inputs.loudest = 0;
    for (int i = 0; i < 60; ++i) {
        fluid.step(inputs, (40 + i) / 60.0, steady_wind({4, 0}), calm_mps);
    }
    EXPECT_LT(FluidState(fluid).fastest(),
              1.5 * calm_mps); // eddies of the storm are left, at speeds that gusts have
}

TEST_F(WindFluid, SolidEverywhereStandsStillAndLetsGo) {
    const WindTextures textures;
    FluidSettings settings;
    settings.cells = 64;
    settings.mean_mps = {4, 0};
    Fluid fluid(settings);
    PlainInputs inputs;
    inputs.solid = [](glm::dvec2) { return true; };
    fluid.move_to({-32, -32}, steady_wind({4, 0}));
    run(fluid, inputs, 10, {4, 0});
    const auto middle_mps = [&] {
        float u = 0;
        fluid.grid().u->read(&u, sizeof(u),
                             PlainInputs::stored(fluid.grid(), {32, 32}) * sizeof(float));
        return u;
    };
    EXPECT_EQ(middle_mps(), 0);
    inputs.solid = [](glm::dvec2) { return false; };
    fluid.move_to({-31, -32}, steady_wind({4, 0})); // asks for the solids anew
    run(fluid, inputs, 60, {4, 0}, 10);
    EXPECT_GT(middle_mps(), 0.2); // a second of wind has begun to push 60 m of still air
    EXPECT_LT(FluidState(fluid).fastest(), 8);
}

TEST_F(WindFluid, TwoRunsHaveTheSameBits) {
    const WindTextures textures;
    std::vector<FluidState> states;
    for (int turn = 0; turn < 2; ++turn) {
        FluidSettings settings;
        settings.cells = 100;
        settings.confinement = 0.3;
        Fluid fluid(settings);
        PlainInputs inputs;
        inputs.solid = [](glm::dvec2 p) { return glm::length(p) < 4; };
        fluid.move_to({-50, -50}, steady_wind({5, 2}));
        run(fluid, inputs, 40, {5, 2});
        states.emplace_back(fluid);
    }
    EXPECT_TRUE(states[0] == states[1]);
}

TEST_F(WindFluid, CellsThatStayKeepTheirBitsWhenTheWindowMoves) {
    const WindTextures textures;
    FluidSettings settings;
    settings.cells = 96;
    Fluid fluid(settings);
    PlainInputs inputs;
    inputs.solid = [](glm::dvec2 p) { return glm::length(p) < 4; };
    fluid.move_to({-48, -48}, steady_wind({5, 2}));
    run(fluid, inputs, 30, {5, 2});
    glm::ivec2 first(-48, -48);
    for (const glm::ivec2 shift :
         {glm::ivec2(8, 0), glm::ivec2(-3, 17), glm::ivec2(95, -40), glm::ivec2(-200, 5)}) {
        const FluidState before(fluid);
        const auto cells_before = fluid.cells().read_all<glm::vec4>(96 * 96);
        fluid.move_to(first + shift, steady_wind({5, 2}));
        const FluidState after(fluid);
        const auto cells_after = fluid.cells().read_all<glm::vec4>(96 * 96);
        int kept = 0;
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 96; ++x) {
                const glm::ivec2 was = glm::ivec2(x, y) + shift;
                const std::size_t at = after.place(x, y);
                if (was.x >= 0 && was.y >= 0 && was.x < 96 && was.y < 96) {
                    ASSERT_EQ(at, before.place(was.x, was.y));
                    ASSERT_EQ(after.u_[at], before.u_[at]);
                    ASSERT_EQ(after.v_[at], before.v_[at]);
                    ASSERT_EQ(cells_after[at], cells_before[at]);
                    ++kept;
                } else {
                    ASSERT_EQ(glm::vec2(after.u_[at], after.v_[at]), glm::vec2(5, 2));
                    ASSERT_EQ(cells_after[at], glm::vec4(5, 2, 5, 2));
                }
            }
        }
        EXPECT_EQ(kept, std::max(0, 96 - std::abs(shift.x)) * std::max(0, 96 - std::abs(shift.y)));
        first += shift;
        run(fluid, inputs, 2, {5, 2});
        EXPECT_LT(divergence_share(fluid, inputs.solid), 1e-3);
    }
}

} // namespace
} // namespace sward::tests
