// SPDX-License-Identifier: Apache-2.0
#include "blades/surface_pass.h"

#include <algorithm>
#include <span>

#include "shared/bindings.h"

namespace sward::blades {

static_assert(BIND_BLADES == 0); // execute() binds a page there

SurfacePass::SurfacePass(const SurfaceBlades& grass, const scene::SurfaceGrassSpec& spec,
                         const grass::GrassSet* set)
    : cull_({"SURFACE"}), shape_(set ? shared::kShapeOfSet : static_cast<float>(spec.shape),
                                 spec.tip_tau, spec.teeth, spec.tooth_depth),
      canopy_m_(set ? set->canopy_m : static_cast<float>(spec.species.length_m.high)),
      thin_out_m_(set ? 0 : static_cast<float>(spec.thin_out_m)), count_(grass.blades.size()) {
    for (std::size_t first = 0; first < grass.clusters.size(); first += kPageClusters) {
        const std::size_t last = std::min(first + kPageClusters, grass.clusters.size());
        const std::uint32_t begin = grass.clusters[first].first;
        const std::uint32_t end = grass.clusters[last - 1].first + grass.clusters[last - 1].count;
        Page page{gl::Buffer::of(std::span(grass.blades).subspan(begin, end - begin)), {}, first};
        for (std::size_t c = first; c < last; ++c) {
            page.clusters.push_back(grass.clusters[c]);
            page.clusters.back().first -= begin;
        }
        pages_.push_back(std::move(page));
    }
}

TileList SurfacePass::select(const Page& page, const terrain::Frustum& frustum,
                             glm::vec3 origin) const {
    TileList list;
    const glm::vec3 eye = glm::vec3(reach_) - origin;
    for (const SurfaceCluster& cluster : page.clusters) {
        if (glm::distance(glm::clamp(eye, cluster.low, cluster.high), eye) < reach_.w &&
            frustum.may_see(cluster.low + origin, cluster.high + origin)) {
            list.items.emplace_back(cluster.first + cluster.count, cluster.first);
            list.considered += cluster.count;
        }
    }
    return list;
}

std::uint64_t SurfacePass::bytes() const {
    std::uint64_t sum = cull_.bytes();
    for (const Page& page : pages_) {
        sum += page.blades.bytes();
    }
    return sum;
}

std::unique_ptr<SurfaceSimulation> SurfacePass::simulation(LivingBlades::Settings settings) const {
    std::vector<SurfaceSimulation::Records> records;
    for (const Page& page : pages_) {
        records.push_back({&page.blades, page.clusters});
    }
    return std::make_unique<SurfaceSimulation>(records, canopy_m_, settings);
}

void SurfacePass::describe(const gl::Program& program, glm::vec3 origin, float thin_out) const {
    program.set("surface_thin_out", thin_out);
    program.set("surface_origin", glm::vec4(origin, canopy_m_));
}

} // namespace sward::blades
