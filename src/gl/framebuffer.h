// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gl/texture.h"

namespace sward::gl {

/// Framebuffer over textures that someone else owns.
class Framebuffer {
public:
    Framebuffer() = default;
    /// Colour attachments in order; `depth` may be null. Throws Error(kNoGpu) when incomplete.
    Framebuffer(const std::vector<const Texture*>& colour, const Texture* depth);
    ~Framebuffer();
    Framebuffer(Framebuffer&& other) noexcept;
    Framebuffer& operator=(Framebuffer&& other) noexcept;

    void bind(int width, int height) const; ///< for drawing, with the viewport set
    [[nodiscard]] std::uint32_t id() const { return id_; }

private:
    std::uint32_t id_ = 0;
};

} // namespace sward::gl
