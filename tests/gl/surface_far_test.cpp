// SPDX-License-Identifier: Apache-2.0
// The far field over a mesh: on a level sheet it is the field's own, a ball has it all around,
// walls where grass ends, hair beyond the outline.
#include <cmath>
#include <functional>

#include "gl/fixture.h"
#include "render/renderer.h"
#include "shells/surface_canopy.h"

namespace sward::tests {
namespace {

using render::FrameSettings;
using render::Renderer;
using render::Tiers;

scene::Mesh level_sheet(float half) {
    scene::Mesh mesh;
    mesh.positions = {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}};
    mesh.normals.assign(4, glm::vec3(0, 1, 0));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

scene::Mesh ball(float radius) {
    scene::Mesh mesh;
    constexpr std::uint32_t kRings = 48, kColumns = 2 * kRings;
    for (std::uint32_t j = 0; j <= kRings; ++j) {
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const double polar = 3.14159265358979 * j / kRings,
                         around = 3.14159265358979 * i / kRings;
            const double level =
                j % kRings == 0 ? 0 : std::sin(polar); // the poles are one place each
            const glm::vec3 out(level * std::cos(around), std::cos(polar),
                                level * std::sin(around));
            mesh.positions.push_back(radius * out);
            mesh.normals.push_back(out);
        }
    }
    for (std::uint32_t j = 0; j < kRings; ++j) {
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const std::uint32_t at = j * kColumns + i, next = j * kColumns + (i + 1) % kColumns;
            mesh.triangles.push_back({at, next, at + kColumns});
            mesh.triangles.push_back({next, next + kColumns, at + kColumns});
        }
    }
    return mesh;
}

render::World calm_world() {
    render::World world;
    world.scene.terrain.detail_m = 0;
    world.scene.wind.speed_mps = 0;
    world.scene.wind.gust = 0;
    world.grass = synthetic_set();
    return world;
}

render::World mesh_world(scene::Mesh mesh) {
    render::World world = calm_world();
    world.scene.terrain.surface = "mesh.glb";
    world.surface = std::move(mesh);
    return world;
}

/// One AOV, and the pixels' shares of it.
scene::Image aov(Renderer& renderer, const char* name, glm::dvec3 position, double pitch_deg,
                 Tiers tiers = Tiers::kShells) {
    FrameSettings settings;
    settings.width = 128;
    settings.height = 96;
    settings.aov = true;
    settings.tiers = tiers;
    scene::Pose pose;
    pose.position = position;
    pose.pitch_deg = pitch_deg;
    pose.agl = false;
    pose.fov_deg = 40;
    renderer.draw({pose, pose, 0, 0}, settings);
    return renderer.read_aovs({name});
}

class SurfaceFar : public GlTest {};

TEST_F(SurfaceFar, ALevelSheetIsTheField) {
    render::World field = calm_world();
    field.elevation = flat_field(0);
    field.mask = even_mask(1);
    Renderer flat(std::move(field)), sheet(mesh_world(level_sheet(30)));
    for (const double pitch : {-89.0, -45.0, -32.0}) {
        const glm::dvec3 eye(0.3, 4, pitch < -80 ? 0 : pitch < -40 ? 4 : 6);
        const scene::Image a = aov(flat, "coverage", eye, pitch),
                           b = aov(sheet, "coverage", eye, pitch);
        double sum = 0, worst = 0, covered = 0;
        for (std::size_t i = 0; i < a.texels.size(); ++i) {
            sum += std::abs(a.texels[i] - b.texels[i]);
            worst = std::max<double>(worst, std::abs(a.texels[i] - b.texels[i]));
            covered += b.texels[i];
        }
        const auto count = static_cast<double>(a.texels.size());
        EXPECT_LT(sum / count, 4e-3) << pitch;
        EXPECT_LT(worst, 0.07) << pitch; // the field's patch lies otherwise than the sheet's
        EXPECT_GT(covered / count, 0.3) << pitch;
    }
}

