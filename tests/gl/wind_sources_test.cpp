// SPDX-License-Identifier: Apache-2.0
// Arrows, sources and obstacles on the GPU: the passes against the CPU's answer, and what the fluid
// makes of them.
#include "gl/wind_fixture.h"

#include "shared/wind_grid.h"
#include "wind/sources.h"

namespace sward::tests {
namespace {

using wind::FluidGrid;
using Source = scene::WindSource;

/// Buffers as the solver's, with a window that has travelled: storage place and world place differ.
struct GridOnGpu {
    GridOnGpu(int cells, double cell_m, glm::ivec2 first_cell) {
        const std::size_t count = static_cast<std::size_t>(cells) * cells;
        u = gl::Buffer(count * 4), v = gl::Buffer(count * 4), solid = gl::Buffer(count * 4),
        inflow = gl::Buffer(count * 4);
        solid_velocity = gl::Buffer(count * 8);
        grid.u = &u, grid.v = &v, grid.solid = &solid, grid.solid_velocity = &solid_velocity,
        grid.inflow = &inflow;
        grid.cells = cells;
        grid.cell_m = cell_m;
        grid.first_cell = first_cell;
        grid.origin_m = glm::dvec2(first_cell) * cell_m;
        grid.offset = ((first_cell % cells) + cells) % cells;
        grid.time_s = 3;
        grid.step_s = 1.0 / 60;
        shared::WindGrid constants{};
        constants.cells = cells;
        constants.stored = grid.offset;
        constants.has_solids = 1;
        constants.cell_m = static_cast<float>(cell_m);
        constants.per_m = static_cast<float>(1 / cell_m);
        constants.step_s = static_cast<float>(grid.step_s);
        constants.step_per_m = static_cast<float>(grid.step_s / cell_m);
        block = gl::Buffer(sizeof(constants));
        block.upload(&constants, sizeof(constants));
        block.bind_uniform(BIND_WIND_GRID);
        std::vector<float> noise(count);
        for (std::size_t i = 0; i < count; ++i)
            noise[i] = static_cast<float>((i * 2654435761u >> 7) % 1000) * 0.01f - 5;
        u.upload(noise.data(), count * 4);
        v.upload(noise.data(), count * 4);
        inflow.clear_to_zero();
        start = noise;
    }
    template<class T> [[nodiscard]] std::vector<T> read(const gl::Buffer& buffer) const {
        glMemoryBarrier(GL_ALL_BARRIER_BITS);
        return buffer.read_all<T>(static_cast<std::size_t>(grid.cells) * grid.cells);
    }
    gl::Buffer u, v, solid, solid_velocity, inflow, block;
    FluidGrid grid;
    std::vector<float> start;
};

scene::WindArrow arrow(const std::string& id, const std::string& parent, glm::dvec2 root,
                       glm::dvec2 tip, double strength, double radius) {
    scene::WindArrow a;
    a.id = id, a.parent = parent, a.root = root, a.tip = tip, a.strength_mps = strength,
    a.radius_m = radius;
    return a;
}

Source source(Source::Kind kind, glm::dvec2 place, double strength, double radius) {
    Source s;
    s.kind = kind;
    s.where.place = place;
    s.strength_mps = strength;
    s.radius_m = radius;
    return s;
}

void add_box(scene::Mesh& mesh, glm::vec3 least, glm::vec3 most) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i)
        mesh.positions.emplace_back(i & 1 ? most.x : least.x, i & 2 ? most.y : least.y,
                                    i & 4 ? most.z : least.z);
    const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& q : quads) {
        const auto corner = [&](int i) { return first + static_cast<std::uint32_t>(q[i]); };
        mesh.triangles.push_back({corner(0), corner(1), corner(2)});
        mesh.triangles.push_back({corner(0), corner(2), corner(3)});
    }
}

