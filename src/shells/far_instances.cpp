// SPDX-License-Identifier: Apache-2.0
#include "shells/far_instances.h"

#include <algorithm>
#include <cmath>

namespace sward::shells {

namespace {

using terrain::VisibleBlock;

/// A family that shows less than this share of the blades everywhere in a block is not drawn there.
constexpr float kLeastShare = 0.01f;

struct Span {
    float nearest, farthest;
};

float side_of(const VisibleBlock& block) {
    return block.cell * shared::kBlockCells;
}

Span distances(const VisibleBlock& block, glm::vec3 eye, float canopy) {
    const glm::vec3 low(block.corner.x, block.low, block.corner.y);
    const glm::vec3 high(block.corner.x + side_of(block), block.high + canopy,
                         block.corner.y + side_of(block));
    const glm::vec3 gap = glm::max(glm::max(low - eye, eye - high), glm::vec3(0));
    const glm::vec3 far = glm::max(glm::abs(low - eye), glm::abs(high - eye));
    return {glm::length(gap), glm::length(far)};
}

/// Sines of view elevation that far.vert's family_share can look up in a block of these (x lowest,
/// y highest), for bent grass: down to the elevation about its own direction, up where it points at
/// the eye. Local winds blow a third harder and some 15 degrees off.
glm::vec2 seen_bent(glm::vec2 sines, const VisibleBlock& block, const FarQuery& query) {
    const float most = std::min(1.3f * glm::length(query.bend), 1.0f);
    const glm::vec2 middle = block.corner + 0.5f * side_of(block);
    const glm::vec2 to_eye(query.eye.x - middle.x, query.eye.z - middle.y);
    const float away = glm::length(to_eye);
    const float toward =
        away > side_of(block) ? 1.3f * glm::dot(query.bend, to_eye) / away + 0.3f * most : most;
    return glm::clamp(sines + glm::vec2(-1.1f * most, most * most * std::max(toward, 0.0f)), 0.0f,
                      1.0f);
}

/// Largest shares of the blades that the shells of each level (x to w) and the slices of a block
/// show, over the elevations it is seen at.
struct LargestShares {
    glm::vec4 shells{0};
    float slices = 0;
};

LargestShares largest_shares(float canopy, const VisibleBlock& block, const FarQuery& query) {
    const Span span = distances(block, query.eye, canopy);
    const float drop = query.eye.y - 0.5f * (block.low + block.high);
    const float spread = 0.5f * block.slope * side_of(block) + canopy;
    // A slope turns toward the eye by its own angle at most.
    const float low =
        std::clamp((drop - spread) / std::max(span.farthest, 1e-3f) - block.slope, 0.0f, 1.0f);
    const float high =
        std::clamp((drop + spread) / std::max(span.nearest, 1e-3f) + block.slope, 0.0f, 1.0f);
    const glm::vec2 sines = seen_bent({low, high}, block, query);
    LargestShares largest;
    for (int i = 0; i <= 4; ++i) { // far.vert's look-up
        const float sine =
            glm::mix(std::min(sines.x, low), std::max(sines.y, high), static_cast<float>(i) / 4);
        const float at =
            std::asin(std::min(sine, 0.99999f)) * (shared::kShareSteps / (0.5f * shared::kPi));
        const auto row = static_cast<int>(at);
        const float part = at - static_cast<float>(row);
        largest.shells =
            glm::max(largest.shells, glm::mix(query.shares.steps[row].shells,
                                              query.shares.steps[row + 1].shells, part));
        largest.slices =
            std::max(largest.slices, glm::mix(query.shares.steps[row].slices,
                                              query.shares.steps[row + 1].slices, part));
    }
    return largest;
}

/// Distances (m, horizontal) between which a level may show a blade over a block.
Span reach(const grass::GrassSet& set, const VisibleBlock& block, const lod::Bands& bands,
           const FarQuery& query, int k) {
    const glm::vec4 band = bands.far[static_cast<std::size_t>(k)];
    float from = k == 0 && query.alone ? 0.0f : band.x;
    float to = band.w;
    if (query.forced_level >= 0) {
        from = 0;
        to = k == query.forced_level ? bands.far[set.levels.size() - 1].w : -1;
    }
    const float drop_most = std::max(std::abs(query.lod_eye.y - block.low),
                                     std::abs(query.lod_eye.y - block.high - set.canopy_m));
    const float drop_least =
        std::max({query.lod_eye.y - block.high - set.canopy_m, block.low - query.lod_eye.y, 0.0f});
    // A blade's root may lie as far from the texel that shows its tip as offsets go.
    const float nearest =
        std::sqrt(std::max(from * from - drop_most * drop_most, 0.0f)) - set.offset_range_m;
    const float farthest =
        to > drop_least ? std::sqrt(to * to - drop_least * drop_least) + set.offset_range_m : -1.0f;
    return {nearest, farthest};
}

/// Cells of a block from `first` to before `end`; none when they are equal.
struct Cells {
    int first = 0, end = 0;
    [[nodiscard]] glm::ivec2 range() const { return {first, end}; }
};

/// Of the block's cells along one axis, those that come within reach while the other coordinate
/// runs over [low, high]; all relative to the eye.
Cells cells_within(float start, float cell, glm::vec2 across, const Span& within) {
    const float across_least =
        across.x <= 0 && across.y >= 0 ? 0.0f : std::min(std::abs(across.x), std::abs(across.y));
    const float across_most = std::max(std::abs(across.x), std::abs(across.y));
    Cells cells;
    for (int i = 0; i < shared::kBlockCells; ++i) {
        const float low = start + cell * static_cast<float>(i), high = low + cell;
        const float least = low <= 0 && high >= 0 ? 0.0f : std::min(std::abs(low), std::abs(high));
        const float most = std::max(std::abs(low), std::abs(high));
        if (std::hypot(most, across_most) >= within.nearest &&
            std::hypot(least, across_least) <= within.farthest) {
            cells.first = cells.end == 0 ? i : cells.first;
            cells.end = i + 1;
        }
    }
    return cells;
}

/// Largest |component| on `axis` of the horizontal direction from the eye to any point of the
/// block.
float largest_share(const VisibleBlock& block, glm::vec3 eye, int axis) {
    float largest = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::vec2 p = block.corner + side_of(block) * glm::vec2(corner & 1, corner >> 1) -
                            glm::vec2(eye.x, eye.z);
        const float length = glm::length(p);
        largest = std::max(largest, length > 1e-3f ? std::abs(p[axis]) / length : 1.0f);
    }
    // A block around the eye's meridian holds directions that its corners do not.
    const glm::vec2 low = block.corner - glm::vec2(eye.x, eye.z);
    const glm::vec2 high = low + side_of(block);
    return low[1 - axis] < 0 && high[1 - axis] > 0 ? 1.0f : largest;
}

struct Place {
    const VisibleBlock& block;
    int index;
    int level;
    Span within;
};

void add_shells(std::vector<shared::FarInstance>& out, const Place& at, const grass::GrassSet& set,
                const FarQuery& query) {
    const grass::FarLevel& level = set.levels[static_cast<std::size_t>(at.level)];
    const int count = level.layer_count;
    const glm::vec2 low = at.block.corner - glm::vec2(query.lod_eye.x, query.lod_eye.z);
    const glm::vec2 high = low + side_of(at.block);
    const Cells x = cells_within(low.x, at.block.cell, {low.y, high.y}, at.within);
    const Cells z = cells_within(low.y, at.block.cell, {low.x, high.x}, at.within);
    if (x.end == 0 || z.end == 0) {
        return;
    }
    for (int i = count - 1; i >= 0; --i) {
        const float y = level.layer_heights[static_cast<std::size_t>(i)];
        out.push_back({y, at.index, x.range(), z.range(),
                       grass::layer_image(set, level, 0, i, shared::kPlaneId),
                       grass::layer_images(set, level) * shared::kPlanes, 0, at.level});
    }
}

void add_slices(std::vector<shared::FarInstance>& out, const Place& at, const grass::GrassSet& set,
                const FarQuery& query) {
    const VisibleBlock& block = at.block;
    const int count = set.levels[static_cast<std::size_t>(at.level)].slice_count;
    const double gap = static_cast<double>(set.side_m) / count;
    const glm::vec2 eye(query.lod_eye.x, query.lod_eye.z);
    for (int axis = 0; axis < 2; ++axis) {
        if (largest_share(block, query.eye, axis) < kLeastShare) {
            continue;
        }
        const double low = block.corner[axis] + query.patch_offset[axis];
        const int first = static_cast<int>(std::ceil(low / gap - 0.5));
        const int last = static_cast<int>(std::ceil((low + side_of(block)) / gap - 0.5)) - 1;
        const bool rising = block.corner[axis] + 0.5f * side_of(block) > eye[axis];
        for (int n = 0; n <= last - first; ++n) {
            const int m = rising ? first + n : last - n;
            const int slice = ((m % count) + count) % count;
            const auto plane = static_cast<float>((m + 0.5) * gap - query.patch_offset[axis]);
            const float off = plane - eye[axis];
            const Cells along = cells_within(block.corner[1 - axis] - eye[1 - axis], block.cell,
                                             {off, off}, at.within);
            if (along.end > 0) {
                out.push_back({plane,
                               at.index,
                               along.range(),
                               {0, 0},
                               shared::slice_index(0, axis, slice, count, shared::kPlaneId),
                               2 * count * shared::kPlanes,
                               axis,
                               at.level});
            }
        }
    }
}

} // namespace

FarList select_far(const grass::GrassSet& set, const std::vector<VisibleBlock>& blocks,
                   const lod::Bands& bands, const FarQuery& query) {
    FarList list;
    for (std::size_t index = 0; index < blocks.size(); ++index) {
        const VisibleBlock& block = blocks[index];
        const LargestShares shown = largest_shares(set.canopy_m, block, query);
        for (std::size_t k = 0; k < set.levels.size(); ++k) {
            const int level = static_cast<int>(k);
            const Place place{block, static_cast<int>(index), level,
                              reach(set, block, bands, query, level)};
            if (place.within.farthest < 0) {
                continue;
            }
            if (shown.shells[level] >= kLeastShare) {
                add_shells(list.shells[k], place, set, query);
            }
            if (shown.slices >= kLeastShare) {
                add_slices(list.slices[k], place, set, query);
            }
        }
    }
    return list;
}

} // namespace sward::shells
