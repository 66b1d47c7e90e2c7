// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gl/buffer.h"
#include "gl/program.h"
#include "shells/far_instances.h"
#include "shells/far_textures.h"
#include "terrain/terrain_pass.h"

namespace sward::shells {

/// Draws one family of the far tier: the shells, or the slices across x and z. Before: frame constants and clipmap are bound,
/// the ground and the blades are drawn. One program, compiled for each family.
class FarPass {
public:
    enum class Family { kShells, kSlices };
    FarPass(Family family, bool aov);
    ~FarPass();
    FarPass(const FarPass&) = delete;
    FarPass& operator=(const FarPass&) = delete;

    struct Inputs {
        const FarTextures& textures;
        const std::array<std::vector<shared::FarInstance>, shared::kMaxFarLevels>& instances;
        const terrain::BlockMesh& mesh;
    };
    void execute(const Inputs& inputs);
    /// Samples that passed every test in the last execute(); waits for the GPU.
    [[nodiscard]] std::uint64_t samples_passed() const;
    void reload() { program_.reload(); }

private:
    Family family_;
    gl::Program program_;
    gl::Buffer instances_, strip_;
    std::uint32_t strip_array_ = 0;
    std::uint32_t query_ = 0;
};

} // namespace sward::shells
