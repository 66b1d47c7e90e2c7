// SPDX-License-Identifier: Apache-2.0
#include "assets/sphere_packing.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToSpheres.h>

#include "base/error.h"

namespace sward::assets {
namespace {

using base::ExitCode;

constexpr float kBand = 3;         // of the level set, cells
constexpr int kCandidates = 20000; // places that the packing tries for its balls
constexpr double kGap = 1e-4;      // of the longest side: places nearer than that are one

/// Number of the first vertex at the same place, to kGap.
std::vector<std::uint32_t> weld(const std::vector<glm::vec3>& positions, glm::vec3 low,
                                double side) {
    std::vector<std::pair<std::array<std::int64_t, 3>, std::uint32_t>> keys;
    keys.reserve(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        const glm::dvec3 cell = glm::round(glm::dvec3(positions[i] - low) / (kGap * side));
        keys.push_back({{static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y),
                         static_cast<std::int64_t>(cell.z)},
                        i});
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> same(positions.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        same[keys[i].second] =
            i > 0 && keys[i].first == keys[i - 1].first ? same[keys[i - 1].second] : keys[i].second;
    return same;
}

/// Every edge must be run through as often one way as the other, or the mesh has a rim.
bool is_closed(const scene::Mesh& mesh, const std::vector<std::uint32_t>& same) {
    std::vector<std::array<std::uint32_t, 3>>
        edges; // ends in order; 1 where the triangle runs them backwards
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = same[t[k]], b = same[t[(k + 1) % 3]];
            if (a != b)
                edges.push_back({std::min(a, b), std::max(a, b), a > b ? 1u : 0u});
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        long balance = 0;
        const std::size_t first = i;
        for (; i < edges.size() && edges[i][0] == edges[first][0] && edges[i][1] == edges[first][1];
             ++i)
            balance += edges[i][2] == 0 ? 1 : -1;
        if (balance != 0)
            return false;
    }
    return true;
}

/// Six times the signed volume, about `middle`.
double volume_of(const scene::Mesh& mesh, glm::dvec3 middle) {
    double sum = 0;
    for (const auto& t : mesh.triangles)
        sum += glm::dot(glm::dvec3(mesh.positions[t[0]]) - middle,
                        glm::cross(glm::dvec3(mesh.positions[t[1]]) - middle,
                                   glm::dvec3(mesh.positions[t[2]]) - middle));
    return sum / 6;
}

/// The mesh in cells, its low corner at 0.
openvdb::FloatGrid::Ptr level_set(const scene::Mesh& mesh, glm::vec3 low, double cell) {
    std::vector<openvdb::Vec3s> points;
    points.reserve(mesh.positions.size());
    for (const glm::vec3 p : mesh.positions) {
        const glm::dvec3 q = glm::dvec3(p - low) / cell;
        points.emplace_back(static_cast<float>(q.x), static_cast<float>(q.y),
                            static_cast<float>(q.z));
    }
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        triangles.emplace_back(t[0], t[1], t[2]);
    return openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
        *openvdb::math::Transform::createLinearTransform(1.0), points, triangles, kBand);
}

} // namespace

scene::SphereSet pack_spheres(const scene::Mesh& mesh, const PackingSettings& settings,
                              const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& found, const char* expected) {
        return base::input_error(ExitCode::kBadInput, file, 0, "mesh to be packed with spheres",
                                 found, expected);
    };
    if (mesh.triangles.empty())
        throw refuse("no triangles", "a closed mesh");
    if (mesh.triangles.size() > kMostPackedTriangles)
        throw base::input_error(ExitCode::kOverLimit, file, 0, "mesh to be packed with spheres",
                                fmt::format("{} triangles", mesh.triangles.size()),
                                fmt::format("at most {}", kMostPackedTriangles));
    glm::vec3 low(mesh.positions[mesh.triangles[0][0]]), high = low;
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t corner : t) {
            low = glm::min(low, mesh.positions[corner]);
            high = glm::max(high, mesh.positions[corner]);
        }
    const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(side > 0) || !is_closed(mesh, weld(mesh.positions, low, side)))
        throw refuse("a rim", "a closed mesh, its triangles turned alike (object.collides = false: "
                              "a mesh that grass does not feel)");
    if (!(std::abs(volume_of(mesh, glm::dvec3(low))) > 0))
        throw refuse("no volume", "a closed mesh");

    const double cell = side / settings.cells;
    std::vector<openvdb::Vec4s> packed;
    openvdb::tools::fillWithSpheres(*level_set(mesh, low, cell), packed,
                                    openvdb::Vec2i(1, settings.most_spheres), /*overlapping=*/true,
                                    /*minRadius=*/1.0f,
                                    /*maxRadius=*/static_cast<float>(settings.cells),
                                    /*isovalue=*/0.0f, kCandidates);
    scene::SphereSet set;
    for (const openvdb::Vec4s& ball : packed)
        if (ball[3] >= 1.0f && std::isfinite(ball[0] + ball[1] + ball[2] + ball[3]))
            set.spheres.emplace_back(
                glm::vec3(glm::dvec3(ball[0], ball[1], ball[2]) * cell + glm::dvec3(low)),
                static_cast<float>(ball[3] * cell));
    if (set.spheres.empty())
        throw refuse("no inside", "one that a ball of a hundredth of its length fits in");
    std::stable_sort(set.spheres.begin(), set.spheres.end(),
                     [](const glm::vec4& a, const glm::vec4& b) { return a.w > b.w; });
    return set;
}

} // namespace sward::assets
