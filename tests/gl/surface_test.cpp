// SPDX-License-Identifier: Apache-2.0
// Scenes on a mesh: grass where the placement put it, objects on their paths, nothing of a field; every shape draws.
#include <cmath>
#include <map>

#include "base/error.h"
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
    world.scene.surface_grass.blade_width_m = {0.01, 0.02};
    world.surface = std::move(mesh);
    return world;
}

std::map<int, int> tiers_of(Renderer& renderer, glm::dvec3 position, double pitch_deg, double time_s = 0) {
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
        auto above = tiers_of(renderer, {0, 1.5, 2.5}, -30), below = tiers_of(renderer, {0, -1.5, 2.5}, 30);
        EXPECT_GT(above[0], 100); // the sheet has two sides
        EXPECT_GT(below[0], 100);
        EXPECT_GT((up ? above : below)[1], 4 * (up ? below : above)[1]);
        EXPECT_GT((up ? above : below)[1], 1500);
        EXPECT_EQ(above[0] + above[1] + above[7], 160 * 90); // ground, blades, sky; no shells, no grouped blades
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
    for (const auto shape : {scene::BladeShape::kQuad, scene::BladeShape::kTriangle, scene::BladeShape::kQuadratic, scene::BladeShape::kTriangleTip,
                             scene::BladeShape::kDandelion}) {
        render::World world = mesh_world(sheet(1));
        world.scene.surface_grass.shape = shape;
        world.scene.surface_grass.density_per_m2 = 60;
        world.scene.surface_grass.blade_width_m = {0.03, 0.05};
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
    ball.kind = "sphere";
    ball.radius_m = 0.5;
    ball.path = "p";
    scene::ObjectSpec still;
    still.kind = "mesh";
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

TEST_F(SurfaceScenes, ReloadKeepsDrawing) {
    Renderer renderer(mesh_world(sheet(2)));
    const auto before = tiers_of(renderer, {0, 1, 2}, -20);
    EXPECT_TRUE(renderer.reload_shaders().empty());
    EXPECT_EQ(tiers_of(renderer, {0, 1, 2}, -20), before);
}

} // namespace
} // namespace sward::tests
