// SPDX-License-Identifier: Apache-2.0
#include "render/mesh_pass.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "base/angles.h"

namespace sward::render {

namespace {

constexpr int kRings = 32;
constexpr std::uint32_t kVertexBytes = 6 * sizeof(float);

std::vector<glm::vec3> interleaved(const scene::Mesh& mesh) {
    std::vector<glm::vec3> vertices;
    vertices.reserve(2 * mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        vertices.push_back(mesh.positions[i]);
        vertices.push_back(mesh.normals[i]);
    }
    return vertices;
}

} // namespace

MeshBuffer::MeshBuffer(const scene::Mesh& mesh)
    : vertices_(gl::Buffer::of(std::span<const glm::vec3>(interleaved(mesh)))),
      indices_(gl::Buffer::of(std::span<const std::array<std::uint32_t, 3>>(mesh.triangles))),
      count_(static_cast<int>(3 * mesh.triangles.size())) {
    glCreateVertexArrays(1, &vertex_array_);
    glVertexArrayVertexBuffer(vertex_array_, 0, vertices_.id(), 0, kVertexBytes);
    glVertexArrayElementBuffer(vertex_array_, indices_.id());
    for (const GLuint attribute : {0u, 1u}) {
        glEnableVertexArrayAttrib(vertex_array_, attribute);
        glVertexArrayAttribFormat(vertex_array_, attribute, 3, GL_FLOAT, GL_FALSE,
                                  attribute * kVertexBytes / 2);
        glVertexArrayAttribBinding(vertex_array_, attribute, 0);
    }
}

MeshBuffer::~MeshBuffer() {
    if (vertex_array_) {
        glDeleteVertexArrays(1, &vertex_array_);
    }
}

MeshBuffer::MeshBuffer(MeshBuffer&& other) noexcept
    : vertices_(std::move(other.vertices_)), indices_(std::move(other.indices_)),
      vertex_array_(std::exchange(other.vertex_array_, 0)), count_(other.count_) {}

void MeshBuffer::draw() const {
    glBindVertexArray(vertex_array_);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
}

scene::Mesh unit_sphere() {
    scene::Mesh mesh;
    constexpr int kColumns = 2 * kRings;
    for (int j = 0; j <= kRings; ++j) {
        for (int i = 0; i <= kColumns; ++i) {
            const double polar = std::numbers::pi * j / kRings,
                         around = std::numbers::pi * i / kRings;
            mesh.positions.emplace_back(std::sin(polar) * std::cos(around), std::cos(polar),
                                        std::sin(polar) * std::sin(around));
        }
    }
    mesh.normals = mesh.positions;
    for (std::uint32_t j = 0; j < kRings; ++j) {
        for (std::uint32_t i = 0; i < kColumns; ++i) {
            const std::uint32_t at = j * (kColumns + 1) + i, below = at + kColumns + 1;
            mesh.triangles.push_back({at, at + 1, below});
            mesh.triangles.push_back({at + 1, below + 1, below});
        }
    }
    return mesh;
}

glm::mat3 yaw_turn(double yaw_deg) {
    return glm::mat3(base::Heading(yaw_deg).turn());
}

MeshPass::MeshPass(bool aov)
    : program_("meshes", {"render/mesh.vert", "render/mesh.frag"},
               aov ? std::vector<std::string>{"AOV"} : std::vector<std::string>{}) {}

void MeshPass::execute(const MeshBuffer& mesh, const Look& look) {
    program_.use();
    program_.set("place", glm::vec4(look.place, look.scale));
    program_.set("axis_x", glm::vec4(look.turn[0], 0));
    program_.set("axis_y", glm::vec4(look.turn[1], 0));
    program_.set("axis_z", glm::vec4(look.turn[2], 0));
    program_.set("density", look.density);
    program_.set("colour", glm::vec4(look.colour, look.tier));
    program_.set("bare", glm::vec4(look.bare, look.least_up));
    mesh.draw();
}

} // namespace sward::render
