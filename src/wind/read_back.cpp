// SPDX-License-Identifier: Apache-2.0
#include "wind/read_back.h"

#include <epoxy/gl.h>

#include "gl/memory.h"

namespace sward::wind {

ReadBack::ReadBack(std::size_t bytes) : bytes_(bytes) {
    constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    for (Slot& slot : slots_) {
        glCreateBuffers(1, &slot.buffer);
        glNamedBufferStorage(slot.buffer, static_cast<GLsizeiptr>(bytes_), nullptr,
                             kAccess | GL_CLIENT_STORAGE_BIT);
        slot.mapped = static_cast<const glm::vec4*>(
            glMapNamedBufferRange(slot.buffer, 0, static_cast<GLsizeiptr>(bytes_), kAccess));
        gl::count_gpu_bytes(static_cast<std::int64_t>(bytes_));
    }
}

ReadBack::~ReadBack() {
    clear();
    for (Slot& slot : slots_) {
        glUnmapNamedBuffer(slot.buffer);
        glDeleteBuffers(1, &slot.buffer);
        gl::count_gpu_bytes(-static_cast<std::int64_t>(bytes_));
    }
}

void ReadBack::release(Slot& slot) {
    if (slot.fence) {
        glDeleteSync(static_cast<GLsync>(slot.fence));
        slot.fence = nullptr;
    }
}

void ReadBack::clear() {
    for (Slot& slot : slots_) {
        release(slot);
    }
    landed_ = -1;
}

void ReadBack::start(const gl::Buffer& cells, const StateTag& tag) {
    for (int i = 0; i < static_cast<int>(slots_.size()); ++i) {
        Slot& slot = slots_[static_cast<std::size_t>(i)];
        if (slot.fence || i == landed_ || !slot.mapped) {
            continue;
        }
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
        glCopyNamedBufferSubData(cells.id(), slot.buffer, 0, 0, static_cast<GLsizeiptr>(bytes_));
        slot.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        slot.order = ++started_;
        slot.tag = tag;
        return;
    }
}

void ReadBack::poll(bool wait) {
    for (int i = 0; i < static_cast<int>(slots_.size()); ++i) {
        Slot& slot = slots_[static_cast<std::size_t>(i)];
        if (!slot.fence) {
            continue;
        }
        const GLuint64 patience = wait ? GL_TIMEOUT_IGNORED : 0;
        const GLenum state = glClientWaitSync(static_cast<GLsync>(slot.fence),
                                              wait ? GL_SYNC_FLUSH_COMMANDS_BIT : 0, patience);
        if (state == GL_ALREADY_SIGNALED || state == GL_CONDITION_SATISFIED) {
            release(slot);
            if (landed_ < 0 || slot.order > slots_[static_cast<std::size_t>(landed_)].order) {
                landed_ = i;
            }
        }
    }
}

std::span<const glm::vec4> ReadBack::cells() const {
    return {slots_[static_cast<std::size_t>(landed_)].mapped, bytes_ / sizeof(glm::vec4)};
}

} // namespace sward::wind
