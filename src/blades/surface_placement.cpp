// SPDX-License-Identifier: Apache-2.0
#include "blades/surface_placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "shared/bindings.h"

namespace sward::blades {

namespace {

using base::ExitCode;

// Streams of the counter-based random numbers, three numbers an index each.
enum Stream : std::uint64_t { kSingle = 1, kCentre, kTuft, kShape, kTuftSize };

glm::dvec3 units(std::uint64_t seed, Stream stream, std::uint64_t index) {
    return {base::hash_unit(seed, stream, 3 * index), base::hash_unit(seed, stream, 3 * index + 1),
            base::hash_unit(seed, stream, 3 * index + 2)};
}

} // namespace

void check_surface(const scene::Mesh& mesh, const std::filesystem::path& file) {
    const auto refuse = [&](const std::string& found, const char* expected) {
        throw base::input_error(ExitCode::kBadInput, file, 0, "surface", found, expected);
    };
    if (mesh.triangles.empty())
        refuse("no triangles", "a mesh with a surface");
    if (mesh.triangles.size() > kMostSurfaceTriangles)
        throw base::input_error(ExitCode::kOverLimit, file, 0, "surface",
                                fmt::format("{} triangles", mesh.triangles.size()),
                                fmt::format("at most {}", kMostSurfaceTriangles));
    if (mesh.normals.size() != mesh.positions.size())
        refuse(fmt::format("{} normals of {} vertices", mesh.normals.size(), mesh.positions.size()),
               "one each");
    for (const auto& corners : mesh.triangles)
        for (const std::uint32_t corner : corners)
            if (corner >= mesh.positions.size())
                refuse(fmt::format("index {}", corner), "one of the vertices");
    const auto finite = [](glm::vec3 v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (!finite(mesh.positions[i]) || !finite(mesh.normals[i]))
            refuse(fmt::format("vertex {} that is not finite", i), "finite numbers");
}

namespace {

std::size_t checked_count(double area_m2, const scene::SurfaceGrassSpec& spec,
                          const std::filesystem::path& file) {
    if (!(area_m2 > 0))
        throw base::input_error(
            ExitCode::kBadInput, file, 0, "surface",
            spec.slope_deg < 180
                ? fmt::format("no area that leans at most {} degrees", spec.slope_deg)
                : "no area",
            "a mesh with a surface");
    const double count = std::round(area_m2 * spec.density_per_m2);
    if (!(count <= static_cast<double>(kMostSurfaceBlades)))
        throw base::input_error(
            ExitCode::kOverLimit, file, 0, "surface",
            fmt::format("{:.0f} blades ({:.6g} m2 at {:.6g} a square metre)", count, area_m2,
                        spec.density_per_m2),
            fmt::format("at most {}; surface_grass.density_per_m2 makes it less",
                        kMostSurfaceBlades));
    return static_cast<std::size_t>(count);
}

struct Root {
    SurfacePoint at;
    glm::dvec3 up;
    glm::dvec3 to_middle{0}; ///< of its tuft (m)
};

/// Blades of tufts: as many each, but for the remainder, walked out from their centres along the
/// surface; denser towards the middle.
void add_tufts(SurfaceArea& area, const scene::SurfaceGrassSpec& spec, std::size_t count,
               std::vector<Root>& roots) {
    const auto seed = static_cast<std::uint64_t>(spec.seed);
    const auto each = static_cast<std::size_t>(std::lround(spec.species.tuft_blades.mean()));
    const std::size_t wanted = std::max<std::size_t>((count + each / 2) / each, 1);
    // 0.7 of 1 / sqrt(density): darts jam at 0.83.
    const double apart = 0.7 * std::sqrt(area.total_m2() / static_cast<double>(wanted));
    const std::vector<SurfacePoint> centres = tuft_centres(area, wanted, apart, seed);
    area.link_neighbours();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t tuft = i % centres.size();
        const SurfacePoint& centre = centres[tuft];
        const double radius =
            std::lerp(spec.species.tuft_radius_m.low, spec.species.tuft_radius_m.high,
                      units(seed, kTuftSize, tuft).x);
        const glm::dvec3 u = units(seed, kTuft, i);
        const double turn = 2 * std::numbers::pi * u.x;
        const glm::vec3 up(area.face_normal(centre.triangle));
        const glm::dvec3 way(shared::surface_width_direction(up, static_cast<float>(turn)));
        const SurfacePoint at = area.walk(centre, way, radius * std::pow(u.y, 0.7));
        roots.push_back({at, area.normal(at), centre.place - at.place});
    }
}

/// Turn about `up` that makes a blade's front (J4) point to or away from the middle of its tuft, as
/// far as `gather` says; u: its own lot.
double turn_of(const Root& root, double gather, double u) {
    const double lot = 2 * std::numbers::pi * u;
    if (gather == 0 || glm::length(root.to_middle) < 1e-6) {
        return lot;
    }
    const glm::vec3 up(root.up), way(root.to_middle * (gather > 0 ? 1.0 : -1.0));
    const float a = glm::dot(way, shared::surface_width_direction(up, 0));
    const float b = glm::dot(way, shared::surface_width_direction(up, 0.5f * shared::kPi));
    // The front, up x (cos a + sin b), is sin a - cos b.
    return std::atan2(a, -b) + (1 - std::abs(gather)) * (lot - std::numbers::pi);
}

shared::SurfaceBlade make_blade(const Root& root, const scene::SurfaceGrassSpec& spec,
                                std::uint64_t index) {
    const auto seed = static_cast<std::uint64_t>(spec.seed);
    const glm::dvec3 u = units(seed, kShape, 2 * index), w = units(seed, kShape, 2 * index + 1);
    const auto in = [](const scene::Span& span, double share) {
        return glm::mix(span.low, span.high, share);
    };
    const auto height = static_cast<float>(in(spec.species.length_m, u.x));
    const auto half_width = static_cast<float>(0.5 * in(spec.species.width_m, u.y));
    const auto stiffness = static_cast<float>(in(spec.species.stiffness, u.z));
    const auto turn = static_cast<float>(turn_of(root, spec.tuft_gather, w.x));
    const glm::vec3 up(root.up);
    const glm::vec3 across = shared::surface_width_direction(up, turn);
    const float pull = static_cast<float>(spec.droop) * height / std::max(stiffness, 0.02f);
    glm::vec3 v1, v2;
    // Grown so, each by its own lot: the physics takes what it finds as the calm.
    const glm::vec3 grown =
        static_cast<float>(spec.lean * 2 * w.y) * height * glm::cross(up, across);
    shared::surface_settle(v1, v2, up, height, shared::surface_gravity(up, across, pull) + grown);
    return {glm::vec4(glm::vec3(root.at.place), turn), glm::vec4(v1, height),
            glm::vec4(v2, half_width), glm::vec4(up, stiffness)};
}

/// Places of a grid of cells, hashed: for the darts.
class PlaceGrid {
public:
    explicit PlaceGrid(double cell_m) : cell_m_(cell_m) {}
    template<class Near> bool any_near(glm::dvec3 place, Near near) const {
        const glm::ivec3 middle = cell_of(place);
        for (int n = 0; n < 27; ++n) {
            const auto found =
                cells_.find(key(middle + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
            if (found != cells_.end() && std::ranges::any_of(found->second, near)) {
                return true;
            }
        }
        return false;
    }
    void add(glm::dvec3 place, std::uint32_t number) {
        cells_[key(cell_of(place))].push_back(number);
    }

private:
    [[nodiscard]] glm::ivec3 cell_of(glm::dvec3 place) const {
        return glm::ivec3(
            glm::clamp(glm::floor(place / cell_m_), glm::dvec3(-1e9), glm::dvec3(1e9)));
    }
    static std::uint64_t
    key(glm::ivec3 cell) { // cells that share a key are told apart by the distance
        return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.x)) *
                0x9e3779b97f4a7c15u) ^
               (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.y)) *
                0xc2b2ae3d27d4eb4fu) ^
               (static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell.z)) *
                0x165667b19e3779f9u);
    }
    double cell_m_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

} // namespace

