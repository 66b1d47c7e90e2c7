// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "scene/heightfield.h"

namespace sward::terrain {

/// Shadow of the land for one sun: for every post the two heights over it at which the sun's disc
/// begins to be seen and is wholly seen (m; below 0: on the ground already). Lines towards the sun
/// are followed away from it, row by row of posts, with the height of the shadow that each carries:
/// every post is looked at once a line, however far the land goes, so no shadow ends before the
/// rim. Outside the posts the rim's height goes on. Procedural relief throws none. No GL.
class SunSweep {
public:
    static constexpr int kMostPosts =
        2048; ///< a side; of larger elevation every second, third ... post is taken
    static constexpr double kRadius_deg = 0.267; ///< of the sun's disc
    static constexpr float kFarBelow_m = -20000;

    explicit SunSweep(const scene::Heightfield& elevation);

    /// For a sun in this direction (unit, y up); a sun under the horizon or overhead is taken as
    /// just beside.
    void begin(const glm::dvec3& to_sun);
    /// Goes on by rows of posts, of row_posts() each; whether it is through.
    bool advance(int rows);
    [[nodiscard]] int row_posts() const { return lines_; }

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] int step() const {
        return step_;
    } ///< posts of the elevation from one of ours to the next
    /// width() * height() pairs, row-major, packed as two halves. Of use once advance() has said
    /// so.
    [[nodiscard]] const std::vector<std::uint32_t>& seen_from() const { return seen_from_; }
    [[nodiscard]] glm::vec2 seen_from(int i, int j) const;

private:
    struct Carried {
        float whole; ///< height over the datum under which the land hides something of the disc
        float rows;  ///< from what throws that shadow
    };
    [[nodiscard]] float post(int along, float across) const;
    [[nodiscard]] std::size_t index(int along, int across) const;

    const scene::Heightfield& elevation_;
    int step_, width_, height_;
    std::vector<std::uint32_t> seen_from_;
    std::vector<Carried> carried_;
    bool along_x_ = true, from_end_ = true;
    int rows_ = 0, across_ = 0, row_ = 0, lines_ = 0, first_line_ = 0;
    float drift_ = 0;  ///< posts across that a line goes aside from one row to the next, away from
                       ///< the sun negative
    float fall_ = 0;   ///< of the disc's lower rim's shadow from one row to the next (m)
    float widens_ = 0; ///< and how much more its upper rim's falls
};

} // namespace sward::terrain
