// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sward::gl {

struct TextureShape {
    int width = 1;
    int height = 1;
    int layers = 0; ///< 0: a plain 2D texture
    int mips = 1;
    int samples = 0; ///< > 0: multisampled, no layers, no mips
};

/// Immutable 2D, 2D-array or multisample texture; moves, does not copy. Throws Error(kNoGpu) when
/// memory runs out.
class Texture {
public:
    Texture() = default;
    Texture(std::uint32_t internal_format, const TextureShape& shape);
    ~Texture();
    Texture(Texture&& other) noexcept;
    Texture& operator=(Texture&& other) noexcept;

    /// Replaces one mip (all layers); `data` is tightly packed.
    void upload(int mip, std::uint32_t format, std::uint32_t type, const void* data);
    /// Replaces `rows` rows of a plain texture, from row `first` on.
    void upload_rows(int first, int rows, std::uint32_t format, std::uint32_t type,
                     const void* data);
    /// Likewise for a block-compressed array: `bytes` of whole blocks.
    void upload_blocks(int mip, std::uint32_t internal_format, const void* data, std::size_t bytes);
    void set_filter(std::uint32_t minify, std::uint32_t magnify);
    void set_wrap(std::uint32_t s, std::uint32_t t);
    void bind(std::uint32_t unit) const;
    [[nodiscard]] std::uint32_t id() const { return id_; }
    [[nodiscard]] const TextureShape& shape() const { return shape_; }
    /// Level 0 of a single-sampled 2D texture, or one layer of an array, as floats; waits for the
    /// GPU.
    [[nodiscard]] std::vector<float> read_floats(int components, int layer = 0) const;

private:
    std::uint32_t id_ = 0;
    TextureShape shape_;
    std::int64_t bytes_ = 0;
};

} // namespace sward::gl
