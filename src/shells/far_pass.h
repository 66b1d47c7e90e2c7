// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gl/buffer.h"
#include "gl/program.h"
#include "shells/far_instances.h"
#include "shells/far_textures.h"
#include "terrain/terrain_pass.h"

namespace sward::shells {

/// Draws one family of the far tier: the shells, or the slices across x and z. Before: frame
/// constants and block samples are bound, the ground and the blades are drawn. (A depth pass first,
/// then a shading pass at equal depth, was a third slower in software: the vertices and the depth
/// tests cost more than the light that they spare.)
class FarPass {
public:
    enum class Family { kShells, kSlices };
    /// `block_shapes`: as FarTextures says of the set that will be drawn.
    FarPass(Family family, bool aov, bool block_shapes);
    ~FarPass();
    FarPass(const FarPass&) = delete;
    FarPass& operator=(const FarPass&) = delete;

    struct Inputs {
        const FarTextures& textures;
        const std::array<std::vector<shared::FarInstance>, shared::kMaxFarLevels>& instances;
        const terrain::BlockMesh& mesh;
        const shared::FarShares& shares;
    };
    void execute(const Inputs& inputs);
    /// Samples that passed every test in the last execute(); waits for the GPU.
    [[nodiscard]] std::uint64_t samples_passed() const;
    void reload() { program_.reload(); }

private:
    Family family_;
    void draw_level(std::size_t k, const Inputs& inputs) const;
    gl::Program program_;
    std::array<gl::Buffer, shared::kMaxFarLevels> instances_;
    gl::Buffer strip_, shares_;
    std::uint32_t strip_array_ = 0;
    std::uint32_t query_ = 0;
};

} // namespace sward::shells