/// A window 300 m from the origin with something of every kind in it.
class WindSources : public GlTest {
protected:
    WindSources() {
        scene_.wind.cell_m = 0.5;
        scene_.paths["way"].keys = {{0, {300, 2, -80}, 30, 0}, {10, {340, 8, -60}, 90, 0}};
        scene_.wind.arrows = {arrow("a", "", {310, -95}, {318, -90}, 9, 5),
                              arrow("b", "a", {318, -90}, {326, -84}, 7, 4),
                              arrow("c", "", {330, -60}, {319, -80}, 12, 30)};
        for (const auto kind : {Source::Kind::kRotor, Source::Kind::kJet, Source::Kind::kWake,
                                Source::Kind::kCyclone, Source::Kind::kWave, Source::Kind::kFan}) {
            scene_.wind.sources.push_back(source(kind, {322, -76}, 8, 3));
            scene_.wind.sources.back().height_m = 3;
            scene_.wind.sources.back().length_m = 14;
            scene_.wind.sources.back().reach_m = 15;
        }
        scene_.wind.sources[2].where = {{0, 0}, 0, "way"};
        scene_.wind.sources[3].where.place = {335, -65};
        const auto obstacle = [&](scene::WindObstacle::Kind kind, glm::dvec2 place, glm::dvec2 size,
                                  double yaw) {
            scene::WindObstacle one;
            one.kind = kind;
            one.where = {place, yaw, ""};
            one.size = size;
            scene_.wind.obstacles.push_back(one);
        };
        obstacle(scene::WindObstacle::Kind::kBox, {315, -70}, {9, 3}, 25);
        obstacle(scene::WindObstacle::Kind::kCircle, {330, -90}, {4, 4}, 0);
        obstacle(scene::WindObstacle::Kind::kMesh, {325, -75}, {1, 1}, 70);
        scene_.wind.obstacles.back().mesh = "barn.glb";
        obstacle(scene::WindObstacle::Kind::kBox, {0, 4}, {3, 8}, 10);
        scene_.wind.obstacles.back().where.path = "way";
        add_box(meshes_["barn.glb"], {-5, 0, -3}, {2, 3, 3});
        add_box(meshes_["barn.glb"], {0, 0, 0}, {6, 3, 2});
    }
    [[nodiscard]] wind::Sources sources() const {
        return {scene_, meshes_, [](double, double) { return 0.0; }};
    }
    scene::Scene scene_;
    wind::Meshes meshes_;
    static constexpr glm::ivec2 kFirst{603, -203}; // 301.5, -101.5 m
    static constexpr int kCells = 100;             // not a multiple of a tile
};

TEST_F(WindSources, SolidsAreTheCpusAndMoveAsTheirPath) {
    GridOnGpu gpu(kCells, 0.5, kFirst);
    wind::Sources inputs = sources();
    EXPECT_TRUE(inputs.fill_solids(gpu.grid, true));
    const auto mask = gpu.read<std::uint32_t>(gpu.solid);
    const auto speeds = gpu.read<glm::vec2>(gpu.solid_velocity);
    const wind::SolidList list(scene_, meshes_);
    const auto solids = list.at(gpu.grid.time_s, gpu.grid.origin_m);
    int filled = 0, by_last = 0;
    for (int y = 0; y < kCells; ++y)
        for (int x = 0; x < kCells; ++x) {
            const glm::vec2 at = (glm::vec2(glm::ivec2(x, y)) + 0.5f) * 0.5f;
            int owner = -1;
            for (std::size_t i = 0; i < solids.size(); ++i)
                if (wind::covers(solids[i], at, list.words()))
                    owner = static_cast<int>(i);
            const std::size_t index = PlainInputs::stored(gpu.grid, {x, y});
            ASSERT_EQ(mask[index] != 0, owner >= 0) << x << " " << y;
            const glm::vec2 speed =
                owner >= 0 ? shared::solid_velocity(solids[static_cast<std::size_t>(owner)], at)
                           : glm::vec2(0);
            ASSERT_NEAR(speeds[index].x, speed.x, 1e-4);
            ASSERT_NEAR(speeds[index].y, speed.y, 1e-4);
            filled += owner >= 0 ? 1 : 0;
            by_last += owner == 3 ? 1 : 0;
        }
    EXPECT_GT(filled, 500);
    EXPECT_GT(by_last, 50) << "the one that moves is in the window";
    EXPECT_FALSE([&] {
        scene::Scene still = scene_;
        still.wind.obstacles.pop_back();
        wind::Sources calm(still, meshes_, {});
        calm.fill_solids(gpu.grid, true);
        gpu.grid.time_s += 1;
        return calm.fill_solids(gpu.grid, false);
    }()) << "nothing moved: the mask still holds";
    EXPECT_TRUE(inputs.fill_solids(gpu.grid, false)) << "a second later the lorry is elsewhere";
    EXPECT_NE(gpu.read<std::uint32_t>(gpu.solid), mask);
}

