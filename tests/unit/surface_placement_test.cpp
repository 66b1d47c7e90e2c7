// SPDX-License-Identifier: Apache-2.0
// Grass on meshes: how many blades, how even, tufts apart, clusters full and compact, blades on the
// surface, meshes that are refused (J1 to J3).
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "base/error.h"
#include "blades/surface_placement.h"
#include "shared/bindings.h"
#include "shared/blade.h"

namespace sward::blades {
namespace {

using scene::Mesh;
using scene::Placement;
using scene::SurfaceGrassSpec;

void add_triangle(Mesh& mesh, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const glm::vec3 n = glm::cross(b - a, c - a);
    for (const glm::vec3 p : {a, b, c}) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(glm::length(n) > 0 ? glm::normalize(n) : glm::vec3(0, 1, 0));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
}

/// A sheet over 4 m x 2 m that rises and falls; vertices of neighbours are apart, as glTF often has
/// them.
Mesh wavy_sheet(int cells) {
    Mesh mesh;
    const auto at = [&](int i, int j) {
        const double x = 4.0 * i / cells, z = 2.0 * j / cells;
        return glm::vec3(x, 0.3 * std::sin(2 * x) * std::cos(3 * z), z);
    };
    for (int j = 0; j < cells; ++j) {
        for (int i = 0; i < cells; ++i) {
            add_triangle(mesh, at(i, j), at(i, j + 1), at(i + 1, j));
            add_triangle(mesh, at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        }
    }
    return mesh;
}

Mesh sphere(int rings) {
    Mesh mesh;
    const auto at = [&](int i, int j) {
        const double a = M_PI * j / rings, b = M_PI * i / rings;
        return glm::vec3(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
    };
    for (int j = 0; j < rings; ++j) {
        for (int i = 0; i < 2 * rings; ++i) {
            add_triangle(mesh, at(i, j), at(i + 1, j), at(i, j + 1));
            add_triangle(mesh, at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return mesh;
}

SurfaceGrassSpec spec_of(Placement placement, double density) {
    SurfaceGrassSpec spec;
    spec.placement = placement;
    spec.density_per_m2 = density;
    return spec;
}

double area_of(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        sum +=
            0.5 * glm::length(glm::cross(glm::dvec3(mesh.positions[t[1]] - mesh.positions[t[0]]),
                                         glm::dvec3(mesh.positions[t[2]] - mesh.positions[t[0]])));
    }
    return sum;
}

std::string error_of(const Mesh& mesh, const SurfaceGrassSpec& spec, base::ExitCode code) {
    try {
        (void)place_surface_grass(mesh, spec, "m.glb");
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), code);
        return error.what();
    }
    return "no error";
}

/// Distance of a point to the nearest triangle's plane among those whose prism holds it.
double off_surface(const Mesh& mesh, glm::dvec3 p) {
    double least = 1e9;
    for (const auto& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
        const glm::dvec3 n = glm::cross(b - a, c - a);
        const double nn = glm::dot(n, n);
        if (nn == 0) {
            continue;
        }
        const double v = glm::dot(glm::cross(p - a, c - a), n) / nn,
                     w = glm::dot(glm::cross(b - a, p - a), n) / nn;
        if (v >= -1e-4 && w >= -1e-4 && v + w <= 1 + 1e-4) {
            least = std::min(least, std::abs(glm::dot(p - a, n)) / std::sqrt(nn));
        }
    }
    return least;
}

TEST(SurfacePlacement, CountIsDensityTimesArea) {
    for (const Mesh& mesh : {wavy_sheet(12), sphere(12)}) {
        for (const Placement placement :
             {Placement::kSingle, Placement::kTufts, Placement::kMixed}) {
            const SurfaceBlades grass = place_surface_grass(mesh, spec_of(placement, 300), "m.glb");
            EXPECT_NEAR(grass.area_m2, area_of(mesh), 1e-9 * grass.area_m2);
            EXPECT_EQ(grass.blades.size(),
                      static_cast<std::size_t>(std::round(300 * area_of(mesh))));
        }
    }
}

TEST(SurfacePlacement, SingleBladesAreEvenByArea) {
    // Triangles of very different areas: a fan whose angles grow. Chi-square of the counts over 40
    // triangles.
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
        const double a = 0.5 * M_PI * i * i / 1600, b = 0.5 * M_PI * (i + 1) * (i + 1) / 1600;
        add_triangle(mesh, {0, 0, 0}, {std::cos(b), 0.1 * i, std::sin(b)},
                     {std::cos(a), 0.1 * i, std::sin(a)});
    }
    const SurfaceArea area(mesh, 180);
    std::vector<int> counts(40);
    constexpr int kCount = 40000;
    double mean_u = 0;
    for (int i = 0; i < kCount; ++i) {
        const auto n = static_cast<unsigned>(i);
        const glm::dvec3 u(shared::hash_to_unit(shared::hash_pcg(3 * n)),
                           shared::hash_to_unit(shared::hash_pcg(3 * n + 1)),
                           shared::hash_to_unit(shared::hash_pcg(3 * n + 2)));
        const SurfacePoint at = area.sample(u);
        ++counts[at.triangle];
        mean_u +=
            glm::distance(at.place, glm::dvec3(mesh.positions[mesh.triangles[at.triangle][0]]));
    }
    double chi = 0;
    for (std::uint32_t t = 0; t < 40; ++t) {
        const double expected = kCount * 0.5 *
                                glm::length(glm::cross(glm::dvec3(mesh.positions[3 * t + 1]),
                                                       glm::dvec3(mesh.positions[3 * t + 2]))) /
                                area.total_m2();
        chi += (counts[t] - expected) * (counts[t] - expected) / expected;
    }
    EXPECT_LT(chi, 73.4); // 39 degrees of freedom: once in a thousand
}

TEST(SurfacePlacement, WithinATriangleTheyAreEvenToo) {
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    const SurfaceBlades grass =
        place_surface_grass(mesh, spec_of(Placement::kSingle, 40000), "m.glb");
    glm::dvec3 mean(0);
    int near_corner = 0; // the quarter at the first corner
    for (const auto& blade : grass.blades) {
        mean += glm::dvec3(blade.root_direction) / static_cast<double>(grass.blades.size());
        near_corner += blade.root_direction.x + blade.root_direction.z < 0.5f;
    }
    EXPECT_NEAR(mean.x, 1.0 / 3, 0.006); // sigma 0.0017
    EXPECT_NEAR(mean.z, 1.0 / 3, 0.006);
    EXPECT_NEAR(near_corner / static_cast<double>(grass.blades.size()), 0.25, 0.012);
}

TEST(SurfacePlacement, TuftCentresKeepApart) {
    const Mesh mesh = wavy_sheet(20);
    const SurfaceArea area(mesh, 180);
    constexpr std::size_t kWanted = 2000;
    const double apart = 0.7 * std::sqrt(area.total_m2() / kWanted);
    const auto centres = tuft_centres(area, kWanted, apart, 5);
    EXPECT_EQ(centres.size(), kWanted);
    double nearest = 1e9;
    for (std::size_t i = 0; i < centres.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            nearest = std::min(nearest, glm::distance(centres[i].place, centres[j].place));
        }
    }
    EXPECT_GE(nearest, apart);
    EXPECT_LT(nearest, 1.1 * apart); // 2000 places: some pair stands nearly as close as it may
    EXPECT_LT(tuft_centres(area, kWanted, 1.5 * apart / 0.7, 5).size(), kWanted); // more do not fit
}

TEST(SurfacePlacement, BladesOfTuftsStayWithTheirCentre) {
    const Mesh mesh = wavy_sheet(20);
    SurfaceGrassSpec spec = spec_of(Placement::kTufts, 400);
    spec.species.tuft_blades = {20, 20};
    spec.species.tuft_radius_m = {0.06, 0.06};
    const SurfaceBlades grass = place_surface_grass(mesh, spec, "m.glb");
    const SurfaceArea area(mesh, 180);
    const std::size_t tufts = (grass.blades.size() + 10) / 20;
    const auto centres =
        tuft_centres(area, tufts, 0.7 * std::sqrt(area.total_m2() / static_cast<double>(tufts)), 1);
    double farthest = 0;
    for (const auto& blade : grass.blades) {
        double nearest = 1e9;
        for (const SurfacePoint& centre : centres) {
            nearest =
                std::min(nearest, glm::distance(centre.place, glm::dvec3(blade.root_direction)));
        }
        farthest = std::max(farthest, nearest);
    }
    EXPECT_LE(farthest, 0.06 + 1e-5);
    EXPECT_GT(farthest, 0.05);
}

TEST(SurfacePlacement, TuftsGatherOrSplay) {
    const Mesh mesh = wavy_sheet(20);
    SurfaceGrassSpec spec = spec_of(Placement::kTufts, 400);
    spec.species.tuft_blades = {20, 20};
    spec.droop = 0.5;
    const SurfaceArea area(mesh, 180);
    const auto spread =
        [&](double gather) { // mean of the way from tip to middle over that from root to middle
            spec.tuft_gather = gather;
            const SurfaceBlades grass = place_surface_grass(mesh, spec, "m.glb");
            const std::size_t tufts = (grass.blades.size() + 10) / 20;
            const auto centres = tuft_centres(
                area, tufts, 0.7 * std::sqrt(area.total_m2() / static_cast<double>(tufts)), 1);
            double tips = 0, roots = 0;
            for (const auto& blade : grass.blades) {
                const glm::dvec3 root(blade.root_direction), up(blade.up_stiffness);
                glm::dvec3 middle = centres[0].place;
                for (const SurfacePoint& centre : centres) {
                    middle = glm::distance(centre.place, root) < glm::distance(middle, root)
                                 ? centre.place
                                 : middle;
                }
                const auto flat = [&](glm::dvec3 v) {
                    return glm::length(v - up * glm::dot(v, up));
                };
                roots += flat(root - middle);
                tips += flat(root + glm::dvec3(blade.v2_width) - middle);
            }
            return tips / roots;
        };
    EXPECT_LT(spread(1), spread(0) - 0.3);
    EXPECT_GT(spread(-1), spread(0) + 0.3);
}

TEST(SurfacePlacement, BladesStandOnTheSurface) {
    for (const Mesh& mesh : {wavy_sheet(10), sphere(8)}) {
        const SurfaceBlades grass =
            place_surface_grass(mesh, spec_of(Placement::kMixed, 150), "m.glb");
        for (const auto& blade : grass.blades) {
            const glm::dvec3 root(blade.root_direction);
            ASSERT_LT(off_surface(mesh, root), 1e-5) << root.x << ' ' << root.y << ' ' << root.z;
            ASSERT_NEAR(glm::length(glm::vec3(blade.up_stiffness)), 1, 1e-5);
            ASSERT_GE(blade.v1_height.w, 0.15f);
            ASSERT_LE(blade.v1_height.w, 0.35f);
        }
    }
}

TEST(SurfacePlacement, AWalkGoesStraightAcrossEdgesAndEndsAtRims) {
    // A box's corner: over the edge a walk goes on down the side.
    Mesh mesh;
    add_triangle(mesh, {0, 0, 0}, {0, 0, 1}, {1, 0, 1});
    add_triangle(mesh, {0, 0, 0}, {1, 0, 1}, {1, 0, 0});
    add_triangle(mesh, {1, 0, 0}, {1, 0, 1}, {1, -1, 1});
    add_triangle(mesh, {1, 0, 0}, {1, -1, 1}, {1, -1, 0});
    SurfaceArea area(mesh, 180);
    area.link_neighbours();
    const SurfacePoint start{{0.2, 0, 0.6}, 0};
    const SurfacePoint end = area.walk(start, {1, 0, 0.0}, 1.3);
    EXPECT_NEAR(glm::distance(end.place, {1, -0.5, 0.6}), 0, 1e-9);
    const SurfacePoint rim = area.walk(start, {1, 0, 0}, 5);
    EXPECT_NEAR(glm::distance(rim.place, {1, -1, 0.6}), 0, 1e-9);
    const SurfacePoint slanted =
        area.walk(start, {1, 0, -0.25}, std::sqrt(1.0625) * 1.2); // 0.8 to the edge, 0.4 down
    EXPECT_NEAR(glm::distance(slanted.place, {1, -0.4, 0.3}), 0, 1e-9);
}

TEST(SurfacePlacement, SlopesKeepGrassOffWalls) {
    SurfaceGrassSpec spec = spec_of(Placement::kMixed, 200);
    spec.slope_deg = 40;
    const SurfaceBlades grass = place_surface_grass(sphere(16), spec, "m.glb");
    EXPECT_GT(grass.blades.size(), 100u);
    for (const auto& blade : grass.blades) {
        EXPECT_GT(blade.root_direction.y,
                  std::cos(52 * M_PI / 180)); // a triangle is 11 degrees wide
    }
    spec.slope_deg = 1; // the sphere has no facet that level
    EXPECT_NE(error_of(sphere(16), spec, base::ExitCode::kBadInput)
                  .find("no area that leans at most 1 degrees"),
              std::string::npos);
}

TEST(SurfacePlacement, ClustersAreFullCompactAndBounded) {
    const Mesh mesh = sphere(16);
    const SurfaceBlades grass =
        place_surface_grass(mesh, spec_of(Placement::kMixed, 1234), "m.glb");
    ASSERT_EQ(grass.clusters.size(), (grass.blades.size() + CULL_GROUP - 1) / CULL_GROUP);
    double longest = 0;
    for (std::size_t c = 0; c < grass.clusters.size(); ++c) {
        const SurfaceCluster& cluster = grass.clusters[c];
        EXPECT_EQ(cluster.first, c * CULL_GROUP);
        EXPECT_TRUE(cluster.count == CULL_GROUP || c + 1 == grass.clusters.size());
        longest = std::max<double>(longest, glm::length(cluster.high - cluster.low));
        for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
            const auto& blade = grass.blades[i];
            const glm::vec3 root(blade.root_direction);
            for (const float v : {0.0f, 0.3f, 0.7f, 1.0f}) {
                const glm::vec3 p = root + shared::blade_curve(glm::vec3(blade.v1_height),
                                                               glm::vec3(blade.v2_width), v);
                EXPECT_TRUE(glm::all(glm::greaterThanEqual(p, cluster.low)) &&
                            glm::all(glm::lessThanEqual(p, cluster.high)));
            }
        }
    }
    // 128 of 1234 a square metre are a square of 0.32 m; with the reach on every side a box of 1.0
    // x 1.0 x 0.7 m.
    EXPECT_LT(longest, 2.1);
}

TEST(SurfacePlacement, BalancedOrderIsAPermutationOfCompactRuns) {
    std::vector<glm::vec3> places;
    for (unsigned i = 0; i < 20000; ++i) {
        places.emplace_back(shared::hash_to_unit(shared::hash_pcg(2 * i)), 0,
                            shared::hash_to_unit(shared::hash_pcg(2 * i + 1)));
    }
    const auto order = balanced_order(places, 128);
    EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), places.size());
    double sides = 0, steps = 0;
    for (std::size_t first = 0; first + 128 <= order.size(); first += 128) {
        glm::vec3 low(1e9f), high(-1e9f);
        for (std::size_t i = first; i < first + 128; ++i) {
            low = glm::min(low, places[order[i]]);
            high = glm::max(high, places[order[i]]);
            steps +=
                i > first ? glm::distance(places[order[i]], places[order[i - 1]]) / (156 * 127) : 0;
        }
        sides += std::max(high.x - low.x, high.z - low.z) / 156;
    }
    EXPECT_LT(sides, 1.5 * std::sqrt(128.0 / 20000)); // of squares of one area
    EXPECT_LT(steps, 2.2 * std::sqrt(1.0 / 20000));   // in random order inside a run: 5.9
    EXPECT_EQ(balanced_order({}, 128).size(), 0u);
}

