// SPDX-License-Identifier: Apache-2.0
#include "blades/surface_simulation.h"

#include <algorithm>
#include <utility>

#include "shared/bindings.h"

namespace sward::blades {

namespace {

std::vector<SurfaceCluster> all_clusters(const std::vector<SurfaceSimulation::Records>& records) {
    std::vector<SurfaceCluster> all;
    for (const auto& part : records) {
        all.insert(all.end(), part.clusters.begin(), part.clusters.end());
    }
    return all;
}

std::vector<int> buffers(const std::vector<SurfaceSimulation::Records>& records) {
    std::vector<int> numbers;
    for (std::size_t n = 0; n < records.size(); ++n) {
        numbers.insert(numbers.end(), records[n].clusters.size(), static_cast<int>(n));
    }
    return numbers;
}

std::vector<const gl::Buffer*>
blade_buffers(const std::vector<SurfaceSimulation::Records>& records) {
    std::vector<const gl::Buffer*> out;
    for (const auto& part : records) {
        out.push_back(part.blades);
    }
    return out;
}

} // namespace

ClusterTree::ClusterTree(const std::vector<SurfaceCluster>& clusters) {
    levels_.emplace_back();
    for (const SurfaceCluster& cluster : clusters) {
        levels_[0].push_back({cluster.low, cluster.high});
    }
    while (levels_.back().size() > 1) {
        const std::vector<Bounds>& below = levels_.back();
        std::vector<Bounds> level;
        for (std::size_t n = 0; n < below.size(); n += 2) {
            const Bounds& a = below[n];
            const Bounds& b = below[std::min(n + 1, below.size() - 1)];
            level.push_back({glm::min(a.low, b.low), glm::max(a.high, b.high)});
        }
        levels_.push_back(std::move(level));
    }
}

void ClusterTree::each(const Box& box, const Found& found) const {
    std::vector<std::pair<std::size_t, std::size_t>> todo = {{levels_.size() - 1, 0}};
    while (!todo.empty()) {
        const auto [level, n] = todo.back();
        todo.pop_back();
        if (n >= levels_[level].size()) {
            continue;
        }
        const glm::dvec3 low(levels_[level][n].low), high(levels_[level][n].high);
        if (glm::any(glm::lessThan(box.high, low)) || glm::any(glm::greaterThan(box.low, high))) {
            continue;
        }
        if (level == 0) {
            found(static_cast<std::uint32_t>(n));
        } else {
            todo.emplace_back(level - 1, 2 * n + 1);
            todo.emplace_back(level - 1, 2 * n);
        }
    }
}

SurfaceSimulation::SurfaceSimulation(const std::vector<Records>& records, double canopy_m,
                                     Settings settings)
    : LivingBlades(settings, canopy_m, 0), clusters_(all_clusters(records)),
      buffer_of_(buffers(records)), tree_(clusters_), slot_of_(clusters_.size(), 0),
      cluster_of_(
          std::min(clusters_.size(), settings.pages.most_bytes / (CULL_GROUP * sizeof(glm::vec4))),
          -1),
      pass_(blade_buffers(records), cluster_of_.size(), settings.programs),
      slot_buffer_(gl::Buffer::of(std::span<const std::uint32_t>(slot_of_))),
      radius_m_(settings.pages.radius_m) {}

void SurfaceSimulation::clear() {
    std::fill(slot_of_.begin(), slot_of_.end(), 0u);
    std::fill(cluster_of_.begin(), cluster_of_.end(), -1);
}

std::vector<std::size_t> SurfaceSimulation::wishes(std::span<const glm::dvec3> eyes) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t n = 0; n < clusters_.size(); ++n) {
        double apart = radius_m_;
        for (const glm::dvec3& place : eyes) {
            const glm::vec3 eye(place);
            const glm::vec3 away =
                glm::max(glm::max(clusters_[n].low - eye, eye - clusters_[n].high), glm::vec3(0));
            apart = std::min<double>(apart, glm::length(away));
        }
        if (apart < radius_m_) {
            near.emplace_back(apart, n);
        }
    }
    reach_m_ = radius_m_;
    if (near.size() > cluster_of_.size()) { // the farthest go without
        const auto room = near.begin() + static_cast<std::ptrdiff_t>(cluster_of_.size());
        std::nth_element(near.begin(), room, near.end());
        reach_m_ = room->first;
        near.erase(room, near.end());
    }
    std::vector<std::size_t> wanted;
    for (const auto& [apart, n] : near) {
        wanted.push_back(n);
    }
    std::sort(wanted.begin(), wanted.end()); // neighbours in memory too
    return wanted;
}

void SurfaceSimulation::give(const std::vector<std::size_t>& wanted, std::vector<int>& fresh) {
    std::vector<bool> keeps(clusters_.size(), false);
    for (const std::size_t n : wanted) {
        keeps[n] = true;
    }
    for (std::int64_t& cluster : cluster_of_) {
        if (cluster >= 0 && !keeps[static_cast<std::size_t>(cluster)]) {
            slot_of_[static_cast<std::size_t>(cluster)] = 0;
            cluster = -1;
        }
    }
    std::size_t slot = 0;
    for (const std::size_t n : wanted) {
        if (slot_of_[n] == 0) {
            while (cluster_of_[slot] >= 0) {
                ++slot;
            }
            cluster_of_[slot] = static_cast<std::int64_t>(n);
            slot_of_[n] = static_cast<std::uint32_t>(slot) + 1;
            fresh.push_back(static_cast<int>(slot));
        }
    }
}

void SurfaceSimulation::page(const Inputs& inputs) {
    const std::vector<std::uint32_t> before = slot_of_;
    std::vector<int> fresh;
    give(wishes(inputs.eyes()), fresh);
    if (slot_of_ != before) {
        slot_buffer_.upload(slot_of_.data(), slot_of_.size() * sizeof(std::uint32_t));
    }
    std::vector<shared::BladePage> placed(cluster_of_.size());
    blades_ = 0;
    for (std::size_t slot = 0; slot < placed.size(); ++slot) {
        if (cluster_of_[slot] >= 0) {
            const auto n = static_cast<std::size_t>(cluster_of_[slot]);
            placed[slot] = {glm::vec3(-inputs.anchor),
                            0,
                            static_cast<int>(clusters_[n].first),
                            static_cast<int>(clusters_[n].count),
                            buffer_of_[n],
                            0};
            blades_ += clusters_[n].count;
        }
    }
    pass_.place(std::move(placed), fresh);
}

SphereLists SurfaceSimulation::meet(std::span<const MovingSphere> spheres,
                                    glm::dvec3 anchor) const {
    return sphere_lists(
        cluster_of_.size(), spheres, anchor, [&](const MovingSphere& sphere, const Found& found) {
            const double reach = sphere.radius_m + glm::distance(sphere.centre, sphere.before);
            tree_.each(swept_box(sphere, 0),
                       [&](std::uint32_t cluster) { // a cluster's box holds the reach of its blades
                           const glm::dvec3 low(clusters_[cluster].low),
                               high(clusters_[cluster].high);
                           const bool touches =
                               glm::distance(glm::clamp(sphere.centre, low, high), sphere.centre) <=
                               reach; // not at its corners alone
                           if (touches && slot_of_[cluster] > 0) {
                               found(slot_of_[cluster] - 1);
                           }
                       });
        });
}

void SurfaceSimulation::bind_for_drawing() const {
    pass_.bind_for_drawing();
    slot_buffer_.bind_storage(BIND_BLADE_PLACES);
}

} // namespace sward::blades
