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

/// The pool's cells on the GPU and the passes over them. 40 bytes a cell that are stepped, 11 that are shown; storage grows with the slots that
/// were ever in use. Cost of a step follows the pages that it is given: those asleep cost nothing.
class TrackPass {
public:
    explicit TrackPass(int table_size);
    ~TrackPass();
    TrackPass(const TrackPass&) = delete;
    TrackPass& operator=(const TrackPass&) = delete;

    /// Room for so many slots; what they hold stays.
    void reserve(int slots);
    /// A step of pages (C1, C2, C4); `press_only`: of what lasts alone, in the TRACK_GROUP x TRACK_GROUP cells from the one that an entry names.
    void step(const shared::TrackRules& rules, std::span<const shared::TrackPage> pages, std::span<const shared::TrackPrint> prints, bool press_only);
    void rebase(std::span<const int> slots, float factor);
    /// Brings what is shown of slots up to date.
    void show(std::span<const int> slots);
    void set_table(const std::vector<glm::ivec4>& table) { table_.upload(table.data(), table.size() * sizeof(glm::ivec4)); }

    void put(int slot, const PageContent& content);
    /// Waits for the GPU. Bends are left out where `moves` is false.
    [[nodiscard]] PageContent get(int slot, bool moves) const;
    /// One cell: theta, pressed in units of its epoch. Waits for the GPU.
    [[nodiscard]] glm::vec4 cell(int slot, glm::ivec2 place) const;
    /// Sets a slot to nothing; `bends_only`: what lies stays.
    void clear(int slot, bool bends_only);
    /// For lib/track.glsl.
    void bind() const;
    [[nodiscard]] std::size_t bytes() const;
    void reload();

private:
    void bind_cells() const;
    void upload_pages(std::span<const int> slots);
    void dispatch(const gl::Program& program, std::size_t pages, int side) const;
    void point_textures() const;

    int slots_ = 0;
    gl::Program change_, advance_, press_, rebase_, show_;
    gl::Buffer bends_, changes_, pressed_, shown_, table_, pages_, prints_;
    std::uint32_t textures_[2] = {0, 0};
};

} // namespace sward::tracks
