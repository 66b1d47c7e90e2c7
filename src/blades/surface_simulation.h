// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blades/simulation.h"
#include "blades/surface_placement.h"

namespace sward::blades {

/// Boxes of clusters as a tree over their order, whose neighbours are neighbours in space: node n
/// of a level holds 2n and 2n + 1 of the level below. For the broad phase.
class ClusterTree {
public:
    explicit ClusterTree(const std::vector<SurfaceCluster>& clusters);
    /// Calls found(cluster) for each whose box meets this one (m, the mesh's space).
    void each(const Box& box, const Found& found) const;

private:
    struct Bounds {
        glm::vec3 low, high;
    };
    std::vector<std::vector<Bounds>> levels_; ///< the clusters first
};

/// The living blades of a mesh. The clusters nearest to the eye own a slot of a bounded pool, one
/// each; the mesh's space is the world's.
class SurfaceSimulation final : public LivingBlades {
public:
    /// A buffer of SurfaceBlade and its clusters, `first` within it; it outlives the simulation.
    struct Records {
        const gl::Buffer* blades;
        std::vector<SurfaceCluster> clusters;
    };
    /// `canopy_m`: greatest length of a blade.
    SurfaceSimulation(const std::vector<Records>& records, double canopy_m, Settings settings);

    [[nodiscard]] PhysicsPass& pass() override { return pass_; }
    [[nodiscard]] const PhysicsPass& pass() const override { return pass_; }
    [[nodiscard]] std::uint64_t blades() const override { return blades_; }
    [[nodiscard]] double reach_m() const override { return reach_m_; }
    [[nodiscard]] std::size_t slots() const { return cluster_of_.size(); }
    /// Slot of a cluster, counted through all buffers; -1: none.
    [[nodiscard]] int slot_of(std::size_t cluster) const {
        return static_cast<int>(slot_of_[cluster]) - 1;
    }
    /// What the drawing of blades reads.
    void bind_for_drawing() const;
    [[nodiscard]] std::size_t bytes() const override {
        return pass_.bytes() + slot_buffer_.bytes();
    }

private:
    [[nodiscard]] bool no_room() const override { return cluster_of_.empty(); }
    void clear() override;
    void page(const Inputs& inputs) override;
    [[nodiscard]] SphereLists meet(std::span<const MovingSphere> spheres,
                                   glm::dvec3 anchor) const override;
    [[nodiscard]] std::vector<std::size_t> wishes(std::span<const glm::dvec3> eyes);
    void give(const std::vector<std::size_t>& wanted, std::vector<int>& fresh);

    std::vector<SurfaceCluster> clusters_; ///< of all buffers
    std::vector<int> buffer_of_;           ///< a cluster
    ClusterTree tree_;
    std::vector<std::uint32_t> slot_of_;   ///< a cluster; 0: none, else one more than it is
    std::vector<std::int64_t> cluster_of_; ///< a slot; -1: none
    PhysicsPass pass_;
    gl::Buffer slot_buffer_;
    double radius_m_, reach_m_ = 0;
    std::uint64_t blades_ = 0;
};

} // namespace sward::blades
