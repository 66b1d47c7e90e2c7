// SPDX-License-Identifier: Apache-2.0
#include "texgen/far_level.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/log.h"
#include "texgen/parallel.h"

namespace sward::texgen {
namespace {

using grass::TextureArray;

/// Sizes of one level, and where its images go.
struct LevelPlan {
    int level = 0;
    int size = 0;
    double texel_m = 0;
    int layers = 0;
    int slices = 0;
    int rows = 0;
};

LevelPlan plan_level(const Preset& preset, double canopy_m, int level) {
    LevelPlan plan;
    plan.level = level;
    plan.size = static_cast<int>(preset.size) >> level;
    plan.texel_m = preset.side_m / plan.size;
    plan.layers = std::max(2, static_cast<int>(preset.layers) >> level);
    // Further apart than the canopy is tall, slices would show as rows from above.
    plan.slices = std::max(4, static_cast<int>(preset.slices) >> level);
    plan.rows = slice_rows(canopy_m, plan.texel_m);
    return plan;
}

TextureArray empty_array(int width, int height, int layers) {
    TextureArray array{width, height, layers, {}};
    for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
        array.mips.emplace_back(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                                static_cast<std::size_t>(layers) * 4);
        if (w == 1 && h == 1)
            return array;
    }
}

std::uint8_t unorm8(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

/// Codes the images of one slab (shaders/shared/grass_layout.h).
class Coder {
public:
    Coder(const BakeFrame& frame, std::span<const shared::BladeRecord> blades, const Slab& slab)
        : frame_(frame), blades_(blades), slab_(slab) {}

    /// `id` and `shape` are the two planes' texels of this mip.
    void code(const TexelImage& image, std::uint64_t salt, std::uint8_t* id,
              std::uint8_t* shape) const {
        std::size_t t = 0;
        for (int row = 0; row < image.height; ++row)
            for (int column = 0; column < image.width; ++column, ++t) {
                const Texel& texel = image.texels[t];
                if (texel.blade < 0)
                    continue;
                // Rounded up or down by a hash: the mean over texels holds even where coverage is
                // below one step.
                const double steps =
                    texel.coverage * 255.0 + base::hash_unit(salt, 1, t) * 0.998 + 0.001;
                const int coverage = std::clamp(static_cast<int>(steps), 0, 255);
                if (coverage == 0)
                    continue;
                const shared::BladeRecord& blade = blades_[static_cast<std::size_t>(texel.blade)];
                id[4 * t] = static_cast<std::uint8_t>(coverage);
                id[4 * t + 1] = static_cast<std::uint8_t>(blade.root.z * 256);
                id[4 * t + 2] = static_cast<std::uint8_t>(blade.root.w * 256);
                id[4 * t + 3] = unorm8(texel.along);
                code_shape(blade, texel.along, (column + 0.5) / image.width,
                           (row + 0.5) / image.height, shape + 4 * t);
            }
    }

private:
    void code_shape(const shared::BladeRecord& blade, float along, double u, double v,
                    std::uint8_t* out) const {
        shared::vec3 tangent =
            shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2), along);
        if (tangent.y < 0)
            tangent = -tangent;
        out[0] = unorm8(tangent.x * 0.5 + 0.5);
        out[1] = unorm8(tangent.z * 0.5 + 0.5);
        const Axes axes = axes_of(slab_.family);
        glm::dvec3 at;
        at[axes.slab] = (slab_.low + slab_.high) / 2;
        at[axes.u] = u * slab_.width * slab_.texel_u;
        at[axes.v] = v * slab_.height * slab_.texel_v;
        const double side = slab_.side;
        out[2] =
            unorm8(nearest_image(blade.root.x - at.x, side) / frame_.offset_range_m * 0.5 + 0.5);
        out[3] =
            unorm8(nearest_image(blade.root.y - at.z, side) / frame_.offset_range_m * 0.5 + 0.5);
    }

    const BakeFrame& frame_;
    std::span<const shared::BladeRecord> blades_;
    const Slab& slab_;
};

/// One worker's task: a slab of a variant, from blades to coded mips.
struct Task {
    int variant = 0;
    Slab slab;
    TextureArray* array = nullptr;
    int id_index = 0;
    int shape_index = 0;
    std::uint64_t salt = 0;

    void run(const BakeFrame& frame, std::span<const Outline> outlines, SlabRaster& raster) const {
        const Coder coder(frame, frame.patch.variant(variant), slab);
        TexelImage image{slab.width, slab.height, raster.draw(slab, outlines)};
        for (std::size_t m = 0; m < array->mips.size(); ++m) {
            if (m > 0)
                image = next_mip(image, salt + m);
            const std::size_t bytes = image.texels.size() * 4;
            std::uint8_t* data = array->mips[m].data();
            coder.code(image, salt + m, data + bytes * static_cast<std::size_t>(id_index),
                       data + bytes * static_cast<std::size_t>(shape_index));
        }
    }
};

Slab layer_slab(const BakeFrame& frame, const LevelPlan& plan, int layer) {
    const double thick = frame.canopy_m / plan.layers;
    // The highest tip lies on the canopy's top: rounding must not cut it off.
    const double top = layer + 1 == plan.layers ? frame.canopy_m * (1 + 1e-9) : (layer + 1) * thick;
    return {Family::kLayer, layer * thick, top,          plan.size,
            plan.size,      plan.texel_m,  plan.texel_m, frame.patch.side_m};
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
            frame.patch.side_m};
}

std::vector<Task> plan_tasks(const BakeFrame& frame, const LevelPlan& plan, grass::FarLevel& out) {
    std::vector<Task> tasks;
    const auto salt = [&](int family, int index) {
        return base::hash64(static_cast<std::uint64_t>(frame.preset.seed),
                            7000 + static_cast<std::uint64_t>(plan.level * 3 + family),
                            static_cast<std::uint64_t>(index));
    };
    for (int v = 0; v < frame.patch.variants(); ++v) {
        for (int i = 0; i < plan.layers; ++i)
            tasks.push_back({v, layer_slab(frame, plan, i), &out.layers,
                             shared::layer_index(v, i, plan.layers, shared::kPlaneId),
                             shared::layer_index(v, i, plan.layers, shared::kPlaneShape),
                             salt(0, i)});
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            for (int i = 0; i < plan.slices; ++i)
                tasks.push_back({v, slice_slab(frame, plan, axis, i), &out.slices,
                                 shared::slice_index(v, axis, i, plan.slices, shared::kPlaneId),
                                 shared::slice_index(v, axis, i, plan.slices, shared::kPlaneShape),
                                 salt(1 + axis, i)});
    }
    return tasks;
}

} // namespace

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
           static_cast<std::size_t>(plan.layers + 2 * plan.slices);
}

grass::FarLevel bake_level(const BakeFrame& frame, int level) {
    const LevelPlan plan = plan_level(frame.preset, frame.canopy_m, level);
    const int variants = frame.patch.variants();
    grass::FarLevel out;
    out.layer_count = plan.layers;
    out.slice_count = plan.slices;
    out.layers = empty_array(plan.size, plan.size, variants * plan.layers * shared::kPlanes);
    out.slices = empty_array(plan.size, plan.rows, variants * 2 * plan.slices * shared::kPlanes);
    std::vector<std::vector<Outline>> outlines;
    for (int v = 0; v < variants; ++v)
        outlines.push_back(outlines_of(frame.patch.variant(v)));
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
