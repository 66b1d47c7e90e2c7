// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <glm/glm.hpp>

#include "blades/cull_pass.h"
#include "blades/draw_pass.h"
#include "blades/surface_placement.h"
#include "blades/surface_simulation.h"
#include "gl/buffer.h"
#include "scene/surface_grass.h"
#include "terrain/frustum.h"

namespace sward::blades {

/// The blades of a mesh on the GPU: culled cluster by cluster on the CPU, blade by blade on the
/// GPU, and drawn by tessellation (J8).
class SurfacePass {
public:
    /// Clusters a buffer: a storage block may be as small as 128 MiB, this is 64.
    static constexpr std::size_t kPageClusters = 8192;

    /// `set`: that the blades are of; null: they are described by `spec`.
    SurfacePass(const SurfaceBlades& grass, const scene::SurfaceGrassSpec& spec,
                const grass::GrassSet* set);

    /// No blade stands farther than `end` (m) from `eye` (anchor-relative): clusters beyond are not
    /// looked at.
    void limit(glm::vec3 eye, float end) { reach_ = {eye, end}; }

    /// Culls and draws what the view reaches, page by page and batch by batch. `origin`: of the
    /// mesh's space, anchor-relative. `draw`: the SURFACE variant. Before: frame constants are
    /// bound, the depth pyramid where occlusion is tested. `keep_total`: later pictures of one
    /// frame add to its count. `pass`(name, what): runs a step under a name for timer and
    /// statistics. `living`: null where no blade lives.
    template<class Pass>
    void execute(const terrain::Frustum& frustum, glm::vec3 origin, DrawPass& draw,
                 const CullTests& tests, bool keep_total, const SurfaceSimulation* living,
                 Pass pass) {
        considered_ = keep_total ? considered_ : 0;
        bool again = keep_total;
        for (const Page& page : pages_) {
            const TileList list = select(page, frustum, origin);
            if (list.items.empty() && again) {
                continue;
            }
            cull_.upload(list, again);
            again = true;
            considered_ += list.considered;
            page.blades.bind_storage(0);
            const float thin_out = tests.distance ? thin_out_m_ : 0;
            describe(cull_.program(), origin, thin_out);
            describe(draw.program(), origin, thin_out);
            draw.program().set("surface_shape", shape_); // which the culling has no use for
            draw.program().set("first_cluster", static_cast<int>(page.first_cluster));
            for (std::size_t batch = 0; batch < cull_.batches(); ++batch) {
                pass("cull blades", [&] { cull_.execute(batch, tests); });
                pass("draw blades", [&] {
                    if (living) {
                        living->bind_for_drawing(); // where the culling had its own
                    }
                    draw.execute(cull_);
                });
            }
        }
    }

    [[nodiscard]] std::uint64_t considered() const {
        return considered_;
    } ///< blades of the clusters in view
    [[nodiscard]] const CullPass& cull() const { return cull_; }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::uint64_t bytes() const; ///< of the blades and of what culls them
    /// Lives as long as this.
    [[nodiscard]] std::unique_ptr<SurfaceSimulation>
    simulation(LivingBlades::Settings settings) const;
    void reload() { cull_.reload(); }

private:
    struct Page {
        gl::Buffer blades;
        std::vector<SurfaceCluster> clusters; ///< `first` within the page
        std::size_t first_cluster = 0;        ///< among all
    };
    [[nodiscard]] TileList select(const Page& page, const terrain::Frustum& frustum,
                                  glm::vec3 origin) const;
    void describe(const gl::Program& program, glm::vec3 origin, float thin_out) const;

    std::vector<Page> pages_;
    CullPass cull_;
    glm::vec4 shape_;
    float canopy_m_, thin_out_m_;
    glm::vec4 reach_{0, 0, 0, 1e30f}; ///< limit()'s
    std::size_t count_;
    std::uint64_t considered_ = 0;
};

} // namespace sward::blades
