// SPDX-License-Identifier: Apache-2.0
// Meshes packed with spheres: inside, and how much of it they fill; meshes without an inside.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "assets/assets.h"
#include "assets/sphere_packing.h"
#include "base/error.h"

namespace sward::assets {
namespace {

scene::Mesh box(glm::vec3 half) {
    scene::Mesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(half * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    mesh.normals.assign(8, glm::vec3(0, 1, 0));
    for (const auto& q : {std::array<std::uint32_t, 4>{0, 4, 6, 2},
                          {1, 3, 7, 5},
                          {0, 1, 5, 4},
                          {2, 6, 7, 3},
                          {0, 2, 3, 1},
                          {4, 5, 7, 6}}) {
        mesh.triangles.push_back({q[0], q[1], q[2]});
        mesh.triangles.push_back({q[0], q[2], q[3]});
    }
    return mesh;
}

std::string error_of(const scene::Mesh& mesh, base::ExitCode code = base::ExitCode::kBadInput) {
    try {
        (void)pack_spheres(mesh, {}, "m.glb");
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), code);
        return error.what();
    }
    return "no error";
}

/// Share of `samples` places of a box, those inside the mesh by `inside`, that a ball holds.
double covered(const scene::SphereSet& set, glm::vec3 low, glm::vec3 high,
               const std::function<bool(glm::vec3)>& inside) {
    constexpr int n = 40;
    int within = 0, held = 0;
    for (int i = 0; i < n * n * n; ++i) {
        const glm::vec3 p = low + (high - low) * (glm::vec3(i % n, i / n % n, i / (n * n)) + 0.5f) /
                                      static_cast<float>(n);
        if (!inside(p))
            continue;
        ++within;
        for (const glm::vec4& ball : set.spheres)
            if (glm::distance(p, glm::vec3(ball)) < ball.w) {
                ++held;
                break;
            }
    }
    return static_cast<double>(held) / within;
}

TEST(SpherePacking, BallsOfABoxStayInsideAndFillIt) {
    const glm::vec3 half(1.0f, 0.4f, 0.6f);
    const float cell = 2.0f / 96;
    const scene::SphereSet set = pack_spheres(box(half), {}, "m.glb");
    EXPECT_LE(set.spheres.size(), 256u);
    EXPECT_GT(set.spheres.size(), 50u);
    for (const glm::vec4& ball : set.spheres) {
        for (int k = 0; k < 3; ++k)
            EXPECT_LE(std::abs(ball[k]) + ball.w, half[k] + 1.01f * cell);
        EXPECT_GE(ball.w, 0.99f * cell);
    }
    EXPECT_NEAR(set.spheres[0].w, 0.4f, 2 * cell); // the greatest that fits
    const auto everywhere = [](glm::vec3) { return true; };
    EXPECT_GT(covered(set, -half, half, everywhere), 0.85);
    PackingSettings few;
    few.most_spheres = 8;
    const scene::SphereSet eight = pack_spheres(box(half), few, "m.glb");
    EXPECT_LE(eight.spheres.size(), 8u);
    EXPECT_LT(covered(eight, -half, half, everywhere), covered(set, -half, half, everywhere));
}

TEST(SpherePacking, PlacesAndSizesFollowTheMesh) {
    scene::Mesh far = box({0.1f, 0.1f, 0.1f});
    for (glm::vec3& p : far.positions)
        p += glm::vec3(500, -20, 3000);
    for (const glm::vec4& ball : pack_spheres(far, {}, "m.glb").spheres) {
        const glm::vec3 off = glm::abs(glm::vec3(ball) - glm::vec3(500, -20, 3000));
        EXPECT_LE(std::max({off.x, off.y, off.z}) + ball.w,
                  0.1f + 0.2f / 96 + 3e-4f); // a float is that coarse there
    }
}

TEST(SpherePacking, ShippedMeshesAreFilled) {
    const scene::Mesh animal =
        load_mesh(std::filesystem::path(SWARD_SOURCE_DIR) / "terrains/fur/animal.glb");
    const scene::SphereSet set = pack_spheres(animal, {}, "animal.glb");
    float deepest = 0;
    for (const glm::vec4& ball : set.spheres) { // no vertex of the mesh is well inside a ball
        for (const glm::vec3 p : animal.positions)
            deepest = std::max(deepest, ball.w - glm::distance(p, glm::vec3(ball)));
    }
    EXPECT_LT(deepest, 2.6f / 96);
    EXPECT_GT(set.spheres.size(), 100u);
    EXPECT_GT(
        covered(set, {-0.12f, 0.85f, -0.5f}, {0.12f, 1.1f, 0.5f}, [](glm::vec3) { return true; }),
        0.97); // of its trunk
    float low = 9;
    for (const glm::vec4& ball : set.spheres)
        low = std::min(low, ball.y - ball.w);
    EXPECT_LT(low, 0.12f); // down to the feet
}

TEST(SpherePacking, MeshesWithoutAnInsideAreRefused) {
    scene::Mesh open = box({1, 1, 1});
    open.triangles.pop_back();
    EXPECT_NE(error_of(open).find("m.glb: mesh to be packed with spheres: found a rim"),
              std::string::npos)
        << error_of(open);
    scene::Mesh turned = box({1, 1, 1});
    std::swap(turned.triangles[3][0], turned.triangles[3][1]);
    EXPECT_NE(error_of(turned).find("found a rim"), std::string::npos);
    scene::Mesh flat = box({1, 0, 1});
    EXPECT_NE(error_of(flat).find("found no volume"), std::string::npos) << error_of(flat);
    EXPECT_NE(error_of(box({1, 0.002f, 1})).find("found no inside"), std::string::npos)
        << error_of(box({1, 0.002f, 1}));
    EXPECT_NE(error_of({}).find("found no triangles"), std::string::npos);
    scene::Mesh many = box({1, 1, 1});
    many.triangles.resize(kMostPackedTriangles + 1, many.triangles[0]);
    EXPECT_NE(error_of(many, base::ExitCode::kOverLimit)
                  .find("2000001 triangles, expected at most 2000000"),
              std::string::npos);
    scene::Mesh apart =
        box({1, 1, 1}); // every triangle with corners of its own: closed all the same
    scene::Mesh soup;
    for (const auto& t : apart.triangles) {
        for (const std::uint32_t corner : t)
            soup.positions.push_back(apart.positions[corner]);
        const auto n = static_cast<std::uint32_t>(soup.positions.size());
        soup.triangles.push_back({n - 3, n - 2, n - 1});
    }
    soup.normals.assign(soup.positions.size(), glm::vec3(0, 1, 0));
    EXPECT_EQ(error_of(soup), "no error");
}

} // namespace
} // namespace sward::assets
