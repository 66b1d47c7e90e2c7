// SPDX-License-Identifier: Apache-2.0
#include "blades/surface_pass.h"

#include <algorithm>
#include <span>

#include "shared/bindings.h"

namespace sward::blades {

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

std::vector<SurfacePass::Part> SurfacePass::select(const terrain::Frustum& frustum,
                                                   glm::vec3 origin) const {
    std::vector<Part> parts;
    for (std::size_t page = 0; page < pages_.size(); ++page) {
        TileList list = select_of(pages_[page], frustum, origin);
        if (!list.items.empty()) {
            parts.push_back({page, std::move(list)});
        }
    }
    return parts;
}

void SurfacePass::begin(const Part& part, const Drawing& how, DrawPass& draw) {
    const Page& page = pages_[part.page];
    cull_.upload(part.list, how.keep_total);
    page.blades.bind_storage(BIND_BLADES);
    const float thin_out = how.thins_out ? thin_out_m_ : 0;
    describe(cull_.program(), how.origin, thin_out);
    describe(draw.program(), how.origin, thin_out);
    draw.program().set("surface_shape", shape_); // which the culling has no use for
    draw.program().set("first_cluster", static_cast<int>(page.first_cluster));
}

TileList SurfacePass::select_of(const Page& page, const terrain::Frustum& frustum,
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
