// SPDX-License-Identifier: Apache-2.0
// Layers and slices from voxels: what the rasteriser is to blades.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log.h"
#include "texgen/bake/texel_coder.h"
#include "texgen/import/import.h"
#include "texgen/import/import_field.h"
#include "texgen/patch/placing.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

using grass::TextureArray;

/// A few strands with what each covers; the least gives way when there are more.
template<std::size_t kParts> class Tally {
public:
    struct Part {
        std::uint32_t strand = 0, voxel = 0;
        float sum = 0, most = 0;
    };
    /// Returns what the strand that had to give way has covered.
    float add(std::uint32_t strand, std::uint32_t voxel, float share) {
        Part* part = nullptr;
        for (Part& p : parts_)
            if (p.sum > 0 && p.strand == strand)
                part = &p;
        float gone = 0;
        if (!part) {
            part = &*std::ranges::min_element(parts_, {}, &Part::sum);
            gone = part->sum;
            *part = {strand, voxel, 0, 0};
        }
        part->sum += share;
        if (share > part->most) {
            part->most = share;
            part->voxel = voxel;
        }
        return gone;
    }
    [[nodiscard]] const Part& largest() const {
        return *std::ranges::max_element(parts_, {}, &Part::sum);
    }
    /// One of them by lot, weighted by what it covers, so that thin blades are not always hidden
    /// behind wide ones.
    [[nodiscard]] const Part& by_lot(double lot) const {
        float left = 0;
        for (const Part& p : parts_)
            left += p.sum;
        left *= static_cast<float>(lot);
        for (const Part& p : parts_)
            if ((left -= p.sum) < 0)
                return p;
        return largest();
    }
    [[nodiscard]] const std::array<Part, kParts>& parts() const { return parts_; }

private:
    std::array<Part, kParts> parts_;
};

/// The voxels of a slab behind each other. Pieces of one strand lie beside each other and add up,
/// different strands hide each other by chance.
class Column {
public:
    void add(std::uint32_t strand, std::uint32_t voxel, float share) {
        clear_ *= 1 - std::min(1.0f, tally_.add(strand, voxel, share));
    }
    [[nodiscard]] float coverage() const {
        float clear = clear_;
        for (const auto& part : tally_.parts())
            clear *= 1 - std::min(1.0f, part.sum);
        return 1 - clear;
    }
    [[nodiscard]] const Tally<3>::Part& largest() const { return tally_.largest(); }

private:
    Tally<3> tally_;
    float clear_ = 1;
};

/// Texels that a run of cells touches along one axis, with the part of the texel that it fills.
struct Cover {
    int first = 0, last = 0; ///< inclusive
    double low = 0, high = 0;
    Cover(double from, double to, double texel, int count)
        : first(std::clamp(static_cast<int>(std::floor(from / texel + 1e-6)), 0, count - 1)),
          last(std::clamp(static_cast<int>(std::ceil(to / texel - 1e-6)) - 1, first, count - 1)),
          low(from / texel), high(to / texel) {}
    [[nodiscard]] float part(int i) const {
        return static_cast<float>(
            std::max(0.0, std::min(high, i + 1.0) - std::max(low, static_cast<double>(i))));
    }
};

/// One slab, from voxels to coded mips.
class SlabProjection {
public:
    SlabProjection(const VoxelField& field, const Slab& slab, std::uint64_t salt)
        : field_(field), slab_(slab), axes_(axes_of(slab.family)), salt_(salt) {}

    /// Mip 0; a texel's `blade` is an index into records().
    TexelImage draw() {
        const glm::ivec3 cells = field_.volume().cells;
        columns_.assign(static_cast<std::size_t>(cells[axes_.u]) *
                            static_cast<std::size_t>(cells[axes_.v]),
                        {});
        direction_ = glm::vec3(0);
        direction_[axes_.slab] = 1;
        throw_voxels();
        return spread_columns();
    }
    /// Of every texel's piece: what the coder needs of a blade.
    [[nodiscard]] const std::vector<shared::BladeRecord>& records() const { return records_; }

