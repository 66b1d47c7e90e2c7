// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/program.h"
#include "scene/mesh.h"

namespace sward::render {

/// A triangle mesh on the GPU.
class MeshBuffer {
public:
    explicit MeshBuffer(const scene::Mesh& mesh);
    ~MeshBuffer();
    MeshBuffer(MeshBuffer&& other) noexcept;
    MeshBuffer& operator=(MeshBuffer&&) = delete;
    void draw() const;

private:
    gl::Buffer vertices_, indices_;
    std::uint32_t vertex_array_ = 0;
    int count_ = 0;
};

/// A ball of radius 1, round enough for a silhouette across the screen.
[[nodiscard]] scene::Mesh unit_sphere();

/// Axes of a mesh that is turned by a yaw: 0 looks north (-z), positive to the east, clockwise from
/// above.
[[nodiscard]] glm::mat3 yaw_turn(double yaw_deg);

/// Draws opaque meshes in the light of the frame: the ground under a mesh's grass, objects. Before:
/// frame constants are bound.
class MeshPass {
public:
    struct Look {
        glm::vec3 place{0}; ///< of its origin, anchor-relative (m)
        float scale = 1;
        glm::mat3 turn{1};   ///< its own axes in the world's
        glm::vec3 colour{0}; ///< linear reflectance
        float tier = 6;      ///< in the AOV
        glm::vec3 bare{0};   ///< where it leans too far for grass
        float least_up = -2; ///< cosine of the slope from which on it does
        float density = 0;   ///< of grass that shades it, 0..1
    };
    explicit MeshPass(bool aov);
    void execute(const MeshBuffer& mesh, const Look& look);
    void reload() { program_.reload(); }

private:
    gl::Program program_;
};

} // namespace sward::render
