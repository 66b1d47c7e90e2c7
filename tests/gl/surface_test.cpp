// SPDX-License-Identifier: Apache-2.0
// Scenes on a mesh: grass where the placement put it, objects on their paths, nothing of a field;
// every shape draws.
#include <cmath>
#include <map>

#include "base/error.h"
#include "blades/surface_simulation.h"
#include "gl/fixture.h"
#include "render/renderer.h"

namespace sward::tests {
namespace {

using render::FrameSettings;
using render::Renderer;

/// A square of side 2 * half at y = 0, its front up (or down).
scene::Mesh sheet(float half, bool up = true) {
    scene::Mesh mesh;
    mesh.positions = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
    mesh.normals.assign(4, glm::vec3(0, up ? 1 : -1, 0));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    for (auto& t : mesh.triangles) {
        std::swap(t[1], t[up ? 1 : 2]);
    }
    return mesh;
}

render::World mesh_world(scene::Mesh mesh) {
    render::World world;
    world.scene.terrain.surface = "sheet.glb";
    world.scene.surface_grass.density_per_m2 = 800;
    world.scene.surface_grass.species.width_m = {0.01, 0.02};
    world.surface = std::move(mesh);
    return world;
}

std::map<int, int> tiers_of(Renderer& renderer, glm::dvec3 position, double pitch_deg,
                            double time_s = 0) {
    FrameSettings settings;
    settings.width = 160;
    settings.height = 90;
    settings.aov = true;
    scene::Pose pose;
    pose.position = position;
    pose.pitch_deg = pitch_deg;
    pose.agl = false;
    renderer.draw({pose, pose, time_s, 0}, settings);
    const scene::Image image = renderer.read_aovs({"tier", "color"});
    std::map<int, int> tiers;
    for (std::size_t i = 0; i < image.texels.size(); i += image.channels.size()) {
        ++tiers[static_cast<int>(image.texels[i])];
        for (std::size_t c = 0; c < image.channels.size(); ++c) {
            EXPECT_TRUE(std::isfinite(image.texels[i + c]));
        }
    }
    return tiers;
}

class SurfaceScenes : public GlTest {};

TEST_F(SurfaceScenes, GrassStandsOnTheSideThatIsUp) {
    for (const bool up : {true, false}) {
        Renderer renderer(mesh_world(sheet(2, up)));
        auto above = tiers_of(renderer, {0, 1.5, 2.5}, -30),
             below = tiers_of(renderer, {0, -1.5, 2.5}, 30);
        EXPECT_GT(above[0], 100); // the sheet has two sides
        EXPECT_GT(below[0], 100);
        EXPECT_GT((up ? above : below)[1], 4 * (up ? below : above)[1]);
        EXPECT_GT((up ? above : below)[1], 1500);
        EXPECT_EQ(above[0] + above[1] + above[7],
                  160 * 90); // ground, blades, sky; no shells, no grouped blades
    }
}

TEST_F(SurfaceScenes, CountsAreThePlacements) {
    Renderer renderer(mesh_world(sheet(2)));
    tiers_of(renderer, {0, 12, 0.1}, -89);
    const render::FrameStats whole = renderer.stats();
    EXPECT_EQ(whole.blades_considered, 16u * 800u);
    EXPECT_EQ(whole.blades_drawn, 16u * 800u);
    tiers_of(renderer, {1.6, 0.3, 1.6}, 0); // into a corner: most is beside or behind
    const render::FrameStats part = renderer.stats();
    EXPECT_LT(part.blades_considered, whole.blades_considered);
    EXPECT_LT(part.blades_drawn, part.blades_considered);
    EXPECT_GT(part.blades_drawn, 0u);
    tiers_of(renderer, {0, 3, 5}, 60);
    EXPECT_EQ(renderer.stats().blades_drawn, 0u);
}

TEST_F(SurfaceScenes, SteepPartsAreBare) {
    render::World world = mesh_world(sheet(2));
    world.surface.positions[2].y = world.surface.positions[3].y = 4; // 45 degrees
    for (glm::vec3& n : world.surface.normals) {
        n = glm::normalize(glm::vec3(-1, 1, 0));
    }
    world.scene.surface_grass.slope_deg = 50;
    Renderer steep_enough(world);
    EXPECT_GT(tiers_of(steep_enough, {-1, 2, 5}, -10)[1], 500);
    world.scene.surface_grass.slope_deg = 40;
    EXPECT_THROW(Renderer{world}, base::Error);
}

TEST_F(SurfaceScenes, EveryShapeDraws) {
    std::map<scene::BladeShape, int> covered;
    for (const auto shape :
         {scene::BladeShape::kQuad, scene::BladeShape::kTriangle, scene::BladeShape::kQuadratic,
          scene::BladeShape::kTriangleTip, scene::BladeShape::kDandelion}) {
        render::World world = mesh_world(sheet(1));
        world.scene.surface_grass.shape = shape;
        world.scene.surface_grass.density_per_m2 = 60;
        world.scene.surface_grass.species.width_m = {0.03, 0.05};
        Renderer renderer(std::move(world));
        covered[shape] = tiers_of(renderer, {0, 0.4, 1.6}, -8)[1];
    }
    using S = scene::BladeShape;
    EXPECT_GT(covered[S::kTriangle], 200);
    EXPECT_GT(covered[S::kQuadratic], covered[S::kTriangle]); // 2/3 of the quad against 1/2
    EXPECT_GT(covered[S::kQuad], covered[S::kQuadratic]);
    EXPECT_GT(covered[S::kQuad], covered[S::kTriangleTip]);
    EXPECT_GT(covered[S::kTriangleTip], covered[S::kTriangle]);
    EXPECT_LT(covered[S::kDandelion], covered[S::kQuadratic]);
    EXPECT_GT(covered[S::kDandelion], 100);
}

TEST_F(SurfaceScenes, ObjectsFollowTheirPaths) {
    render::World world = mesh_world(sheet(2));
    world.scene.surface_grass.density_per_m2 = 1;
    world.scene.paths["p"].keys = {{0, {0, 1, 0}, 0, 0}, {2, {6, 1, 0}, 0, 0}};
    scene::ObjectSpec ball;
    ball.kind = scene::ObjectKind::kSphere;
    ball.radius_m = 0.5;
    ball.path = "p";
    scene::ObjectSpec still;
    still.kind = scene::ObjectKind::kMesh;
    still.mesh = "box.glb";
    still.position = {0, 30, 0};
    world.meshes["box.glb"] = sheet(0.5);
    world.scene.objects = {ball, still};
    Renderer renderer(std::move(world));
    // At 4 m with 60 degrees, 90 pixels: 78 / 4 pixels a metre.
    const double ball_px = 3.14159 * std::pow(0.5 * 77.9 / std::sqrt(16 - 0.25), 2);
    EXPECT_NEAR(tiers_of(renderer, {0, 1, 4}, 0, 0)[6], ball_px, 0.12 * ball_px);
    EXPECT_EQ(tiers_of(renderer, {0, 1, 4}, 0, 2)[6], 0);
    EXPECT_NEAR(tiers_of(renderer, {6, 1, 4}, 0, 2)[6], ball_px, 0.12 * ball_px);
    const int sheet_px = tiers_of(renderer, {0, 34, 0.01}, -89.9, 2)[6]; // from 4 m above
    EXPECT_NEAR(sheet_px, std::pow(77.9 / 4, 2), 0.15 * 380);
}

TEST_F(SurfaceScenes, TwoRenderersDrawTheSame) {
    Renderer a(mesh_world(sheet(2))), b(mesh_world(sheet(2)));
    FrameSettings settings;
    settings.width = 96;
    settings.height = 64;
    scene::Pose pose;
    pose.position = {0.3, 0.6, 1.8};
    pose.agl = false;
    a.draw({pose, pose, 1, 0}, settings);
    b.draw({pose, pose, 1, 0}, settings);
    b.draw({pose, pose, 1, 0}, settings);
    EXPECT_EQ(a.read_picture().rgb, b.read_picture().rgb);
}

/// A quarter of a tube of 1.5 m about the x axis, from upright over level to hanging.
scene::Mesh bent_sheet() {
    scene::Mesh mesh;
    constexpr int kRows = 24;
    for (int i = 0; i <= kRows; ++i) {
        const double angle = 2.6 * i / kRows - 0.4;
        const glm::vec3 out(0, std::cos(angle), std::sin(angle));
        for (const float x : {-1.0f, 1.0f}) {
            mesh.positions.push_back(1.5f * out + glm::vec3(x, 0, 0));
            mesh.normals.push_back(out);
        }
    }
    for (std::uint32_t i = 0; i < 2 * kRows; i += 2) {
        mesh.triangles.push_back({i, i + 2, i + 1});
        mesh.triangles.push_back({i + 1, i + 2, i + 3});
    }
    return mesh;
}

TEST_F(SurfaceScenes, LivingBladesOfAMeshEqualTheTwin) {
    const SmallWorld world(flat_field(0), 0, even_mask(1), {0, 1, 3});
    scene::SurfaceGrassSpec spec;
    spec.density_per_m2 = 300;
    spec.lean = 0.4;
    const auto grass = blades::place_surface_grass(bent_sheet(), spec, "bent.glb");
    const auto records = gl::Buffer::of(std::span<const shared::SurfaceBlade>(grass.blades));
    const double canopy = spec.species.length_m.high;
    blades::SurfaceSimulation simulation({{&records, grass.clusters}}, canopy,
                                         {{50, 64 << 20}, 1.0 / 60});
    scene::Scene scene;
    scene::ObjectSpec ball;
    ball.kind = scene::ObjectKind::kSphere;
    ball.radius_m = 0.25;
    ball.path = "over";
    scene.objects = {ball};
    scene.paths["over"].keys = {
        {0, {-0.6, 1.8, -0.6}, 0, 0}, {1.5, {0.2, 1.7, 0.4}, 0, 0}, {3, {0.6, -0.2, 1.8}, 0, 0}};
    const blades::Colliders balls(scene, {}, [](double, double) { return 0.0; });
    wind::Wind wind(SmallWorld::breeze(), 0);
    const glm::dvec3 anchor(0);
    const blades::LivingBlades::Inputs inputs{wind, world.surface, balls, {0, 1, 3}, anchor, 0,
                                              0,    nullptr};
    simulation.advance(0, inputs);
    ASSERT_EQ(simulation.blades(), grass.blades.size());
    const auto states = [&] {
        return simulation.pass().states().read_all<glm::vec4>(simulation.slots() * CULL_GROUP);
    };
    const auto place = [&](std::size_t blade) {
        return static_cast<std::size_t>(simulation.slot_of(blade / CULL_GROUP)) * CULL_GROUP +
               blade % CULL_GROUP;
    };
    std::vector<glm::vec4> twin = states();
    const auto rules = shared::plain_blade_step(1.0f / 60, static_cast<float>(canopy), 0);
    double worst = 0, moved = 0, memory = 0, under = 0;
    for (int step = 1; step <= 240; ++step) {
        simulation.advance(step / 60.0, inputs);
        wind.wait();
        const auto now = balls.at(step / 60.0, 1.0 / 60).front();
        const blades::StepSphere sphere{
            glm::vec4(glm::vec3(now.centre), static_cast<float>(now.radius_m)),
            glm::vec4(glm::vec3(now.before), 0)};
        for (std::size_t n = 0; n < grass.blades.size(); ++n) {
            const glm::vec3 root(grass.blades[n].root_direction);
            const auto body = shared::surface_blade_body(rules, grass.blades[n], root);
            glm::vec4& state = twin[place(n)];
            state = blades::step_blade(rules, body, root,
                                       glm::vec2(wind.at(root.x, root.z, step / 60.0)),
                                       {&sphere, 1}, state);
            under = std::max<double>(under, -glm::dot(body.calm2 + glm::vec3(state), body.up) /
                                                body.stem_canopy.x);
        }
        if (step % 40 == 0) {
            const auto found = states();
            for (std::size_t n = 0; n < grass.blades.size(); ++n) {
                const double length = grass.blades[n].v1_height.w;
                worst = std::max<double>(
                    worst,
                    glm::distance(glm::vec3(found[place(n)]), glm::vec3(twin[place(n)])) / length);
                moved = std::max<double>(moved, glm::length(glm::vec3(found[place(n)])) / length);
                memory = std::max<double>(memory, found[place(n)].w);
            }
        }
    }
    std::printf("%zu blades: worst %.2e of a length; greatest move %.2f; memory %.2f; under %.1e\n",
                grass.blades.size(), worst, moved, memory, under);
    EXPECT_LT(worst, 1e-4);
    EXPECT_GT(moved, 0.5);
    EXPECT_GT(memory, 1.0);
    EXPECT_LT(under, 1e-4);
}

TEST_F(SurfaceScenes, ThePoolOfAMeshHasABound) {
    const auto draw = [](std::size_t bytes, double radius_m) {
        Renderer renderer(mesh_world(sheet(2)));
        FrameSettings settings;
        settings.width = 64;
        settings.height = 48;
        settings.most_simulated_bytes = bytes;
        settings.simulated_radius_m = radius_m;
        scene::Pose pose;
        pose.position = {1.5, 1, 1.5};
        pose.agl = false;
        renderer.draw({pose, pose, 1, 0}, settings);
        return renderer.stats().blades_simulated;
    };
    EXPECT_EQ(draw(1 << 20, 20), 16u * 800u);
    EXPECT_EQ(draw(5 * CULL_GROUP * 16 + 1, 20), 5u * CULL_GROUP);
    const std::uint64_t near = draw(1 << 20, 1.5);
    EXPECT_GT(near, 1000u);
    EXPECT_LT(near, 6000u);
}

TEST_F(SurfaceScenes, ReloadKeepsDrawing) {
    Renderer renderer(mesh_world(sheet(2)));
    const auto before = tiers_of(renderer, {0, 1, 2}, -20);
    EXPECT_TRUE(renderer.reload_shaders().empty());
    EXPECT_EQ(tiers_of(renderer, {0, 1, 2}, -20), before);
}

} // namespace
} // namespace sward::tests
