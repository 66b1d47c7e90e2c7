// SPDX-License-Identifier: Apache-2.0
// A grass set on a mesh: charts, as many blades as the set has a square metre whatever way the
// surface faces, each in its own pose.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/hash.h"
#include "blades/surface_placement.h"
#include "shared/blade.h"
#include "shared/surface_chart.h"

namespace sward::blades {
namespace {

float unit(std::uint64_t n, std::uint64_t salt) {
    return static_cast<float>(base::hash_unit(7, n, salt));
}

/// Two variants of a patch of 0.5 m, 900 blades each: two species, which lean any way.
grass::GrassSet small_set() {
    grass::GrassSet set;
    set.side_m = 0.5f;
    set.canopy_m = 0.1f;
    set.variants = 2;
    set.density_per_m2 = 3600;
    set.species.resize(2);
    for (std::uint64_t n = 0; n < 1800; ++n) {
        if (n % 900 == 0) {
            set.variant_begin.push_back(static_cast<std::uint32_t>(n));
        }
        const float azimuth = 6.2831853f * unit(n, 2),
                    rank = (std::floor(256.0f * static_cast<float>(n % 900) / 900) + 0.5f) / 256;
        const glm::vec3 way(std::cos(azimuth), 0, std::sin(azimuth)),
            v1 = glm::vec3(0, 0.05f, 0), v2 = v1 + 0.02f * way + glm::vec3(0, 0.03f, 0);
        set.blades.push_back({{0.5f * unit(n, 0), 0.5f * unit(n, 1), rank,
                               (std::floor(256 * unit(n, 3)) + 0.5f) / 256},
                              glm::vec4(v1, 0.001f),
                              glm::vec4(v2, 0.5f),
                              {6.2831853f * unit(n, 4), 0.09f, 0, n % 3 == 0 ? 1.0f : 0.0f}});
    }
    set.variant_begin.push_back(1800);
    return set;
}

/// A ball, or the part of one that leans at most so far.
scene::Mesh ball(float radius, int rings) {
    scene::Mesh mesh;
    const auto columns = static_cast<std::uint32_t>(2 * rings);
    for (int j = 0; j <= rings; ++j) {
        for (std::uint32_t i = 0; i <= columns; ++i) {
            const double polar = 3.14159265358979 * j / rings,
                         around = 3.14159265358979 * (i % columns) / rings;
            const glm::vec3 out(std::sin(polar) * std::cos(around), std::cos(polar),
                                std::sin(polar) * std::sin(around));
            mesh.positions.push_back(radius * out);
            mesh.normals.push_back(out);
        }
    }
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(rings); ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            const std::uint32_t at = j * (columns + 1) + i, below = at + columns + 1;
            mesh.triangles.push_back({at, at + 1, below});
            mesh.triangles.push_back({at + 1, below + 1, below});
        }
    }
    return mesh;
}

TEST(SurfaceSet, ChartsFaceAllWays) {
    for (std::uint64_t n = 0; n < 5000; ++n) {
        const float y = 2 * unit(n, 8) - 1, a = 6.2831853f * unit(n, 9), r = std::sqrt(1 - y * y);
        const glm::vec3 up(r * std::cos(a), y, r * std::sin(a));
        const int chart = shared::chart_of(up);
        EXPECT_GT(glm::dot(shared::chart_up(chart), up), 0.887f); // 27.5 degrees
        const shared::SurfaceFrame frame = shared::surface_frame(chart, up);
        EXPECT_NEAR(glm::dot(glm::cross(frame.east, frame.up), frame.south), 1, 1e-5);
        EXPECT_LT(glm::length(shared::from_surface(frame, shared::to_surface(frame, up)) - up),
                  1e-5f);
    }
    const int level = shared::chart_of({0, 1, 0}); // level ground: the world's own axes
    EXPECT_EQ(shared::chart_place(level, {3, 8, -2}), glm::vec2(3, -2));
}

TEST(SurfaceSet, AsManyBladesAsTheSetHas) {
    const grass::GrassSet set = small_set();
    const scene::Mesh mesh = ball(1.5f, 48);
    const SurfaceBlades whole = place_set_on_surface(mesh, {set, 1, 180}, "ball.glb");
    const double wanted = whole.area_m2 * set.density_per_m2;
    EXPECT_NEAR(static_cast<double>(whole.blades.size()), wanted, 0.01 * wanted);
    // Every eighth of the ball likewise: what a chart lacks is made up for.
    std::array<double, 8> parts{};
    for (const shared::SurfaceBlade& blade : whole.blades) {
        const glm::vec4 at = blade.root_direction;
        ++parts[static_cast<std::size_t>((at.x > 0) + 2 * (at.y > 0) + 4 * (at.z > 0))];
    }
    for (const double part : parts) {
        EXPECT_NEAR(part, wanted / 8, 0.03 * wanted / 8);
    }
    const SurfaceBlades half = place_set_on_surface(mesh, {set, 0.5, 180}, "ball.glb");
    EXPECT_NEAR(static_cast<double>(half.blades.size()), 0.5 * wanted, 0.04 * wanted);
    const SurfaceBlades again = place_set_on_surface(mesh, {set, 1, 180}, "ball.glb");
    ASSERT_EQ(again.blades.size(), whole.blades.size());
    EXPECT_EQ(std::memcmp(again.blades.data(), whole.blades.data(),
                          whole.blades.size() * sizeof(shared::SurfaceBlade)),
              0);
}

TEST(SurfaceSet, BladesStandAsTheSetHasThem) {
    const grass::GrassSet set = small_set();
    double second = 0;
    const SurfaceBlades grass = place_set_on_surface(ball(1.5f, 48), {set, 1, 180}, "ball.glb");
    for (const shared::SurfaceBlade& blade : grass.blades) {
        const glm::vec3 root(blade.root_direction), up(blade.up_stiffness), v1(blade.v1_height),
            v2(blade.v2_width);
        EXPECT_NEAR(glm::length(root), 1.5, 0.004);
        EXPECT_GT(glm::dot(up, glm::normalize(root)), 0.999f);
        EXPECT_NEAR(glm::dot(v1, up), 0.05, 1e-5);
        EXPECT_NEAR(glm::dot(v2, up), 0.08, 1e-5);
        EXPECT_NEAR(glm::length(v2 - v1), std::hypot(0.02, 0.03), 1e-5);
        second += std::floor(blade.root_direction.w / (2 * shared::kPi));
    }
    EXPECT_NEAR(second / static_cast<double>(grass.blades.size()), 1.0 / 3, 0.01);
}

TEST(SurfaceSet, SteepPartsAndTooMuchAreRefused) {
    const grass::GrassSet set = small_set();
    const SurfaceBlades cap = place_set_on_surface(ball(1.5f, 48), {set, 1, 60}, "ball.glb");
    EXPECT_NEAR(cap.area_m2, 2 * 3.14159 * 1.5 * 0.75, 0.3); // a cap: 2 pi r h
    for (const shared::SurfaceBlade& blade : cap.blades) {
        EXPECT_GT(blade.root_direction.y, 0.7f);
    }
    EXPECT_THROW(static_cast<void>(place_set_on_surface(ball(1000, 8), {set, 1, 180}, "ball.glb")),
                 base::Error);
    EXPECT_THROW(static_cast<void>(place_set_on_surface(scene::Mesh(), {set, 1, 180}, "ball.glb")),
                 base::Error);
}

} // namespace
} // namespace sward::blades
