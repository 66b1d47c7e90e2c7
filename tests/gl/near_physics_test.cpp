// SPDX-License-Identifier: Apache-2.0
// Living blades: the physics pass against its C++ twin, pages, sleep, and the cost of colliders.
#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "base/error.h"
#include "blades/simulation.h"
#include "gl/fixture.h"
#include "shared/bend.h"
#include "shared/tile_lie.h"

namespace sward::tests {
namespace {

using blades::HostSphere;
using blades::Simulation;
using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr double kGround_m = 100;
constexpr double kStep_s = Simulation::kStep_s;
const glm::dvec3 kEye(70.3, kGround_m + 1.6, -121.7);

/// A scene whose balls roll past the eye, one of them 30 times as fast, and one that stands half in
/// the ground.
scene::Scene ball_scene() {
    scene::Scene scene;
    const auto ball = [&](const char* name, double radius, glm::dvec3 from, glm::dvec3 to,
                          double seconds) {
        scene.paths[name].keys = {{0, from, 0, 0}, {seconds, to, 0, 0}};
        scene::ObjectSpec object;
        object.kind = scene::ObjectKind::kSphere;
        object.radius_m = radius;
        object.path = name;
        scene.objects.push_back(object);
    };
    ball("slow", 0.3, {67, 0.3, -123}, {74, 0.3, -120}, 8);
    ball("fast", 0.2, {60, 0.2, -121}, {160, 0.2, -121}, 1.5);
    ball("sunk", 0.4, {71, 0.1, -119}, {71, 0.1, -119}, 1);
    return scene;
}

class NearPhysics : public GlTest {
protected:
    NearPhysics() : world_(flat_field(kGround_m), 0, even_mask(1), kEye) {}

    std::map<std::filesystem::path, scene::SphereSet> packed_;
    [[nodiscard]] blades::Colliders colliders(const scene::Scene& scene) const {
        return {scene, packed_, [](double, double) { return kGround_m; }};
    }
    [[nodiscard]] Simulation simulation(double radius_m = 3,
                                        std::size_t bytes = 64ull << 20) const {
        return Simulation(world_.set, world_.frame.wind.response, {{radius_m, bytes}, kStep_s});
    }
    [[nodiscard]] Simulation::Inputs inputs(wind::Wind& wind, const blades::Colliders& colliders,
                                            glm::dvec3 eye = kEye) const {
        return {wind, world_.surface, colliders, eye, world_.anchor, 0, 0, nullptr};
    }
    static scene::WindSpec calm() {
        scene::WindSpec spec;
        spec.speed_mps = 0;
        spec.gust = 0;
        return spec;
    }
    [[nodiscard]] static std::vector<vec4> states_of(const Simulation& simulation) {
        const auto& pages = simulation.pages();
        return simulation.pass().states().read_all<vec4>(
            pages.slots().size() * static_cast<std::size_t>(pages.order().patches_a_page) *
            CULL_GROUP);
    }
    struct One {
        std::size_t at; ///< of its state
        shared::BladeRecord blade;
        vec3 root; ///< anchor-relative
        std::size_t patch;
    };
    /// Every blade that has a state.
    [[nodiscard]] std::vector<One> living(const Simulation& simulation) const {
        std::vector<One> out;
        const auto& pages = simulation.pages();
        const auto stride = static_cast<std::size_t>(pages.order().patches_a_page);
        for (std::size_t slot = 0; slot < pages.slots().size(); ++slot) {
            const auto& page = pages.slots()[slot];
            if (!page.used) {
                continue;
            }
            const auto variant = static_cast<std::size_t>(page.variant);
            const std::size_t first = world_.set.variant_begin[variant],
                              end = world_.set.variant_begin[variant + 1];
            const vec2 corner(glm::dvec2(page.tile) * static_cast<double>(world_.set.side_m) -
                              glm::dvec2(world_.anchor.x, world_.anchor.z));
            for (std::size_t n = first; n < end; ++n) {
                const auto blade = shared::lay_blade(shared::tile_lie(page.tile),
                                                     world_.set.blades[pages.order().blades[n]],
                                                     world_.set.side_m);
                const vec2 xz = corner + vec2(blade.root);
                const std::size_t patch = slot * stride + (n - first) / CULL_GROUP;
                out.push_back({patch * CULL_GROUP + (n - first) % CULL_GROUP,
                               blade,
                               {xz.x, static_cast<float>(kGround_m - world_.anchor.y), xz.y},
                               patch});
            }
        }
        return out;
    }

