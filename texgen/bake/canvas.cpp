// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/canvas.h"

#include <algorithm>
#include <string>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <stb/stb_easy_font.h> // strokes of a letter, the same on every machine
#pragma GCC diagnostic pop

namespace sward::texgen {
namespace {

using glm::dvec3;

/// What the font knows: ASCII that can be seen; the rest as blanks.
std::string letters_of(std::string_view words) {
    std::string letters(words);
    for (char& c : letters)
        if (c < ' ' || c > '~')
            c = ' ';
    return letters;
}

/// As stb_easy_font writes a corner of a stroke.
struct Corner {
    float x, y, z;
    unsigned char colour[4];
};
static_assert(sizeof(Corner) == 16);
constexpr std::size_t kStrokesALetter = 16; // more than any letter has

} // namespace

void Canvas::place(const Canvas& source, int x0, int y0, int w, int h) {
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            dvec3 sum(0);
            int count = 0;
            const int u1 = std::max(x * source.width / w + 1, (x + 1) * source.width / w);
            const int v1 = std::max(y * source.height / h + 1, (y + 1) * source.height / h);
            for (int v = y * source.height / h; v < v1; ++v)
                for (int u = x * source.width / w; u < u1; ++u, ++count)
                    sum += source.at(u, v);
            at(x0 + x, y0 + y) = sum / static_cast<double>(count);
        }
}

void Canvas::fill(int x0, int y0, int w, int h, dvec3 colour) {
    for (int y = std::max(0, y0); y < std::min(height, y0 + h); ++y)
        for (int x = std::max(0, x0); x < std::min(width, x0 + w); ++x)
            at(x, y) = colour;
}

void Canvas::text(std::string_view words, int x0, int y0, const TextStyle& style) {
    std::string letters = letters_of(words);
    std::vector<Corner> corners(letters.size() * kStrokesALetter * 4);
    const int strokes = stb_easy_font_print(0, 0, letters.data(), nullptr, corners.data(),
                                            static_cast<int>(corners.size() * sizeof(Corner)));
    for (std::size_t i = 0; i < static_cast<std::size_t>(strokes); ++i) {
        const Corner &first = corners[4 * i], &last = corners[4 * i + 2];
        const glm::ivec2 from(first.x, first.y), to(last.x, last.y);
        fill(x0 + from.x * style.size, y0 + from.y * style.size, (to.x - from.x) * style.size,
             (to.y - from.y) * style.size, style.colour);
    }
}

int text_width(std::string_view words, int size) {
    return stb_easy_font_width(letters_of(words).data()) * size;
}

} // namespace sward::texgen
