// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "scene/heightfield.h"

namespace sward::terrain {

/// Least and greatest height of the smooth surface through posts (Catmull-Rom both ways) over any
/// rectangle: a pyramid over the posts, and the surface itself where the rectangle is about as
/// small as a cell. Never too narrow; exact to the hull of Bezier control points, so that a tower
/// of posts between the vertices of a block is seen, and a slope costs no slack.
class PostBounds {
public:
    explicit PostBounds(const scene::Heightfield& field);

    /// Over the rectangle from `low` to `high`, in posts (column, row), clamped to the posts.
    [[nodiscard]] glm::vec2 over(glm::dvec2 low, glm::dvec2 high,
                                 const scene::Heightfield& field) const;
    [[nodiscard]] glm::vec2 all() const { return levels_.back().ranges.front(); }

private:
    struct Level {
        int width = 0, height = 0;
        std::vector<glm::vec2> ranges;
    };
    std::vector<Level>
        levels_; ///< [0]: kBaseCells^2 cells each, then half as many a side; the last is one
};

} // namespace sward::terrain
