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
constexpr std::size_t kMostBlocks = 8192; // through a long lens: 32 MB of samples
constexpr int kBoundedLevels =
    5; // finer blocks get bounds of their own; coarser ones span whole hills anyway

/// Does the next finer level's window cover block (i, j) of `level`?
bool in_hole(const Clipmap& clipmap, int level, int i, int j) {
    if (level == 0) {
        return false;
    }
    const glm::ivec2 finer = clipmap.window(level - 1).first / 2; // even by the snap
    const glm::ivec2 first = clipmap.window(level).first + glm::ivec2(i, j) * shared::kBlockCells;
    const glm::ivec2 offset = first - finer;
    return offset.x >= 0 && offset.y >= 0 && offset.x < shared::kClipCells / 2 &&
           offset.y < shared::kClipCells / 2;
}

/// Bounds of the surface over a block, world metres; z: rise over run.
glm::dvec3 block_range(const Surface& surface, glm::dvec2 corner, double side) {
    const glm::dvec2 range = surface.bounds(corner, side);
    return {range, std::max(range.y - range.x - 2.54 * surface.relief_m(), 0.0) / side};
}

} // namespace

namespace {

struct Chooser {
    const Surface& surface;
    const Frustum& frustum;
    glm::dvec3 anchor;
    glm::vec4 eye_canopy_m;
    Detail detail;
    std::vector<VisibleBlock> blocks;

    /// Adds the block, or what of it may be seen in finer ones. `corner`: world metres.
    void add(glm::dvec2 corner, int level, bool bounded) {
        if (blocks.size() > kMostBlocks && detail.on()) {
            return;
        }
        const double cell = Clipmap::spacing(level);
        const double side = cell * shared::kBlockCells;
        const glm::vec2 place(corner - glm::dvec2(anchor.x, anchor.z));
        const auto seen = [&](glm::dvec3 bounds) {
            return frustum.may_see({place.x, bounds.x - anchor.y, place.y},
                                   {place.x + side,
                                    bounds.y - anchor.y + static_cast<double>(eye_canopy_m.w),
                                    place.y + side});
        };
        glm::dvec3 range(surface.range(), 1);
        if (!seen(range) || (bounded && !seen(range = block_range(surface, corner, side)))) {
            return;
        }
        const glm::vec2 eye(eye_canopy_m.x, eye_canopy_m.z);
        const glm::vec2 gap =
            glm::max(glm::max(place - eye, eye - place - static_cast<float>(side)), glm::vec2(0));
        if (level > 0 && detail.on()) {
            const glm::vec2 far = glm::max(eye - place, place + static_cast<float>(side) - eye);
            const float reach = detail.least_reach(std::max(gap.x, gap.y), std::max(far.x, far.y));
            if (reach <
                54 * Clipmap::spacing(
                         level - 1)) { // kBlendEnd of ground.glsl: some of it is of a finer level
                for (int quarter = 0; quarter < 4; ++quarter)
                    add(corner + 0.5 * side * glm::dvec2(quarter & 1, quarter >> 1), level - 1,
                        true);
                return;
            }
        }
        blocks.push_back({place, static_cast<float>(cell), level,
                          static_cast<float>(range.x - anchor.y),
                          static_cast<float>(range.y - anchor.y), static_cast<float>(range.z),
                          glm::length(gap)});
    }
};

} // namespace

std::vector<VisibleBlock> visible_blocks(const Clipmap& clipmap, const Surface& surface,
                                         const Frustum& frustum, glm::dvec3 anchor,
                                         glm::vec4 eye_canopy_m, Detail& detail) {
    Chooser chooser{surface, frustum, anchor, eye_canopy_m, detail, {}};
    for (int level = 0; level < clipmap.levels(); ++level) {
        for (int n = 0; n < kBlocks * kBlocks; ++n) {
            const int i = n % kBlocks;
            const int j = n / kBlocks;
            if (!in_hole(clipmap, level, i, j)) {
                chooser.add(glm::dvec2(clipmap.window(level).first +
                                       glm::ivec2(i, j) * shared::kBlockCells) *
                                Clipmap::spacing(level),
                            level, level < kBoundedLevels);
            }
        }
    }
    if (chooser.blocks.size() > kMostBlocks && detail.on()) {
        detail.zoom = std::max(0.5f * detail.zoom, 1.0f);
        return visible_blocks(clipmap, surface, frustum, anchor, eye_canopy_m, detail);
    }
    std::stable_sort(chooser.blocks.begin(), chooser.blocks.end(),
                     [](const auto& a, const auto& b) { return a.nearest < b.nearest; });
    return std::move(chooser.blocks);
}