TEST_F(WindSources, ForcesAreTheCpusAndTheSameBitsTwice) {
    std::vector<float> first;
    for (int round = 0; round < 2; ++round) {
        GridOnGpu gpu(kCells, 0.5, kFirst);
        wind::Sources inputs = sources();
        inputs.apply_forces(gpu.grid);
        const auto u = gpu.read<float>(gpu.u), v = gpu.read<float>(gpu.v),
                   inflow = gpu.read<float>(gpu.inflow);
        if (round == 1) {
            EXPECT_EQ(u, first);
            continue;
        }
        first = u;
        const wind::ForceList list(scene_.wind, scene_.paths, {});
        const auto forces = list.at(gpu.grid.time_s, gpu.grid.origin_m, 0.5);
        ASSERT_EQ(forces.size(), 9u);
        int changed = 0;
        for (int y = 0; y < kCells; ++y)
            for (int x = 0; x < kCells; ++x) {
                const glm::vec2 corner = glm::vec2(glm::ivec2(x, y)) * 0.5f;
                glm::vec2 wanted(0), rate(0);
                float divergence = 0;
                for (const shared::WindForce& force : forces) { // every force, no bins
                    const auto west = shared::wind_force_at(force, corner + glm::vec2(0, 0.25f));
                    const auto north = shared::wind_force_at(force, corner + glm::vec2(0.25f, 0));
                    wanted += glm::vec2(west.target.x * west.rate, north.target.y * north.rate);
                    rate += glm::vec2(west.rate, north.rate);
                    divergence +=
                        (shared::wind_force_at(force, corner + glm::vec2(0.5f, 0.25f)).outflow.x -
                         west.outflow.x +
                         shared::wind_force_at(force, corner + glm::vec2(0.25f, 0.5f)).outflow.y -
                         north.outflow.y) /
                        0.5f;
                }
                const std::size_t index = PlainInputs::stored(gpu.grid, {x, y});
                const auto step = static_cast<float>(gpu.grid.step_s);
                ASSERT_NEAR(u[index], shared::relaxed(gpu.start[index], wanted.x, rate.x, step),
                            2e-3)
                    << x << " " << y;
                ASSERT_NEAR(v[index], shared::relaxed(gpu.start[index], wanted.y, rate.y, step),
                            2e-3)
                    << x << " " << y;
                ASSERT_NEAR(inflow[index], divergence, 5e-3 * (1 + std::abs(divergence)))
                    << x << " " << y;
                changed += u[index] != gpu.start[index] ? 1 : 0;
            }
        EXPECT_GT(changed, 1000);
        EXPECT_LT(changed, kCells * kCells) << "what nothing touches keeps its bits";
        EXPECT_NEAR(inputs.loudest_mps(), 12, 1e-4);
    }
}

