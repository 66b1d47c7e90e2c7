// SPDX-License-Identifier: Apache-2.0
#include "gl/buffer.h"

#include <utility>

#include <epoxy/gl.h>

#include "gl/memory.h"

namespace sward::gl {

namespace {
std::uint64_t g_bytes = 0; // the context's thread only
}

std::uint64_t gpu_bytes() {
    return g_bytes;
}
void count_gpu_bytes(std::int64_t delta) {
    g_bytes += static_cast<std::uint64_t>(delta);
}

Buffer::Buffer(std::size_t bytes) : bytes_(bytes) {
    glCreateBuffers(1, &id_);
    glNamedBufferStorage(id_, static_cast<GLsizeiptr>(bytes ? bytes : 1), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    count_gpu_bytes(static_cast<std::int64_t>(bytes_));
}

Buffer::~Buffer() {
    if (id_) {
        glDeleteBuffers(1, &id_);
        count_gpu_bytes(-static_cast<std::int64_t>(bytes_));
    }
}

Buffer::Buffer(Buffer&& other) noexcept
    : id_(std::exchange(other.id_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void Buffer::upload(const void* data, std::size_t bytes, std::size_t offset) {
    if (bytes) {
        glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                             data);
    }
}

void Buffer::reserve(std::size_t bytes) {
    if (bytes > bytes_) {
        *this = Buffer(bytes + bytes / 2);
    }
}

void Buffer::clear_to_zero() {
    glClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void Buffer::read(void* data, std::size_t bytes, std::size_t offset) const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                            data);
}

void Buffer::bind_storage(std::uint32_t binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}
void Buffer::bind_uniform(std::uint32_t binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
}

} // namespace sward::gl
