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

    /// What the view reaches of a page of clusters.
    struct Part {
        std::size_t page = 0;
        TileList list;
    };
    /// `origin`: of the mesh's space, anchor-relative.
    [[nodiscard]] std::vector<Part> select(const terrain::Frustum& frustum, glm::vec3 origin) const;

    struct Drawing {
        glm::vec3 origin{0};
        bool thins_out = true;   ///< with distance
        bool keep_total = false; ///< later parts and pictures of one frame add to its count
    };
    /// Before the batches of a part: then each is culled, and drawn by `draw`, the SURFACE variant,
    /// from cull(). Before: frame constants are bound, the depth pyramid where occlusion is tested.
    void begin(const Part& part, const Drawing& how, DrawPass& draw);
    void cull(std::size_t batch, const CullTests& tests) { cull_.execute(batch, tests); }

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
    [[nodiscard]] TileList select_of(const Page& page, const terrain::Frustum& frustum,
                                     glm::vec3 origin) const;
    void describe(const gl::Program& program, glm::vec3 origin, float thin_out) const;

    std::vector<Page> pages_;
    CullPass cull_;
    glm::vec4 shape_;
    float canopy_m_, thin_out_m_;
    glm::vec4 reach_{0, 0, 0, 1e30f}; ///< limit()'s
    std::size_t count_;
};

} // namespace sward::blades
