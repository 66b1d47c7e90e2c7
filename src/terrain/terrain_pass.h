// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "shared/frame.h"
#include "terrain/clipmap.h"
#include "terrain/detail.h"
#include "terrain/frustum.h"

namespace sward::terrain {

/// A block of the clipmap's grid that may be seen, nearest first. The far tier draws its shells
/// over the same blocks, so that shells and ground are one mesh.
struct VisibleBlock {
    glm::vec2 corner; ///< anchor-relative metres
    float cell = 0;   ///< metres
    int level = 0;
    float low = 0, high = 0; ///< bounds of the ground, anchor-relative metres
    float slope = 1;         ///< steepest rise over run within it, roughly
    float nearest = 0;       ///< horizontal distance from the eye to the block (m)
};

/// Blocks of every level that may be seen, without the holes that finer levels fill, sorted by
/// distance. `anchor`: world metres (x, height, z); `eye`: anchor-relative; `canopy_m`: of what
/// stands on the ground. Through a long lens blocks are split until they are as fine as `detail`
/// asks; where that would be too many, its zoom is halved.
[[nodiscard]] std::vector<VisibleBlock> visible_blocks(const Clipmap& clipmap,
                                                       const Surface& surface,
                                                       const Frustum& frustum, glm::dvec3 anchor,
                                                       glm::vec4 eye_canopy_m);
[[nodiscard]] std::vector<VisibleBlock> visible_blocks(const Clipmap& clipmap,
                                                       const Surface& surface,
                                                       const Frustum& frustum, glm::dvec3 anchor,
                                                       glm::vec4 eye_canopy_m, Detail& detail);

/// Index buffer of a block's 8 x 8 cells as triangles: terrain and shells draw the same mesh.
class BlockMesh {
public:
    BlockMesh();
    ~BlockMesh();
    BlockMesh(const BlockMesh&) = delete;
    BlockMesh& operator=(const BlockMesh&) = delete;
    void draw(int instances) const;

private:
    gl::Buffer indices_;
    std::uint32_t vertex_array_ = 0;
};

/// Evaluates ground and wind once at every vertex of the visible blocks. Before: frame constants
/// and clipmap are bound. After: blocks and samples are bound for the ground, the shells and the
/// slices.
class BlockSamples {
public:
    BlockSamples();
    /// `fine`: after Clipmap::bind_posts.
    void execute(const std::vector<VisibleBlock>& blocks, bool fine = false);
    void reload();

private:
    gl::Program program_;
    std::unique_ptr<gl::Program> fine_program_; ///< made for the first long lens
    gl::Buffer blocks_, samples_;
};

/// Draws the ground. Before: frame constants, clipmap, block samples and far appearance are bound.
class TerrainPass {
public:
    TerrainPass(bool aov, bool land);
    void execute(int blocks, const BlockMesh& mesh, bool fine = false);
    void reload();

private:
    bool aov_, land_;
    gl::Program program_;
    std::unique_ptr<gl::Program> fine_program_;
};

} // namespace sward::terrain
