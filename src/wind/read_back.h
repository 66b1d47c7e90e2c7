// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "gl/buffer.h"
#include "wind/state.h"

namespace sward::wind {

/// Copies of a buffer of cells that arrive on the CPU when they are ready: a ring of mapped buffers
/// with fences, so that no frame waits. One slot holds what has landed, the others are on their
/// way.
class ReadBack {
public:
    explicit ReadBack(std::size_t bytes);
    ~ReadBack();
    ReadBack(const ReadBack&) = delete;
    ReadBack& operator=(const ReadBack&) = delete;

    /// Starts a copy; does nothing while every slot is under way (a later state will come).
    void start(const gl::Buffer& cells, const StateTag& tag);
    /// Takes what has arrived since the last call. `wait`: waits for all that was started.
    void poll(bool wait = false);
    /// Forgets everything.
    void clear();
    [[nodiscard]] bool landed() const { return landed_ >= 0; }
    [[nodiscard]] std::span<const glm::vec4> cells() const;
    [[nodiscard]] const StateTag& tag() const {
        return slots_[static_cast<std::size_t>(landed_)].tag;
    }

private:
    struct Slot {
        std::uint32_t buffer = 0;
        const glm::vec4* mapped = nullptr;
        void* fence = nullptr; ///< GLsync; null: not under way
        std::uint64_t order = 0;
        StateTag tag;
    };
    void release(Slot& slot);
    std::size_t bytes_;
    std::array<Slot, 3> slots_;
    std::uint64_t started_ = 0;
    int landed_ = -1;
};

} // namespace sward::wind
