// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace sward::texgen {

struct TextStyle {
    int size = 2; ///< pixels a dot; a letter is some 6 dots wide and 7 high
    glm::dvec3 colour{0.16};
};

/// A picture of linear colour that other pictures and words are put on.
struct Canvas {
    int width, height;
    std::vector<glm::dvec3> texels;

    Canvas(int w, int h, glm::dvec3 colour)
        : width(w), height(h),
          texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), colour) {}
    glm::dvec3& at(int x, int y) {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    const glm::dvec3& at(int x, int y) const {
        return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }

    /// Area average of `source` over the rectangle at x0, y0, which must lie inside.
    void place(const Canvas& source, int x0, int y0, int w, int h);
    void fill(int x0, int y0, int w, int h, glm::dvec3 colour);
    /// ASCII; any other byte is a blank.
    void text(std::string_view words, int x0, int y0, const TextStyle& style = {});
};

[[nodiscard]] int text_width(std::string_view words, int size);

} // namespace sward::texgen
