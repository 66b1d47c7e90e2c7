// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sward::gl {

/// Buffer object; moves, does not copy.
class Buffer {
public:
    Buffer() = default;
    /// `bytes` of storage that upload() may change; contents undefined until then.
    explicit Buffer(std::size_t bytes);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    template<class T> static Buffer of(std::span<const T> items) {
        Buffer buffer(items.size_bytes());
        buffer.upload(items.data(), items.size_bytes());
        return buffer;
    }

    void upload(const void* data, std::size_t bytes, std::size_t offset = 0);
    /// Grows (contents lost) to at least `bytes`, by half again so that growth is rare.
    void reserve(std::size_t bytes);
    void clear_to_zero();
    /// Copies out; waits for the GPU.
    void read(void* data, std::size_t bytes, std::size_t offset = 0) const;
    template<class T> [[nodiscard]] std::vector<T> read_all(std::size_t count) const {
        std::vector<T> items(count);
        read(items.data(), count * sizeof(T));
        return items;
    }
    void bind_storage(std::uint32_t binding) const;
    void bind_uniform(std::uint32_t binding) const;
    [[nodiscard]] std::uint32_t id() const { return id_; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

private:
    std::uint32_t id_ = 0;
    std::size_t bytes_ = 0;
};

} // namespace sward::gl
