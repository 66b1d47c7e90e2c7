// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blades/blade_tiles.h"
#include "gl/buffer.h"
#include "gl/program.h"

namespace sward::blades {

/// Culls blades on the GPU (frustum, density, hand-over) and writes the survivors, in a fixed order, for an indirect draw.
/// A workgroup writes its survivors to its own segment; a second dispatch closes the gaps: no atomics, the same order each run.
class CullPass {
public:
    /// Workgroups a batch; a long list is culled and drawn batch by batch, which bounds memory to 2 MiB * kBatch / 2048.
    static constexpr std::size_t kBatch = 2048;

    CullPass();
    void upload(const TileList& list);
    [[nodiscard]] std::size_t batches() const { return (items_count_ + kBatch - 1) / kBatch; }
    /// Culls one batch; then the visible list and the draw command are bound and ready.
    void execute(std::size_t batch);
    /// Survivors of all batches since upload(). Waits for the GPU.
    [[nodiscard]] std::uint64_t drawn() const;
    [[nodiscard]] const gl::Buffer& command() const { return command_; }
    [[nodiscard]] const gl::Buffer& visible() const { return visible_; }
    void reload();

private:
    gl::Program cull_, compact_;
    gl::Buffer tiles_, items_, segments_, counts_, visible_, command_;
    std::size_t items_count_ = 0;
};

} // namespace sward::blades