    SmallWorld world_;
};

TEST_F(NearPhysics, PackedMeshesTurnWithTheirObjects) {
    packed_["barn.glb"].spheres = {{1, 0.3f, -2, 0.5f}, {0, 1, 0, 0.25f}};
    scene::Scene scene;
    scene::ObjectSpec barn;
    barn.kind = scene::ObjectKind::kMesh;
    barn.mesh = "barn.glb";
    barn.position = {10, 0, 20};
    barn.yaw_deg = 90; // its front, -z, looks east
    scene.objects = {barn};
    barn.collides = false;
    scene.objects.push_back(barn);
    const auto spheres = colliders(scene).at(1, kStep_s);
    ASSERT_EQ(spheres.size(), 2u);
    EXPECT_NEAR(glm::distance(spheres[0].centre, glm::dvec3(12, kGround_m + 0.3, 21)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(spheres[1].before, glm::dvec3(10, kGround_m + 1, 20)), 0, 1e-6);
    EXPECT_EQ(spheres[1].radius_m, 0.25);
}

TEST_F(NearPhysics, StatesEqualTheTwinOverSixHundredSteps) {
    wind::Wind wind(SmallWorld::breeze(), 0.1);
    const auto balls = colliders(ball_scene());
    Simulation simulation = this->simulation();
    simulation.advance(0, inputs(wind, balls));
    const auto all = living(simulation);
    ASSERT_GT(all.size(), 1500u);
    std::vector<vec4> twin = states_of(simulation);
    shared::BladeStep rules = shared::plain_blade_step(
        static_cast<float>(kStep_s), world_.set.canopy_m, world_.frame.wind.response);
    for (const One& one : all) { // they begin in the grouped pose
        const auto body = shared::set_blade_body(rules, one.blade, vec3(0));
        const glm::dvec2 at = world_.world({one.root.x, one.root.z});
        wind.wait();
        const vec4 begun =
            shared::grouped_state(body, vec2(wind.at(at.x, at.y, 0)), rules.response);
        ASSERT_LT(glm::distance(begun, twin[one.at]), 1e-4f * one.blade.shape.y);
    }
    double worst = 0, moved = 0, memory = 0, deepest = 0;
    for (int step = 1; step <= 600; ++step) {
        const double time_s = step * kStep_s;
        simulation.advance(time_s, inputs(wind, balls));
        wind.wait();
        const auto lists = blades::sphere_lists(simulation.pages(), world_.set.side_m, 0.3,
                                                balls.at(time_s, kStep_s), world_.anchor);
        for (const One& one : all) {
            const glm::dvec2 at = world_.world({one.root.x, one.root.z});
            std::vector<blades::StepSphere> near;
            for (std::uint32_t n = 0; n < lists.lists[2 * one.patch + 1]; ++n) {
                near.push_back(lists.spheres[lists.lists[lists.lists[2 * one.patch] + n]]);
            }
            const auto body = shared::set_blade_body(rules, one.blade, one.root);
            twin[one.at] = blades::step_blade(
                rules, body, one.root, vec2(wind.at(at.x, at.y, time_s)), near, twin[one.at]);
            vec3 v1, v2;
            shared::simulated_pose(body, twin[one.at], v1, v2);
            for (const auto& sphere : near) {
                const vec4 now(vec3(sphere.now_radius) - one.root, sphere.now_radius.w);
                if (glm::length(vec3(now)) > now.w) { // one that stands in a body cannot leave it
                    deepest = std::max<double>(deepest, shared::blade_depth(v1, v2, now) /
                                                            one.blade.shape.y);
                }
            }
        }
        if (step % 20 == 0 || step == 600) {
            const auto found = states_of(simulation);
            for (const One& one : all) {
                ASSERT_NEAR(found[one.at].w, twin[one.at].w, 1e-3f);
                const double off =
                    glm::distance(vec3(found[one.at]), vec3(twin[one.at])) / one.blade.shape.y;
                worst = std::max<double>(worst, off);
                moved =
                    std::max<double>(moved, glm::length(vec3(found[one.at])) / one.blade.shape.y);
                memory = std::max<double>(memory, found[one.at].w);
            }
            ASSERT_LT(worst, 1e-4) << "step " << step;
        }
    }
    std::printf("worst difference %.2e of a blade's length; deepest %.4f; greatest move %.2f; "
                "memory %.2f\n",
                worst, deepest, moved, memory);
    EXPECT_GT(moved, 0.5);
    EXPECT_GT(memory, 1.0);
    EXPECT_LT(deepest, 0.02);
}

TEST_F(NearPhysics, TheSameSecondGivesTheSameStateAtAnyRate) {
    const auto balls = colliders(ball_scene());
    std::vector<std::vector<vec4>> ends;
    for (const int rate : {30, 60, 144}) {
        wind::Wind wind(SmallWorld::breeze(), 0.1);
        Simulation simulation = this->simulation();
        for (int picture = 0; picture <= 2 * rate; ++picture) {
            simulation.advance(static_cast<double>(picture) / rate, inputs(wind, balls));
        }
        EXPECT_EQ(simulation.steps(), 120);
        ends.push_back(states_of(simulation));
    }
    EXPECT_EQ(ends[0], ends[1]);
    EXPECT_EQ(ends[0], ends[2]);
    float moved = 0;
    for (const vec4& state : ends[0]) {
        moved = std::max(moved, state.w);
    }
    EXPECT_GT(moved, 0.5f); // it was no empty second
}

TEST_F(NearPhysics, AStillKnowsTheTrail) {
    wind::Wind run(calm(), 0.1), leap(calm(), 0.1);
    const auto balls = colliders(ball_scene());
    Simulation all = simulation(), once = simulation();
    for (int step = 0; step <= 5 * 60; ++step) {
        all.advance(step * kStep_s, inputs(run, balls));
    }
    once.advance(5, inputs(leap, balls));
    const auto a = states_of(all), b = states_of(once);
    float moved = 0;
    for (const One& one : living(all)) {
        ASSERT_LT(glm::distance(a[one.at], b[one.at]), 1e-4f);
        moved = std::max(moved, a[one.at].w);
    }
    EXPECT_GT(moved, 0.5f);
}

TEST_F(NearPhysics, PagesComeAndGoWithTheEye) {
    wind::Wind wind(SmallWorld::breeze(), 0.1);
    const auto balls = colliders(ball_scene());
    Simulation simulation = this->simulation();
    for (int step = 0; step <= 180; ++step) {
        simulation.advance(step * kStep_s, inputs(wind, balls));
    }
    const auto before = living(simulation);
    const auto tile = simulation.pages()
                          .slots()[static_cast<std::size_t>(simulation.pages().slot_of(
                              glm::ivec2(glm::floor(glm::dvec2(71, -119) / 2.0))))]
                          .tile;
    EXPECT_GT(simulation.pages().used(), 8u);
    // Away, and back: the page is there again, its blades begin in the grouped pose.
    const glm::dvec3 far_off = kEye + glm::dvec3(15, 0, 0);
    simulation.advance(181 * kStep_s, inputs(wind, balls, far_off));
    EXPECT_EQ(simulation.pages().slot_of(tile), -1);
    const auto none = colliders({});
    simulation.advance(182 * kStep_s, inputs(wind, none));
    const int slot = simulation.pages().slot_of(tile);
    ASSERT_GE(slot, 0);
    EXPECT_GT(simulation.pages().used(), 8u);
    const auto states = states_of(simulation);
    const shared::BladeStep rules = shared::plain_blade_step(
        static_cast<float>(kStep_s), world_.set.canopy_m, world_.frame.wind.response);
    wind.wait();
    int compared = 0;
    for (const One& one : living(simulation)) {
        const glm::dvec2 at = world_.world({one.root.x, one.root.z});
        const auto body = shared::set_blade_body(rules, one.blade, vec3(0));
        const vec4 begun =
            shared::grouped_state(body, vec2(wind.at(at.x, at.y, 182 * kStep_s)), rules.response);
        ASSERT_LT(glm::distance(begun, states[one.at]), 1e-4f);
        ++compared;
    }
    EXPECT_GT(compared, 1000);
    // High over the ground there is none.
    simulation.advance(183 * kStep_s, inputs(wind, none, kEye + glm::dvec3(0, 50, 0)));
    EXPECT_EQ(simulation.pages().used(), 0u);
    EXPECT_EQ(simulation.blades(), 0u);
}

TEST_F(NearPhysics, ThePoolHasABound) {
    wind::Wind wind(calm(), 0.1);
    const auto none = colliders({});
    const std::size_t page =
        static_cast<std::size_t>(blades::MortonOrder(world_.set).patches_a_page) * CULL_GROUP *
        sizeof(vec4);
    Simulation simulation = this->simulation(6, 5 * page + 1);
    simulation.advance(0, inputs(wind, none));
    EXPECT_EQ(simulation.pages().used(), 5u);
    EXPECT_LT(simulation.pages().reach_m(), 4);
    EXPECT_GE(simulation.pages().slot_of(glm::ivec2(glm::floor(glm::dvec2(kEye.x, kEye.z) / 2.0))),
              0); // the nearest have them
    EXPECT_LE(simulation.pass().bytes(), world_.set.blades.size() * 96 + 5 * page + 4096);
}

TEST_F(NearPhysics, PatchesAtRestAreNotDispatched) {
    wind::Wind wind(calm(), 0.1);
    auto balls = colliders({});
    Simulation simulation = this->simulation();
    const auto run = [&](int from, int to) {
        simulation.pass().begin_count();
        for (int step = from; step <= to; ++step) {
            simulation.advance(step * kStep_s, inputs(wind, balls));
        }
        return simulation.pass().stepped_patches();
    };
    const std::uint64_t start = run(0, 5);
    EXPECT_GT(start, 20u); // set up, and looked at once
    EXPECT_EQ(run(6, 30), 0u);
    // A ball wakes the patches that it touches, for as long as they remember it.
    const std::size_t patches = living(simulation).size() / CULL_GROUP;
    balls.set_host_spheres({{{70, kGround_m + 0.2, -121}, 0.2}}, 30 * kStep_s);
    const std::uint64_t woken = run(31, 60);
    EXPECT_GE(woken, 30u);
    EXPECT_LT(woken, 30 * patches / 2);
    balls.set_host_spheres({}, 61 * kStep_s);
    EXPECT_GT(run(61, 61 + 60), 0u);
    run(122, 122 + 20 * 60);
    EXPECT_EQ(run(1323, 1400), 0u); // risen, and asleep
    const auto states = states_of(simulation);
    for (const One& one : living(simulation)) {
        ASSERT_LT(glm::length(states[one.at]), 1e-4f);
    }
}

TEST_F(NearPhysics, EachPatchIsInTheListOfWhatItMeets) {
    wind::Wind wind(SmallWorld::breeze(), 0.1);
    auto balls = colliders({});
    Simulation simulation = this->simulation();
    const auto listed = [&](std::uint32_t list) {
        const auto found = simulation.pass().listed(list);
        const std::set<std::uint32_t> once(found.begin(), found.end());
        EXPECT_EQ(once.size(), found.size());
        return once;
    };
    simulation.advance(0, inputs(wind, balls));
    std::set<std::uint32_t> all;
    for (const One& one : living(simulation)) {
        all.insert(static_cast<std::uint32_t>(one.patch));
    }
    EXPECT_EQ(listed(shared::kListNew), all);
    EXPECT_TRUE(listed(shared::kListFree).empty());
    EXPECT_TRUE(listed(shared::kListColliding).empty());
    // A ball; and a step to the side, so that pages come and go.
    balls.set_host_spheres({{{70, kGround_m + 0.2, -121}, 0.2}}, kStep_s);
    const glm::dvec3 eye = kEye + glm::dvec3(2, 0, 0);
    simulation.advance(kStep_s, inputs(wind, balls, eye));
    const auto lists = blades::sphere_lists(simulation.pages(), world_.set.side_m, 0.3,
                                            balls.at(kStep_s, kStep_s), world_.anchor);
    const auto begun = listed(shared::kListNew), met = listed(shared::kListColliding),
               free = listed(shared::kListFree);
    std::set<std::uint32_t> patches;
    for (const One& one : living(simulation)) {
        const auto patch = static_cast<std::uint32_t>(one.patch);
        patches.insert(patch);
        EXPECT_EQ(begun.contains(patch) + met.contains(patch) + free.contains(patch), 1)
            << patch; // the wind blows: all are awake
        if (!begun.contains(patch)) {
            EXPECT_EQ(met.contains(patch), lists.lists[2 * one.patch + 1] > 0) << patch;
        }
    }
    EXPECT_EQ(begun.size() + met.size() + free.size(), patches.size());
    EXPECT_FALSE(begun.empty());
    EXPECT_FALSE(met.empty());
    EXPECT_FALSE(free.empty());
}

TEST_F(NearPhysics, OneProgramForAllGivesTheSameBits) {
    wind::Wind wind(SmallWorld::breeze(), 0.1);
    const auto balls = colliders(ball_scene());
    Simulation three = simulation(), one(world_.set, world_.frame.wind.response,
                                         {{3, 64ull << 20}, kStep_s, blades::StepPrograms::kOne});
    for (int step = 0; step <= 90; ++step) {
        three.advance(step * kStep_s, inputs(wind, balls));
        one.advance(step * kStep_s, inputs(wind, balls));
    }
    EXPECT_EQ(states_of(three), states_of(one));
    EXPECT_EQ(three.pass().stepped_patches(), one.pass().stepped_patches());
}

/// Times a run of steps on what draws here, which in software is the work; best of three.
double milliseconds_a_step(Simulation& simulation, const Simulation::Inputs& inputs, int first,
                           int steps) {
    double best = 1e30;
    for (int run = 0; run < 3; ++run) {
        glFinish();
        const auto start = std::chrono::steady_clock::now();
        for (int step = 0; step < steps; ++step) {
            simulation.advance((first + steps * run + step) * kStep_s, inputs);
        }
        glFinish();
        best = std::min(best, std::chrono::duration<double, std::milli>(
                                  std::chrono::steady_clock::now() - start)
                                      .count() /
                                  steps);
    }
    return best;
}

TEST_F(NearPhysics, AThousandSpheresCostLittleAndTenThousandWork) {
    wind::Wind wind(SmallWorld::breeze(), 0.1);
    auto balls = colliders({});
    Simulation simulation = this->simulation(10);
    simulation.advance(0, inputs(wind, balls));
    const auto all = living(simulation);
    const double none_ms = milliseconds_a_step(simulation, inputs(wind, balls), 1, 10);
    std::printf("%zu blades: %.2f ms a step without colliders\n", all.size(), none_ms);
    int first = 31;
    for (const int count : {1000, 10000}) {
        std::vector<HostSphere>
            spheres; // a body as packing makes one: many overlapping, over the grass around the eye
        const int side = static_cast<int>(std::sqrt(count / 4));
        for (int n = 0; n < count; ++n) {
            const int column = n / 4 % side, row = n / 4 / side;
            spheres.push_back({{kEye.x + 6.0 * column / side - 3, kGround_m + 0.1 + 0.12 * (n % 4),
                                kEye.z + 3.0 * row / side - 4},
                               0.1});
        }
        balls.set_host_spheres(spheres, first * kStep_s);
        simulation.advance(first * kStep_s, inputs(wind, balls));
        const double ms =
            milliseconds_a_step(simulation, inputs(wind, balls), first + 1, count > 1000 ? 1 : 5);
        const double pairs_a_patch = static_cast<double>(simulation.sphere_pairs()) * CULL_GROUP /
                                     static_cast<double>(all.size());
        std::printf("%d spheres: %.2f ms a step, %.2f times; %.2f spheres a patch\n", count, ms,
                    ms / none_ms, pairs_a_patch);
        // The work that a broad phase leaves: each patch is tested against a few of them, not all.
        EXPECT_LT(pairs_a_patch, 0.05 * count);
        float memory = 0;
        for (const vec4& state : states_of(simulation)) {
            ASSERT_TRUE(std::isfinite(glm::dot(state, state)));
            memory = std::max(memory, state.w);
        }
        EXPECT_GT(memory, 0.0f);
        first += 16;
    }
}

TEST_F(NearPhysics, CollidersThatCannotBeAreRefused) {
    auto balls = colliders({});
    const double nan = std::nan("");
    for (const HostSphere& bad : {HostSphere{{0, 0, 0}, -1}, HostSphere{{0, 0, 0}, 0},
                                  HostSphere{{0, 0, 0}, nan}, HostSphere{{nan, 0, 0}, 1}}) {
        EXPECT_THROW(balls.set_host_spheres({bad}, 0), base::Error);
    }
    EXPECT_FALSE(balls.any()); // none of them entered
    scene::Scene scene;
    scene::ObjectSpec object;
    object.kind = scene::ObjectKind::kSphere;
    object.radius_m = -0.5;
    scene.objects = {object};
    EXPECT_THROW(colliders(scene), base::Error);
}

} // namespace
} // namespace sward::tests
