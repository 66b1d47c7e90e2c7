// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "blades/surface_area.h"
#include "grass/grass_set.h"
#include "scene/mesh.h"
#include "scene/surface_grass.h"
#include "shared/surface_blade.h"

namespace sward::blades {

/// Blades of one workgroup: CULL_GROUP of them (the last cluster may have fewer), near each other,
/// in Morton order (J3).
struct SurfaceCluster {
    glm::vec3 low{0}, high{0}; ///< of the roots, grown by the reach of the blades (m)
    std::uint32_t first = 0, count = 0;
};

struct SurfaceBlades {
    std::vector<shared::SurfaceBlade> blades; ///< cluster by cluster
    std::vector<SurfaceCluster> clusters;
    double area_m2 = 0; ///< that grass may cover
};

inline constexpr std::size_t kMostSurfaceBlades = 10'000'000; ///< 640 MB of blades
inline constexpr std::size_t kMostSurfaceTriangles = 10'000'000;

/// Density times area of `mesh` blades (J2): single ones uniform by area, tufts scattered around
/// Poisson-disk centres, or both. The same mesh and spec give the same bytes. Throws Error naming
/// `file`: kBadInput for a mesh without triangles or area, with NaN or an index past its end;
/// kOverLimit for more triangles or blades than the limits.
[[nodiscard]] SurfaceBlades place_surface_grass(const scene::Mesh& mesh,
                                                const scene::SurfaceGrassSpec& spec,
                                                const std::filesystem::path& file);

/// The blades of a set on a mesh: those of its patches, laid on the mesh chart by chart
/// (shared/surface_chart.h), which is where the far field reads them. `density`: share of them that
/// stands, by seed. Throws Error likewise.
struct SetPlacing {
    const grass::GrassSet& set;
    double density = 1;
    double slope_deg = 180;
};
[[nodiscard]] SurfaceBlades place_set_on_surface(const scene::Mesh& mesh, const SetPlacing& placing,
                                                 const std::filesystem::path& file);

/// Throws Error as place_surface_grass for what is no surface.
void check_surface(const scene::Mesh& mesh, const std::filesystem::path& file);

/// The blades first .. last - 1 as a cluster.
void add_cluster(SurfaceBlades& out, std::size_t first, std::size_t last);

/// Poisson-disk centres on the surface by dart throwing: none nearer than `apart_m` to another on
/// the same side of it, at most `wanted` (fewer where no more fit).
[[nodiscard]] std::vector<SurfacePoint> tuft_centres(const SurfaceArea& area, std::size_t wanted,
                                                     double apart_m, std::uint64_t seed);

/// Sorts the numbers 0 .. n - 1 of places into runs of `size` (the last may be shorter) that are
/// compact, each in Morton order: medians of the longer sides, at multiples of `size`.
[[nodiscard]] std::vector<std::uint32_t> balanced_order(const std::vector<glm::vec3>& places,
                                                        std::size_t size);

} // namespace sward::blades
