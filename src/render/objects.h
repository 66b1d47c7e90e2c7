// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "render/mesh_pass.h"
#include "render/world.h"
#include "terrain/surface.h"

namespace sward::render {

/// The scene's objects on the GPU, where its paths or the host put them.
class Objects {
public:
    explicit Objects(const World& world);

    /// Where the host has put an object (its own frame, x right, y up, z back, to the world), from
    /// now on.
    void place(std::size_t object, const glm::dmat4& world_from_object) {
        placed_[object] = world_from_object;
    }
    [[nodiscard]] std::size_t count() const { return placed_.size(); }
    /// Draws them at a time, relative to `anchor` (world metres).
    void draw(MeshPass& pass, const scene::Scene& scene, const terrain::Surface& surface,
              glm::dvec3 anchor, double time_s) const;

private:
    std::map<std::filesystem::path, MeshBuffer> meshes_; ///< under the scene's names; "": the ball
    std::vector<std::optional<glm::dmat4>> placed_;      ///< by number in the scene
};

} // namespace sward::render