TEST_F(WindSources, InflowSumsToNothingAndGoesWithItsSource) {
    GridOnGpu gpu(kCells, 0.5, kFirst);
    scene_.wind.sources = {source(Source::Kind::kFan, {325, -77}, 9, 2)};
    scene_.wind.sources[0].end_s = 5;
    wind::Sources inputs = sources();
    inputs.apply_forces(gpu.grid);
    double sum = 0, most = 0;
    for (const float value : gpu.read<float>(gpu.inflow))
        sum += static_cast<double>(value),
            most = std::max(most, std::abs(static_cast<double>(value)));
    EXPECT_GT(most, 2);
    EXPECT_LT(std::abs(sum), 1e-3 * most);
    gpu.grid.time_s = 6;
    inputs.apply_forces(gpu.grid);
    for (const float value : gpu.read<float>(gpu.inflow))
        ASSERT_EQ(value, 0);
}

/// A fluid around the origin, without ambient wind, that a scene's sources drive.
class WindDriven : public GlTest {
protected:
    WindDriven() {
        settings_.cells = 96;
        settings_.cell_m = 0.5;
        settings_.step_s = 1.0 / 60;
        scene_.wind.cell_m = settings_.cell_m;
    }
    void start() {
        sources_ = std::make_unique<wind::Sources>(scene_, wind::Meshes{},
                                                   [](double, double) { return 0.0; });
        fluid_ = std::make_unique<wind::Fluid>(settings_);
        fluid_->move_to(glm::ivec2(-settings_.cells / 2), steady_wind({0, 0}));
        steps_ = 0;
    }
    void run_to(double time_s) {
        while ((steps_ + 1) * settings_.step_s <= time_s + 1e-9)
            fluid_->step(*sources_, ++steps_ * settings_.step_s, steady_wind({0, 0}), 3);
    }
    [[nodiscard]] glm::dvec2 velocity(glm::dvec2 at) const {
        const FluidState state(*fluid_);
        const glm::ivec2 cell(glm::floor((at - state.grid.origin_m) / state.grid.cell_m));
        return {0.5 * (state.u(cell.x, cell.y) + state.u(cell.x + 1, cell.y)),
                0.5 * (state.v(cell.x, cell.y) + state.v(cell.x, cell.y + 1))};
    }
    WindTextures textures_;
    wind::FluidSettings settings_;
    scene::Scene scene_;
    std::unique_ptr<wind::Sources> sources_;
    std::unique_ptr<wind::Fluid> fluid_;
    int steps_ = 0;
};

TEST_F(WindDriven, AGustReachesTheTipsOfATreeInOrder) {
    // 8 m at 8 m/s each: an arrow a second, then two at once.
    scene_.wind.arrows = {arrow("root", "", {-18, 0}, {-10, 0}, 8, 2.5),
                          arrow("stem", "root", {-10, 0}, {-2, 0}, 8, 2.5),
                          arrow("left", "stem", {-2, 0}, {3.657, -5.657}, 8, 2.5),
                          arrow("right", "stem", {-2, 0}, {3.657, 5.657}, 8, 2.5)};
    const auto spans = wind::arrow_spans(scene_.wind.arrows);
    start();
    std::vector<double> reached(scene_.wind.arrows.size(), -1);
    for (double time = 0.05; time < 4; time += 0.05) {
        run_to(time);
        for (std::size_t i = 0; i < reached.size(); ++i) {
            const scene::WindArrow& a = scene_.wind.arrows[i];
            const double along = glm::dot(velocity(a.tip), glm::normalize(a.tip - a.root));
            EXPECT_LE(along, 8 * 1.25)
                << "a push ends at its strength; the vortices of a starting jet add a little";
            if (reached[i] < 0 && along >= 4)
                reached[i] = time;
        }
    }
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const scene::WindArrow& a = scene_.wind.arrows[i];
        ASSERT_GT(reached[i], 0) << a.id;
        EXPECT_LE(reached[i], spans[i].start_s + glm::distance(a.root, a.tip) / a.strength_mps)
            << a.id << ": within the time of flight";
        EXPECT_GT(reached[i], spans[i].start_s - 0.35) << a.id << ": not long before its turn";
    }
    EXPECT_LT(reached[0] + 0.3, reached[1]);
    EXPECT_LT(reached[1] + 0.3, reached[2]);
    EXPECT_NEAR(reached[2], reached[3], 0.051) << "a fork is even";
}