    /// keep_alpha of whole strands: pieces of one are opaque together.
    void keep_strands(TexelImage& image, double ratio) const {
        TexelImage by_strand = image;
        for (Texel& texel : by_strand.texels)
            if (texel.blade >= 0)
                texel.blade = strands_[static_cast<std::size_t>(texel.blade)];
        keep_alpha(by_strand, ratio);
        for (std::size_t t = 0; t < image.texels.size(); ++t)
            image.texels[t].coverage = by_strand.texels[t].coverage;
    }

private:
    void throw_voxels() {
        const double voxel = field_.volume().voxel_m;
        const glm::ivec3 cells = field_.volume().cells;
        glm::ivec3 low(0), high = cells;
        low[axes_.slab] = std::clamp(static_cast<int>(std::floor(slab_.low / voxel + 1e-6)), 0,
                                     cells[axes_.slab]);
        high[axes_.slab] = std::clamp(static_cast<int>(std::ceil(slab_.high / voxel - 1e-6)), 0,
                                      cells[axes_.slab]);
        for (int y = low.y; y < high.y; ++y)
            for (int z = low.z; z < high.z; ++z) {
                const std::uint32_t end = field_.index().before(high.x, y, z);
                for (std::uint32_t i = field_.index().before(low.x, y, z); i < end; ++i)
                    throw_one(i, voxel);
            }
    }

    void throw_one(std::uint32_t i, double voxel) {
        const VoxelPlace& p = field_.volume().at[i];
        const glm::ivec3 at(p.x, p.y, p.z);
        const double low = at[axes_.slab] * voxel;
        const double inside = std::clamp(
            (std::min(slab_.high, low + voxel) - std::max(slab_.low, low)) / voxel, 0.0, 1.0);
        float seen = field_.seen_along(i, direction_);
        seen = field_.blades() ? static_cast<float>(seen * inside)
                               : static_cast<float>(1 - std::pow(1 - seen, inside));
        if (!(seen > 0))
            return;
        const std::uint32_t strand =
            field_.blades() ? field_.strand(i) : i; // a cloud's voxels hide each other by chance
        Column& column = columns_[static_cast<std::size_t>(at[axes_.v]) *
                                      static_cast<std::size_t>(field_.volume().cells[axes_.u]) +
                                  static_cast<std::size_t>(at[axes_.u])];
        const float others = seen * field_.others(i);
        column.add(strand, i, seen - others);
        if (others > 0)
            column.add(VoxelField::beside(strand), i, others);
    }

    /// Columns stand beside each other: a texel has the mean of those in it, and one strand of
    /// theirs.
    TexelImage spread_columns() {
        const glm::ivec3 cells = field_.volume().cells;
        const double voxel = field_.volume().voxel_m;
        TexelImage image{slab_.width, slab_.height,
                         std::vector<Texel>(static_cast<std::size_t>(slab_.width) *
                                            static_cast<std::size_t>(slab_.height))};
        std::vector<Tally<4>> tallies(image.texels.size());
        for (int cv = 0; cv < cells[axes_.v]; ++cv) {
            const Cover v(cv * voxel, (cv + 1) * voxel, slab_.texel_v, slab_.height);
            for (int cu = 0; cu < cells[axes_.u]; ++cu) {
                const Column& column = columns_[static_cast<std::size_t>(cv) *
                                                    static_cast<std::size_t>(cells[axes_.u]) +
                                                static_cast<std::size_t>(cu)];
                const float coverage = column.coverage();
                if (!(coverage > 0))
                    continue;
                const Cover u(cu * voxel, (cu + 1) * voxel, slab_.texel_u, slab_.width);
                const std::uint32_t best = column.largest().voxel;
                for (int row = v.first; row <= v.last; ++row)
                    for (int x = u.first; x <= u.last; ++x) {
                        const float share = coverage * u.part(x) * v.part(row);
                        const std::size_t t =
                            static_cast<std::size_t>(row) * static_cast<std::size_t>(slab_.width) +
                            static_cast<std::size_t>(x);
                        image.texels[t].coverage += share;
                        if (share > 0)
                            (void)tallies[t].add(field_.strand(best), best, share);
                    }
            }
        }
        for (std::size_t t = 0; t < tallies.size(); ++t)
            if (Texel& texel = image.texels[t]; texel.coverage > 0) {
                const std::size_t voxel_index =
                    tallies[t].by_lot(base::hash_unit(salt_, 1, t)).voxel;
                texel = {std::min(texel.coverage, 1.0f), record(voxel_index),
                         field_.along(voxel_index)};
            }
        return image;
    }

    std::int32_t record(std::size_t i) {
        const glm::vec3 t = field_.tangent(i);
        const glm::dvec2 root = field_.root(i);
        shared::BladeRecord blade{};
        blade.root = {static_cast<float>(root.x), static_cast<float>(root.y),
                      (static_cast<float>(field_.rank8(i)) + 0.5f) / 256,
                      (static_cast<float>(field_.seed8(i)) + 0.5f) / 256};
        blade.v1 = {t, 0}; // blade_tangent of a straight curve
        blade.v2 = {2.0f * t, 0};
        blade.shape.w = static_cast<float>(field_.species(i));
        records_.push_back(blade);
        strands_.push_back(static_cast<std::int32_t>(field_.strand(i)));
        return static_cast<std::int32_t>(records_.size() - 1);
    }

