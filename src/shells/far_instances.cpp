// SPDX-License-Identifier: Apache-2.0
#include "shells/far_instances.h"

#include <algorithm>
#include <cmath>

#include "shells/far_appearance.h"

namespace sward::shells {

namespace {

using terrain::VisibleBlock;

/// A family that shows less than this share of the blades everywhere in a block is not drawn there.
constexpr float kLeastShare = 0.01f;

struct Span {
    float nearest, farthest;
};

float side_of(const VisibleBlock& block) { return block.cell * shared::kBlockCells; }

Span distances(const VisibleBlock& block, glm::vec3 eye, float canopy) {
    const glm::vec3 low(block.corner.x, block.low, block.corner.y);
    const glm::vec3 high(block.corner.x + side_of(block), block.high + canopy, block.corner.y + side_of(block));
    const glm::vec3 gap = glm::max(glm::max(low - eye, eye - high), glm::vec3(0));
    const glm::vec3 far = glm::max(glm::abs(low - eye), glm::abs(high - eye));
    return {glm::length(gap), glm::length(far)};
}

/// Largest share of level k's blades that the shells of a block show, over the elevations it is seen at.
float largest_shell_share(const grass::GrassSet& set, const VisibleBlock& block, const FarQuery& query, int k) {
    const Span span = distances(block, query.eye, set.canopy_m);
    const float drop = query.eye.y - 0.5f * (block.low + block.high);
    const float spread = 0.5f * block.slope * side_of(block) + set.canopy_m;
    // A slope turns toward the eye by its own angle at most.
    const float low = std::clamp((drop - spread) / std::max(span.farthest, 1e-3f) - block.slope, 0.0f, 1.0f);
    const float high = std::clamp((drop + spread) / std::max(span.nearest, 1e-3f) + block.slope, 0.0f, 1.0f);
    float largest = 0;
    for (int i = 0; i <= 4; ++i) {
        largest = std::max(largest, shell_share_at(set, std::asin(glm::mix(low, high, static_cast<float>(i) / 4)))[k]);
    }
    return largest;
}

/// Does level k show any blade between these distances?
bool level_shows(const lod::Bands& bands, const FarQuery& query, int k, const Span& span, int levels) {
    const glm::vec4 band = bands.far[static_cast<std::size_t>(k)];
    if (query.forced_level >= 0) {
        return k == query.forced_level && span.nearest < bands.far[static_cast<std::size_t>(levels - 1)].w;
    }
    const float from = k == 0 && query.alone ? 0.0f : band.x;
    return span.farthest > from && span.nearest < band.w;
}

/// Largest |component| on `axis` of the horizontal direction from the eye to any point of the block.
float largest_share(const VisibleBlock& block, glm::vec3 eye, int axis) {
    float largest = 0;
    for (int corner = 0; corner < 4; ++corner) {
        const glm::vec2 p = block.corner + side_of(block) * glm::vec2(corner & 1, corner >> 1) - glm::vec2(eye.x, eye.z);
        const float length = glm::length(p);
        largest = std::max(largest, length > 1e-3f ? std::abs(p[axis]) / length : 1.0f);
    }
    // A block around the eye's meridian holds directions that its corners do not.
    const glm::vec2 low = block.corner - glm::vec2(eye.x, eye.z);
    const glm::vec2 high = low + side_of(block);
    return low[1 - axis] < 0 && high[1 - axis] > 0 ? 1.0f : largest;
}

void add_shells(std::vector<shared::FarInstance>& out, std::size_t block, const grass::GrassSet& set, int k) {
    const int count = set.levels[static_cast<std::size_t>(k)].layer_count;
    for (int i = count - 1; i >= 0; --i) {
        const float y = (static_cast<float>(i) + 0.5f) / static_cast<float>(count) * set.canopy_m;
        out.push_back({{y, block, 0, 0},
                       {shared::layer_index(0, i, count, shared::kPlaneId), count * shared::kPlanes, 0, k}});
    }
}

struct BlockPlace {
    const VisibleBlock& block;
    std::size_t index;
};

void add_slices(std::vector<shared::FarInstance>& out, const BlockPlace& at, const grass::GrassSet& set, int k,
                const FarQuery& query) {
    const VisibleBlock& block = at.block;
    const int count = set.levels[static_cast<std::size_t>(k)].slice_count;
    const double gap = static_cast<double>(set.side_m) / count;
    for (int axis = 0; axis < 2; ++axis) {
        if (largest_share(block, query.eye, axis) < kLeastShare) {
            continue;
        }
        const double low = block.corner[axis] + query.patch_offset[axis];
        const int first = static_cast<int>(std::ceil(low / gap - 0.5));
        const int last = static_cast<int>(std::ceil((low + side_of(block)) / gap - 0.5)) - 1;
        const float eye = axis == shared::kAxisX ? query.eye.x : query.eye.z;
        const bool rising = block.corner[axis] + 0.5f * side_of(block) > eye;
        for (int n = 0; n <= last - first; ++n) {
            const int m = rising ? first + n : last - n;
            const int slice = ((m % count) + count) % count;
            const auto plane = static_cast<float>((m + 0.5) * gap - query.patch_offset[axis]);
            out.push_back({{plane, at.index, 0, 0},
                           {shared::slice_index(0, axis, slice, count, shared::kPlaneId), 2 * count * shared::kPlanes, axis, k}});
        }
    }
}

} // namespace

FarList select_far(const grass::GrassSet& set, const std::vector<VisibleBlock>& blocks, const lod::Bands& bands,
                   const FarQuery& query) {
    FarList list;
    const int levels = static_cast<int>(set.levels.size());
    for (std::size_t index = 0; index < blocks.size(); ++index) {
        const VisibleBlock& block = blocks[index];
        // A blade's root may lie outside the block that shows its tip.
        Span span = distances(block, query.lod_eye, set.canopy_m);
        span = {span.nearest - set.offset_range_m, span.farthest + set.offset_range_m};
        for (int k = 0; k < levels; ++k) {
            if (level_shows(bands, query, k, span, levels)) {
                if (largest_shell_share(set, block, query, k) >= kLeastShare) {
                    add_shells(list.shells[static_cast<std::size_t>(k)], index, set, k);
                }
                add_slices(list.slices[static_cast<std::size_t>(k)], {block, index}, set, k, query);
            }
        }
    }
    return list;
}

} // namespace sward::shells