TEST_F(WindDriven, ARotorAndAFanBlowOutwardsThroughTheProjection) {
    // As forces these are pure gradients, and the projection would leave nothing of them.
    scene_.wind.sources = {source(Source::Kind::kFan, {0.25, 0.25}, 6, 3)};
    start();
    run_to(1);
    for (const double angle : {0.0, 0.7, 1.9, 3.3, 5.0}) {
        const glm::dvec2 out(std::cos(angle), std::sin(angle));
        EXPECT_NEAR(glm::dot(velocity(glm::dvec2(0.25) + out * 3.0), out), 6, 0.6) << angle;
        EXPECT_NEAR(glm::dot(velocity(glm::dvec2(0.25) + out * 6.0), out), 6 * 0.699, 0.5) << angle;
    }
    EXPECT_LT(glm::length(velocity({21, 0.25})), 0.6) << "past its reach of 18 m";
}

TEST_F(WindDriven, ACycloneTurnsTheAirAndDrawsItIn) {
    scene_.wind.sources = {source(Source::Kind::kCyclone, {0.25, 0.25}, 12, 3)};
    scene_.wind.sources[0].inflow = 0.2;
    start();
    run_to(3);
    for (const double angle : {0.3, 1.5, 2.9, 4.4}) {
        const glm::dvec2 out(std::cos(angle), std::sin(angle));
        const glm::dvec2 at = velocity(glm::dvec2(0.25) + out * 4.0);
        const double around =
            at.x * out.y - at.y * out.x; // counter-clockwise from above: z is south
        EXPECT_GT(around, 8) << angle;
        EXPECT_LT(around, 14) << angle;
        EXPECT_LT(glm::dot(at, out), -1) << angle;
    }
    // Inflow winds the core up; the push holds it near what the scene asks for.
    EXPECT_LT(FluidState(*fluid_).fastest(), 1.3 * 12);
}

TEST_F(WindDriven, NothingAbsurdMakesItUnsteady) {
    scene_.wind.arrows = {arrow("a", "", {-5, 0}, {0, 0}, 300, 0.01),
                          arrow("b", "", {5, 0.1}, {0, 0.1}, 300, 1000)};
    scene_.wind.sources = {source(Source::Kind::kCyclone, {4, 4}, 300, 0.05),
                           source(Source::Kind::kFan, {-4, 4}, 300, 0.05),
                           source(Source::Kind::kWave, {0, 0}, 300, 1000)};
    scene_.wind.sources[2].wavelength_m = 0.5;
    start();
    run_to(1);
    EXPECT_TRUE(std::isfinite(FluidState(*fluid_).fastest()));
    EXPECT_LE(FluidState(*fluid_).fastest(), 1.5 * shared::kWindCeiling_mps);
}

TEST_F(WindDriven, TheSameScenesGiveTheSameBits) {
    scene_.wind.arrows = {arrow("a", "", {-8, 0}, {-3, 1}, 9, 3)};
    scene_.wind.sources = {source(Source::Kind::kCyclone, {5, 4}, 9, 2),
                           source(Source::Kind::kFan, {5, -9}, 5, 2)};
    scene::WindObstacle obstacle;
    obstacle.where.place = {3, 0};
    obstacle.size = {2, 2};
    scene_.wind.obstacles = {obstacle};
    start();
    run_to(1);
    const FluidState first(*fluid_);
    start();
    run_to(1);
    EXPECT_TRUE(first == FluidState(*fluid_));
}

} // namespace
} // namespace sward::tests
