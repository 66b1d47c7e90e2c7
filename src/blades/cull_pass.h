// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blades/blade_tiles.h"
#include "blades/cull_tests.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "shared/bindings.h"

namespace sward::blades {

/// Culls blades on the GPU (frustum, density, hand-over) into an indirect draw. A workgroup writes
/// its survivors to its own segment and its own draw command: the same order each run, and no
/// global atomics but one count. Small draws matter in software too: llvmpipe's clipper goes over
/// all vertices of a draw again and again once one of them is clipped.
class CullPass {
public:
    /// Workgroups a batch; a long list is culled and drawn batch by batch, which bounds memory to 2
    /// MiB * kBatch / 2048.
    static constexpr std::size_t kBatch = 2048;

    /// `defines`: SURFACE for the blades of a mesh.
    explicit CullPass(std::vector<std::string> defines = {});
    /// `keep_total`: later pictures of one frame add to its count of survivors.
    void upload(const TileList& list, bool keep_total = false);
    [[nodiscard]] std::size_t batches() const { return (items_count_ + kBatch - 1) / kBatch; }
    [[nodiscard]] static std::size_t batches_of(const TileList& list) {
        return (list.items.size() + kBatch - 1) / kBatch;
    }
    /// Culls one batch; then its survivors and draw commands are ready. Reads the depth pyramid
    /// where occlusion is tested.
    void execute(std::size_t batch, const CullTests& tests);
    /// By CULL_*: blades kept, and those that each test took from what the tests before it left. Of
    /// all batches since the count began. Waits for the GPU.
    [[nodiscard]] std::array<std::uint32_t, CULL_COUNTS> counts() const;
    [[nodiscard]] std::uint64_t bytes() const; ///< of its buffers
    [[nodiscard]] const gl::Buffer& commands() const { return commands_; }
    [[nodiscard]] int command_count() const { return command_count_; }
    [[nodiscard]] const gl::Buffer& survivors() const { return survivors_; }
    [[nodiscard]] const gl::Program& program() const { return program_; }
    void reload() { program_.reload(); }

private:
    gl::Program program_;
    gl::Buffer tiles_, items_, survivors_, commands_, total_;
    std::size_t items_count_ = 0;
    int command_count_ = 0;
};

} // namespace sward::blades