std::vector<VisibleBlock> visible_blocks(const Clipmap& clipmap, const Surface& surface,
                                         const Frustum& frustum, glm::dvec3 anchor,
                                         glm::vec4 eye_canopy_m) {
    Detail none;
    return visible_blocks(clipmap, surface, frustum, anchor, eye_canopy_m, none);
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

BlockMesh::~BlockMesh() {
    glDeleteVertexArrays(1, &vertex_array_);
}

void BlockMesh::draw(int instances) const {
    constexpr int kIndices = 6 * shared::kBlockCells * shared::kBlockCells;
    glBindVertexArray(vertex_array_);
    glDrawElementsInstanced(GL_TRIANGLES, kIndices, GL_UNSIGNED_SHORT, nullptr, instances);
}

BlockSamples::BlockSamples() : program_("block samples", {"terrain/block_samples.comp"}) {}

void BlockSamples::reload() {
    program_.reload();
    if (fine_program_) {
        fine_program_->reload();
    }
}

void BlockSamples::execute(const std::vector<VisibleBlock>& blocks, bool fine) {
    if (fine && !fine_program_) {
        fine_program_ = std::make_unique<gl::Program>(
            "fine block samples", std::vector<std::filesystem::path>{"terrain/block_samples.comp"},
            std::vector<std::string>{"FINE_GROUND"});
    }
    std::vector<shared::TerrainBlock> places;
    places.reserve(blocks.size());
    for (const VisibleBlock& block : blocks) {
        places.push_back({block.corner, block.cell, block.level});
    }
    blocks_.reserve(places.size() * sizeof(shared::TerrainBlock));
    blocks_.upload(places.data(), places.size() * sizeof(shared::TerrainBlock));
    const std::size_t count = blocks.size() * shared::kBlockPosts;
    samples_.reserve(count * sizeof(shared::BlockSample));
    blocks_.bind_storage(BIND_TERRAIN_BLOCKS);
    samples_.bind_storage(BIND_BLOCK_SAMPLES);
    const gl::Program& program = fine ? *fine_program_ : program_;
    program.use();
    program.set("sample_count", static_cast<int>(count));
    glDispatchCompute(static_cast<GLuint>((count + SAMPLE_GROUP - 1) / SAMPLE_GROUP), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

namespace {

std::vector<std::string> defines_of(bool aov, bool land, bool fine) {
    std::vector<std::string> defines;
    if (aov) {
        defines.emplace_back("AOV");
    }
    if (!land) {
        defines.emplace_back("NO_LAND");
    }
    if (fine) {
        defines.emplace_back("FINE_GROUND");
    }
    return defines;
}

} // namespace

TerrainPass::TerrainPass(bool aov, bool land)
    : aov_(aov), land_(land), program_("terrain", {"terrain/terrain.vert", "terrain/terrain.frag"},
                                       defines_of(aov, land, false)) {}

void TerrainPass::reload() {
    program_.reload();
    if (fine_program_) {
        fine_program_->reload();
    }
}

void TerrainPass::execute(int blocks, const BlockMesh& mesh, bool fine) {
    if (fine && !fine_program_) {
        fine_program_ = std::make_unique<gl::Program>(
            "fine terrain",
            std::vector<std::filesystem::path>{"terrain/terrain.vert", "terrain/terrain.frag"},
            defines_of(aov_, land_, true));
    }
    (fine ? *fine_program_ : program_).use();
    glEnable(GL_CULL_FACE);
    mesh.draw(blocks);
    glDisable(GL_CULL_FACE);
}

} // namespace sward::terrain
