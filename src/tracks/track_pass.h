// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "shared/track.h"
#include "tracks/page_memory.h"

namespace sward::tracks {

/// The pool's cells on the GPU and the passes over them. A page has 6.7 bytes a cell for what lies
/// and for what is seen of it; what moves 32 more a cell, in a pool of blocks. Storage grows with
/// what was ever in use. Cost of a step follows the blocks that it is given: those at rest cost
/// nothing.
class TrackPass {
public:
    /// Bounds of the two pools, and entries of the table that pages are looked up in.
    TrackPass(int most_pages, int most_blocks, int table_size);
    ~TrackPass();
    TrackPass(const TrackPass&) = delete;
    TrackPass& operator=(const TrackPass&) = delete;

    /// Room for so many slots and places of blocks; what they hold stays.
    void reserve(int slots, int places);
    struct Work {
        std::vector<shared::TrackBlock> moving,
            resting; ///< of those at rest only what lasts changes
        std::vector<shared::TrackPrint> prints;
    };
    /// A step of blocks (C1, C2, C4).
    void step(const shared::TrackRules& rules, const Work& work);
    void rebase(std::span<const int> slots);
    /// Brings what is shown of slots up to date; the table must be.
    void show(std::span<const int> slots);
    void set_table(const std::vector<glm::ivec4>& table) {
        table_.upload(table.data(), table.size() * sizeof(glm::ivec4));
    }

    /// What lies in a page: words of its cells. Reading waits for the GPU.
    void put(int slot, const std::vector<std::uint32_t>& pressed);
    [[nodiscard]] std::vector<std::uint32_t> get(int slot) const;
    void clear(int slot);
    /// A block's bends and their changes, appended to a page's.
    void put_block(int place, std::span<const glm::vec4> bends, std::span<const glm::vec4> changes);
    void get_block(int place, PageContent& into) const;
    void clear_block(int place);
    /// One cell: theta, pressed in units of its epoch; `place` of its block, -1: at rest. Waits for
    /// the GPU.
    [[nodiscard]] glm::vec4 cell(int slot, int place, glm::ivec2 at) const;
    /// For lib/track.glsl.
    void bind() const;
    [[nodiscard]] std::size_t bytes() const;
    void reload();

private:
    void bind_cells() const;
    void upload_work(std::span<const shared::TrackBlock> blocks);
    void upload_pages(std::span<const int> slots);
    void dispatch(const gl::Program& program, std::size_t entries, int side) const;
    void point_textures() const;

    int most_pages_, most_blocks_, table_size_, slots_ = 0, places_ = 0;
    gl::Program change_, advance_, press_, rebase_, show_;
    gl::Buffer bends_, changes_, shown_, table_, work_, prints_;
    std::uint32_t textures_[3] = {0, 0, 0};
};

} // namespace sward::tracks