TEST_F(SurfaceFar, ABallHasHairBeyondItsOutline) {
    render::World world = mesh_world(ball(2));
    // As texgen would have it: what covers more by standing side by side (march_beside) is fewer
    // blades.
    for (std::size_t i = 0; i < world.grass.march.correction.size(); i += 2) {
        world.grass.march.correction[i] *= 0.6f;
    }
    Renderer renderer(std::move(world));
    const scene::Image image = aov(renderer, "coverage", {0, 0, 8}, 0);
    const double pixel = 2 * std::tan(0.5 * 40 * 3.14159265 / 180) / 96;
    double rim = 0, rims = 0;
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 128; ++x) {
            const double out =
                std::hypot(x - 63.5, y - 47.5) * pixel; // tangent of the angle off the axis
            const double near =
                8 * out / std::sqrt(1 + out * out); // the ray's distance from the middle
            const float coverage = image.texels[static_cast<std::size_t>(y * 128 + x)];
            if (near > 2.32) { // the canopy is 0.28 m
                EXPECT_EQ(coverage, 0) << x << ' ' << y;
            } else if (near < 1.9) {
                EXPECT_GT(coverage, 0.2) << x << ' ' << y;
            } else if (near > 2.03 && near < 2.15) {
                EXPECT_GT(coverage, 0.6)
                    << x << ' ' << y; // long ways through the layer, nothing behind
            } else if (near > 2.24 && near < 2.27) {
                rim += coverage;
                ++rims;
            }
        }
    }
    EXPECT_GT(rim / rims, 0.1);
    EXPECT_LT(rim / rims, 0.95);
}

TEST_F(SurfaceFar, BladesHandOver) {
    render::World world = mesh_world(ball(2));
    world.scene.lod.handover_start_m = 4;
    world.scene.lod.handover_end_m = 7;
    Renderer renderer(std::move(world));
    const auto blades = [&](double z) {
        aov(renderer, "tier", {0, 0, z}, 0, Tiers::kAll);
        return renderer.stats().blades_drawn;
    };
    const std::uint64_t near = blades(4), band = blades(7.2), far = blades(9.5);
    EXPECT_GT(near, band);
    EXPECT_GT(band, 0u);
    EXPECT_EQ(far, 0u);
    EXPECT_GT(renderer.stats().shell_fragments + renderer.stats().slice_fragments, 1000u);
}

TEST(SurfaceCanopy, KnowsCurvatureAndRims) {
    for (const shells::CanopyVertex& v : shells::canopy_over(ball(2), 180)) {
        EXPECT_EQ(v.chart_lift.y, 2.0f); // closed: no walls
        const glm::vec3 n = glm::normalize(v.position);
        if (std::abs(n.y) > 0.95f) {
            continue; // slivers
        }
        const glm::mat3 shape({v.curve_squares.x, v.curve_products.z, v.curve_products.y},
                              {v.curve_products.z, v.curve_squares.y, v.curve_products.x},
                              {v.curve_products.y, v.curve_products.x, v.curve_squares.z});
        const glm::vec3 along = glm::normalize(glm::cross(n, glm::vec3(0.3f, 0.8f, 0.5f)));
        EXPECT_NEAR(glm::dot(along, shape * along), 0.5, 0.02);
    }
    const auto sheet = shells::canopy_over(level_sheet(3), 180);
    EXPECT_EQ(sheet.size(), 6u + 4 * 6);                // its top, and a wall a side
    for (std::size_t i = 6; i < sheet.size(); i += 6) { // which face outwards
        const auto place = [&](std::size_t k) {
            return sheet[i + k].position +
                   sheet[i + k].normal * std::min(sheet[i + k].chart_lift.y, 1.0f);
        };
        EXPECT_GT(glm::dot(glm::cross(place(1) - place(0), place(2) - place(0)),
                           0.5f * (place(0) + place(1))),
                  0.1f);
    }
}

} // namespace
} // namespace sward::tests