void add_cluster(SurfaceBlades& out, std::size_t first, std::size_t last) {
    SurfaceCluster cluster{glm::vec3(1e30f), glm::vec3(-1e30f), static_cast<std::uint32_t>(first),
                           static_cast<std::uint32_t>(last - first)};
    for (std::size_t i = first; i < last; ++i) {
        const shared::SurfaceBlade& blade = out.blades[i];
        const glm::vec3 root(blade.root_direction),
            reach(1.01f * blade.v1_height.w + blade.v2_width.w); // 1 %: of the length's estimate
        cluster.low =
            glm::min(cluster.low,
                     root - reach); // however it bends, a blade stays within its length of the root
        cluster.high = glm::max(cluster.high, root + reach);
    }
    out.clusters.push_back(cluster);
}

std::vector<SurfacePoint> tuft_centres(const SurfaceArea& area, std::size_t wanted, double apart_m,
                                       std::uint64_t seed) {
    std::vector<SurfacePoint> centres;
    std::vector<glm::dvec3> normals;
    PlaceGrid grid(std::max(apart_m, 1e-6));
    const std::size_t darts = 40 * wanted;
    for (std::size_t i = 0; i < darts && centres.size() < wanted; ++i) {
        const SurfacePoint dart = area.sample(units(seed, kCentre, i));
        const glm::dvec3 normal = area.face_normal(dart.triangle);
        const bool taken = grid.any_near(
            dart.place, [&](std::uint32_t other) { // the other side of a thin sheet is far away
                return glm::distance(centres[other].place, dart.place) < apart_m &&
                       glm::dot(normals[other], normal) > 0;
            });
        if (!taken) {
            grid.add(dart.place, static_cast<std::uint32_t>(centres.size()));
            centres.push_back(dart);
            normals.push_back(normal);
        }
    }
    return centres;
}

SurfaceBlades place_surface_grass(const scene::Mesh& mesh, const scene::SurfaceGrassSpec& spec,
                                  const std::filesystem::path& file) {
    check_surface(mesh, file);
    SurfaceArea area(mesh, spec.slope_deg);
    const std::size_t count = checked_count(area.total_m2(), spec, file);
    const auto in_tufts =
        static_cast<std::size_t>(std::llround(static_cast<double>(count) * spec.share_in_tufts()));

    std::vector<Root> roots;
    roots.reserve(count);
    for (std::size_t i = 0; i < count - in_tufts; ++i) {
        const SurfacePoint at =
            area.sample(units(static_cast<std::uint64_t>(spec.seed), kSingle, i));
        roots.push_back({at, area.normal(at)});
    }
    if (in_tufts > 0) {
        add_tufts(area, spec, in_tufts, roots);
    }
    std::vector<glm::vec3> places;
    places.reserve(count);
    for (const Root& root : roots) {
        places.emplace_back(root.at.place);
    }
    SurfaceBlades out;
    out.area_m2 = area.total_m2();
    out.blades.reserve(count);
    for (const std::uint32_t i : balanced_order(places, CULL_GROUP)) {
        out.blades.push_back(make_blade(roots[i], spec, i));
    }
    for (std::size_t first = 0; first < count; first += CULL_GROUP) {
        add_cluster(out, first, std::min<std::size_t>(first + CULL_GROUP, count));
    }
    return out;
}

} // namespace sward::blades
