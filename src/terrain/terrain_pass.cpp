// SPDX-License-Identifier: Apache-2.0
#include "terrain/terrain_pass.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::terrain {

namespace {

constexpr int kBlocks = shared::kClipCells / shared::kBlockCells; // a side
constexpr int kBoundedLevels = 5; // finer blocks get bounds of their own; coarser ones span whole hills anyway

/// Does the next finer level's window cover block (i, j) of `level`?
bool in_hole(const Clipmap& clipmap, int level, int i, int j) {
    if (level == 0) {
        return false;
    }
    const glm::ivec2 finer = clipmap.window(level - 1).first / 2; // even by the snap
    const glm::ivec2 first = clipmap.window(level).first + glm::ivec2(i, j) * shared::kBlockCells;
    const glm::ivec2 offset = first - finer;
    return offset.x >= 0 && offset.y >= 0 && offset.x < shared::kClipCells / 2 && offset.y < shared::kClipCells / 2;
}

/// Bounds of the surface over a block, world metres; z: rise over run.
glm::dvec3 block_range(const Surface& surface, glm::dvec2 corner, double side) {
    const glm::dvec2 range = surface.bounds(corner, side);
    return {range, std::max(range.y - range.x - 2.54 * surface.relief_m(), 0.0) / side};
}

} // namespace

std::vector<VisibleBlock> visible_blocks(const Clipmap& clipmap, const Surface& surface, const Frustum& frustum,
                                         glm::dvec3 anchor, glm::vec4 eye_canopy_m) {
    const glm::vec3 eye(eye_canopy_m);
    std::vector<VisibleBlock> blocks;
    for (int level = 0; level < clipmap.levels(); ++level) {
        const double cell = Clipmap::spacing(level);
        const double side = cell * shared::kBlockCells;
        for (int n = 0; n < kBlocks * kBlocks; ++n) {
            const int i = n % kBlocks;
            const int j = n / kBlocks;
            if (in_hole(clipmap, level, i, j)) {
                continue;
            }
            const glm::dvec2 corner = glm::dvec2(clipmap.window(level).first + glm::ivec2(i, j) * shared::kBlockCells) * cell;
            const glm::vec2 place(corner - glm::dvec2(anchor.x, anchor.z));
            const auto seen = [&](glm::dvec3 bounds) {
                return frustum.may_see({place.x, bounds.x - anchor.y, place.y},
                                       {place.x + side, bounds.y - anchor.y + static_cast<double>(eye_canopy_m.w), place.y + side});
            };
            glm::dvec3 range(surface.range(), 1);
            if (!seen(range)) {
                continue;
            }
            if (level < kBoundedLevels && !seen(range = block_range(surface, corner, side))) {
                continue;
            }
            const glm::vec2 gap = glm::max(glm::max(place - glm::vec2(eye.x, eye.z),
                                                    glm::vec2(eye.x, eye.z) - place - static_cast<float>(side)), glm::vec2(0));
            blocks.push_back({place, static_cast<float>(cell), level, static_cast<float>(range.x - anchor.y),
                              static_cast<float>(range.y - anchor.y), static_cast<float>(range.z), glm::length(gap)});
        }
    }
    std::stable_sort(blocks.begin(), blocks.end(), [](const auto& a, const auto& b) { return a.nearest < b.nearest; });
    return blocks;
}

BlockMesh::BlockMesh() {
    constexpr int n = shared::kBlockCells;
    std::vector<std::uint16_t> indices;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const int at = j * (n + 1) + i;
            // Counter-clockwise from above: x east, z south.
            for (const int corner : {at, at + n + 1, at + 1, at + 1, at + n + 1, at + n + 2}) {
                indices.push_back(static_cast<std::uint16_t>(corner));
            }
        }
    }
    indices_ = gl::Buffer::of(std::span<const std::uint16_t>(indices));
    glCreateVertexArrays(1, &vertex_array_);
    glVertexArrayElementBuffer(vertex_array_, indices_.id());
}

BlockMesh::~BlockMesh() { glDeleteVertexArrays(1, &vertex_array_); }

void BlockMesh::draw(int instances) const {
    constexpr int kIndices = 6 * shared::kBlockCells * shared::kBlockCells;
    glBindVertexArray(vertex_array_);
    glDrawElementsInstanced(GL_TRIANGLES, kIndices, GL_UNSIGNED_SHORT, nullptr, instances);
}

BlockSamples::BlockSamples() : program_("block samples", {"terrain/block_samples.comp"}) {}

void BlockSamples::execute(const std::vector<VisibleBlock>& blocks) {
    std::vector<shared::TerrainBlock> places;
    places.reserve(blocks.size());
    for (const VisibleBlock& block : blocks) {
        places.push_back({{block.corner.x, block.corner.y, block.cell, block.level}});
    }
    blocks_.reserve(places.size() * sizeof(shared::TerrainBlock));
    blocks_.upload(places.data(), places.size() * sizeof(shared::TerrainBlock));
    const std::size_t count = blocks.size() * shared::kBlockPosts;
    samples_.reserve(count * sizeof(shared::BlockSample));
    blocks_.bind_storage(BIND_TERRAIN_BLOCKS);
    samples_.bind_storage(BIND_BLOCK_SAMPLES);
    program_.use();
    program_.set("sample_count", static_cast<int>(count));
    glDispatchCompute(static_cast<GLuint>((count + SAMPLE_GROUP - 1) / SAMPLE_GROUP), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

TerrainPass::TerrainPass(bool aov)
    : program_("terrain", {"terrain/terrain.vert", "terrain/terrain.frag"}, aov ? std::vector<std::string>{"AOV"} : std::vector<std::string>{}) {}

void TerrainPass::execute(int blocks, const BlockMesh& mesh) {
    program_.use();
    glEnable(GL_CULL_FACE);
    mesh.draw(blocks);
    glDisable(GL_CULL_FACE);
}

} // namespace sward::terrain