    const VoxelField& field_;
    const Slab& slab_;
    Axes axes_;
    std::uint64_t salt_;
    glm::vec3 direction_{0};
    std::vector<Column> columns_;
    std::vector<shared::BladeRecord> records_;
    std::vector<std::int32_t> strands_; ///< of each record
};

TextureArray empty_array(int width, int height, int layers) {
    TextureArray array{width, height, layers, {}};
    for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
        array.mips.emplace_back(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                                static_cast<std::size_t>(layers) * 4);
        if (w == 1 && h == 1)
            return array;
    }
}

struct Task {
    Slab slab;
    TextureArray* array = nullptr;
    int id_index = 0, shape_index = 0;
    std::uint64_t salt = 0;

    void run(const VoxelField& field, const BakeFrame& frame) const {
        SlabProjection projection(field, slab, salt);
        TexelImage image = projection.draw();
        const Coder coder(frame, projection.records(), slab);
        const double ratio = alpha_ratio(image);
        for (std::size_t m = 0; m < array->mips.size(); ++m) {
            if (m > 0)
                image = next_mip(image, salt + m);
            TexelImage shown = image;
            if (m > 0)
                projection.keep_strands(shown, ratio);
            const std::size_t bytes = image.texels.size() * 4;
            std::uint8_t* data = array->mips[m].data();
            coder.code(shown, data + bytes * static_cast<std::size_t>(id_index),
                       data + bytes * static_cast<std::size_t>(shape_index));
        }
    }
};

std::vector<Task> plan_tasks(const VoxelField& field, const grass::GrassSet& set, int level,
                             grass::FarLevel& out) {
    std::vector<Task> tasks;
    const int size = out.layers.width, rows = out.slices.height;
    const double side = field.side(), texel = side / size;
    const auto salt = [&](int family, int index) {
        return base::hash64(set.seed, 7000 + static_cast<std::uint64_t>(level * 3 + family),
                            static_cast<std::uint64_t>(index));
    };
    for (int i = 0; i < out.layer_count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double top = i + 1 == out.layer_count ? std::max(field.canopy(), field.box_top())
                                                    : out.layer_edges[at + 1];
        tasks.push_back({{Family::kLayer, out.layer_edges[at], top, size, size, texel, texel, side},
                         &out.layers,
                         shared::layer_index(0, i, out.layer_count, shared::kPlaneId),
                         shared::layer_index(0, i, out.layer_count, shared::kPlaneShape),
                         salt(0, i)});
    }
    for (const int axis : {shared::kAxisX, shared::kAxisZ})
        for (int i = 0; i < out.slice_count; ++i) {
            const double thick = side / out.slice_count;
            tasks.push_back({{axis == shared::kAxisX ? Family::kSliceX : Family::kSliceZ, i * thick,
                              (i + 1) * thick, size, rows, texel, field.canopy() / rows, side},
                             &out.slices,
                             shared::slice_index(0, axis, i, out.slice_count, shared::kPlaneId),
                             shared::slice_index(0, axis, i, out.slice_count, shared::kPlaneShape),
                             salt(1 + axis, i)});
        }
    return tasks;
}

} // namespace

grass::FarLevel project_level(const VoxelField& field, const ImportQuery& query, int level,
                              const grass::GrassSet& set, std::span<const double> seen) {
    grass::FarLevel out;
    const int size = query.size >> level, rows = slice_rows(field.canopy(), field.side() / size);
    out.layer_count = std::max(2, query.layers >> level);
    out.slice_count = std::max(4, query.slices >> level);
    const Placing placing = place_layers(seen, set.canopy_m, out.layer_count);
    out.layer_edges = placing.edges;
    out.layer_heights = placing.heights;
    out.layers = empty_array(size, size, out.layer_count * shared::kPlanes);
    out.slices = empty_array(size, rows, 2 * out.slice_count * shared::kPlanes);
    const Preset preset;
    const Patch patch;
    const BakeFrame frame{preset, patch,         set.canopy_m, set.offset_range_m,
                          seen,   query.threads, nullptr};
    const std::vector<Task> tasks = plan_tasks(field, set, level, out);
    base::Progress progress(fmt::format("layers and slices, level {}", level), tasks.size());
    parallel_for(tasks.size(), resolve_threads(query.threads), [&](std::size_t t, int) {
        tasks[t].run(field, frame);
        progress.advance();
    });
    return out;
}

} // namespace sward::texgen