TEST(SurfacePlacement, TheSameSeedGivesTheSameBytes) {
    const Mesh mesh = sphere(10);
    SurfaceGrassSpec spec = spec_of(Placement::kMixed, 300);
    const auto a = place_surface_grass(mesh, spec, "m.glb").blades,
               b = place_surface_grass(mesh, spec, "m.glb").blades;
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
    spec.seed = 2;
    const auto c = place_surface_grass(mesh, spec, "m.glb").blades;
    EXPECT_NE(std::memcmp(a.data(), c.data(), a.size() * sizeof(a[0])), 0);
}

TEST(SurfacePlacement, DegenerateMeshesAreRefused) {
    using base::ExitCode;
    const SurfaceGrassSpec spec = spec_of(Placement::kMixed, 100);
    EXPECT_EQ(error_of(Mesh(), spec, ExitCode::kBadInput),
              "m.glb: surface: found no triangles, expected a mesh with a surface");
    Mesh flat;
    add_triangle(flat, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    EXPECT_EQ(error_of(flat, spec, ExitCode::kBadInput),
              "m.glb: surface: found no area, expected a mesh with a surface");
    Mesh nan = wavy_sheet(2);
    nan.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(error_of(nan, spec, ExitCode::kBadInput),
              "m.glb: surface: found vertex 3 that is not finite, expected finite numbers");
    Mesh outside = wavy_sheet(2);
    outside.triangles[1][2] = 99999;
    EXPECT_EQ(error_of(outside, spec, ExitCode::kBadInput),
              "m.glb: surface: found index 99999, expected one of the vertices");
    Mesh many = wavy_sheet(1);
    many.triangles.resize(kMostSurfaceTriangles + 1, many.triangles[0]);
    EXPECT_EQ(error_of(many, spec, ExitCode::kOverLimit),
              "m.glb: surface: found 10000001 triangles, expected at most 10000000");
    const std::string dense =
        error_of(wavy_sheet(4), spec_of(Placement::kSingle, 1e7), ExitCode::kOverLimit);
    EXPECT_NE(dense.find("expected at most 10000000; surface_grass.density_per_m2 makes it less"),
              std::string::npos)
        << dense;
}

TEST(SurfacePlacement, TrianglesWithoutAreaCarryNothing) {
    Mesh mesh = wavy_sheet(6);
    const Mesh sound = mesh;
    add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    add_triangle(mesh, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    mesh.triangles.insert(mesh.triangles.begin(), mesh.triangles.back());
    const SurfaceBlades grass = place_surface_grass(mesh, spec_of(Placement::kMixed, 200), "m.glb");
    EXPECT_EQ(grass.blades.size(),
              place_surface_grass(sound, spec_of(Placement::kMixed, 200), "m.glb").blades.size());
    for (const auto& blade : grass.blades) {
        ASSERT_LT(off_surface(sound, glm::dvec3(blade.root_direction)), 1e-5);
    }
}

} // namespace
} // namespace sward::blades
