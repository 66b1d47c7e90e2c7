// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/far_level.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/log.h"
#include "texgen/bake/height_map.h"
#include "texgen/bake/texel_coder.h"
#include "texgen/patch/placing.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

using grass::TextureArray;

TextureArray empty_array(int width, int height, int layers) {
    TextureArray array{width, height, layers, {}};
    for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
        array.mips.emplace_back(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                                static_cast<std::size_t>(layers) * 4);
        if (w == 1 && h == 1)
            return array;
    }
}

/// One worker's task: a slab of a variant, from blades to coded mips.
struct Task {
    int variant = 0;
    Slab slab;
    TextureArray* array = nullptr;
    int id_index = 0;
    int shape_index = 0;
    std::uint64_t salt = 0;
    std::vector<Slab> column; ///< of a height map: all slabs, lowest first

    void run(const BakeFrame& frame, std::span<const Outline> outlines, SlabRaster& raster) const {
        const Coder coder(frame, frame.patch.variant(variant), slab);
        TexelImage image{slab.width, slab.height,
                         column.empty() ? raster.draw(slab, outlines)
                                        : seen_from_above(column, outlines, raster)};
        const double ratio = alpha_ratio(image);
        for (std::size_t m = 0; m < array->mips.size(); ++m) {
            if (m > 0)
                image = next_mip(image, salt + m);
            TexelImage shown = image;
            if (m > 0)
                keep_alpha(shown, ratio);
            const std::size_t bytes = image.texels.size() * 4;
            std::uint8_t* data = array->mips[m].data();
            if (!column.empty())
                heights_for_coverage(shown, frame, variant);
            coder.code(shown, data + bytes * static_cast<std::size_t>(id_index),
                       data + bytes * static_cast<std::size_t>(shape_index));
        }
    }
};

Slab layer_slab(const BakeFrame& frame, const LevelPlan& plan, const grass::FarLevel& far,
                int layer) {
    const auto at = static_cast<std::size_t>(layer);
    // The highest tip lies on the canopy's top: rounding must not cut it off.
    const double top = far.layer_edges[at + 1] * (layer + 1 == plan.layers ? 1 + 1e-6 : 1);
    return {Family::kLayer, far.layer_edges[at], top,
            plan.size,      plan.size,           plan.texel_m,
            plan.texel_m,   frame.patch.side_m,  frame.preset.wrap};
}

Slab slice_slab(const BakeFrame& frame, const LevelPlan& plan, int axis, int slice) {
    const double thick = frame.patch.side_m / plan.slices;
    return {axis == shared::kAxisX ? Family::kSliceX : Family::kSliceZ,
            slice * thick,
            (slice + 1) * thick,
            plan.size,
            plan.rows,
            plan.texel_m,
            frame.canopy_m / plan.rows,
            frame.patch.side_m,
            frame.preset.wrap};
}

std::vector<Task> plan_tasks(const BakeFrame& frame, const LevelPlan& plan, grass::FarLevel& out) {
    std::vector<Task> tasks;
    const auto salt = [&](int family, int index) {
        return base::hash64(static_cast<std::uint64_t>(frame.preset.seed),
                            7000 + static_cast<std::uint64_t>(plan.level * 3 + family),
                            static_cast<std::uint64_t>(index));
    };
    for (int v = 0; v < frame.patch.variants(); ++v) {
        for (int i = 0; i < plan.images; ++i) {
            tasks.push_back({v,
                             layer_slab(frame, plan, out, i),
                             &out.layers,
                             shared::layer_index(v, i, plan.images, shared::kPlaneId),
                             shared::layer_index(v, i, plan.images, shared::kPlaneShape),
                             salt(0, i),
                             {}});
            for (int below = 0; plan.images == 1 && below < plan.layers; ++below)
                tasks.back().column.push_back(layer_slab(frame, plan, out, below));
        }
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            for (int i = 0; i < plan.slices; ++i)
                tasks.push_back({v,
                                 slice_slab(frame, plan, axis, i),
                                 &out.slices,
                                 shared::slice_index(v, axis, i, plan.slices, shared::kPlaneId),
                                 shared::slice_index(v, axis, i, plan.slices, shared::kPlaneShape),
                                 salt(1 + axis, i),
                                 {}});
    }
    return tasks;
}

} // namespace

LevelPlan plan_level(const Preset& preset, double canopy_m, int level) {
    LevelPlan plan;
    plan.level = level;
    plan.size = static_cast<int>(preset.size) >> level;
    plan.texel_m = preset.side_m / plan.size;
    plan.layers = std::max(2, static_cast<int>(preset.layers) >> level);
    plan.images = height_coding(preset) == shared::kHeightNone ? plan.layers : 1;
    // Further apart than the canopy is tall, slices would show as rows from above.
    plan.slices = std::max(4, static_cast<int>(preset.slices) >> level);
    plan.rows = slice_rows(canopy_m, plan.texel_m);
    return plan;
}

int slice_rows(double canopy_m, double texel_m) {
    const int rows = static_cast<int>(std::ceil(canopy_m / texel_m));
    return std::max(4, (rows + 3) / 4 * 4);
}

double offset_range(const Preset& preset, const Patch& patch) {
    double widest = 0;
    for (int k = 0; k < preset.levels; ++k) {
        const LevelPlan plan = plan_level(preset, 1, k);
        widest = std::max(widest, std::max(preset.side_m / plan.slices, plan.texel_m) / 2);
    }
    // A texel's centre lies up to half a texel off the blade that covers it.
    return reach(patch) + widest +
           preset.side_m / static_cast<double>(preset.size >> (preset.levels - 1)) / 2;
}

std::size_t level_images(const Preset& preset, int level) {
    const LevelPlan plan = plan_level(preset, 1, level);
    return static_cast<std::size_t>(preset.variants) *
           static_cast<std::size_t>(plan.images + 2 * plan.slices);
}

grass::FarLevel bake_level(const BakeFrame& frame, int level) {
    const LevelPlan plan = plan_level(frame.preset, frame.canopy_m, level);
    const int variants = frame.patch.variants();
    grass::FarLevel out;
    out.layer_count = plan.layers;
    out.slice_count = plan.slices;
    const Placing placing = place_layers(frame.seen, frame.canopy_m, plan.layers);
    out.layer_edges = placing.edges;
    out.layer_heights = placing.heights;
    out.layers = empty_array(plan.size, plan.size, variants * plan.images * shared::kPlanes);
    out.slices = empty_array(plan.size, plan.rows, variants * 2 * plan.slices * shared::kPlanes);
    std::vector<std::vector<Outline>> outlines;
    for (int v = 0; v < variants; ++v)
        outlines.push_back(outlines_of(frame.patch.variant(v), frame.patch.looks));
    const std::vector<Task> tasks = plan_tasks(frame, plan, out);
    const int threads = resolve_threads(frame.threads);
    std::vector<SlabRaster> rasters(static_cast<std::size_t>(threads));
    parallel_for(tasks.size(), threads, [&](std::size_t t, int worker) {
        tasks[t].run(frame, outlines[static_cast<std::size_t>(tasks[t].variant)],
                     rasters[static_cast<std::size_t>(worker)]);
        if (frame.progress)
            frame.progress->advance();
    });
    return out;
}

} // namespace sward::texgen
