// SPDX-License-Identifier: Apache-2.0
#include "texgen/cli/dry_run.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "grass/blades_glb.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "texgen/bake/far_level.h"
#include "texgen/patch/canopy.h"
#include "texgen/patch/patch_size.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

/// An array without its texels, for the sizes of its mips.
grass::TextureArray shape_of(int width, int height, int images, grass::TexelFormat format) {
    grass::TextureArray array{width, height, images, {}, format};
    array.mips.resize(
        static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(std::max(width, height)))));
    return array;
}

std::uint64_t bytes_of(const grass::TextureArray& array) {
    std::uint64_t sum = 0;
    for (int m = 0; m < static_cast<int>(array.mips.size()); ++m)
        sum += grass::mip_bytes(array, m);
    return sum;
}

/// Adds the files of one family of a level; returns its bytes on the GPU.
std::uint64_t add_family(SetReport& r, const std::string& planes, const std::string& shape,
                         const grass::TextureArray& both, bool block) {
    if (!block) {
        r.files.push_back({planes, 0, bytes_of(both), ""});
        return bytes_of(both);
    }
    const std::uint64_t ids = bytes_of(both) / shared::kPlanes;
    const std::uint64_t shapes =
        bytes_of(shape_of(both.width, both.height, both.layers, grass::TexelFormat::kBc5));
    r.files.push_back({planes, 0, ids, ""});
    r.files.push_back({shape, 0, shapes, ""});
    return ids + shapes;
}

/// Bytes of the volume's voxels: a blade passes length / voxel + width / voxel voxels, and more
/// askew; each holds one value of every grid. Measured on the shipped presets.
std::uint64_t volume_bytes(const Patch& patch, double voxel_m) {
    constexpr double kVoxelBytes = 16; // all grids, half floats, and their share of the tree
    constexpr double kSlant = 1.35;
    double voxels = 0;
    for (const shared::BladeRecord& blade : patch.variant(0)) {
        const double width = 2 * blade.v1.w * 2 / 3;
        voxels += kSlant * blade.shape.y / voxel_m * (1 + width / voxel_m);
    }
    return static_cast<std::uint64_t>(voxels * kVoxelBytes);
}

/// Memory at the peak of a bake. The numbers of kAccount were measured on the meadow at 256, 512
/// and 1024 texels (docs/texgen.md).
struct Account {
    double arrays = 0;  ///< bytes of all textures in memory
    double largest = 0; ///< of the two largest arrays, which are packed at the same time
    double shapes = 0;  ///< BC5 beside them
    double blades = 0;
    double scratch = 0; ///< of the workers
    double volume = 0;
};

std::uint64_t peak_of(const Account& a, const BakeOptions& options) {
    constexpr double kLibraries = 60e6;
    constexpr double kBladeBytes = 3000; // outlines, segments in the rays' grids
    constexpr double kPackedShare =
        1.3; // packed mips, the file's bytes and what is read back, against the array
    const double held = kLibraries + a.arrays + a.shapes + a.blades * kBladeBytes;
    const double packing = options.compression == 0 ? 3 * a.largest : kPackedShare * a.largest;
    const double volume = options.volume ? a.volume : 0;
    return static_cast<std::uint64_t>(std::max(held + a.scratch, held + packing + volume));
}

/// The far field's files; returns their bytes in memory and on the GPU.
double add_march(SetReport& r) {
    double sum = 0;
    const auto add = [&](const std::string& density, const std::string& fibres, int width,
                         int height, int images) {
        for (const auto& [name, format] : {std::pair{density, grass::TexelFormat::kRgba16f},
                                           std::pair{fibres, grass::TexelFormat::kRgba8}}) {
            const std::uint64_t bytes = bytes_of(shape_of(width, height, images, format));
            r.files.push_back({name, 0, bytes, ""});
            r.gpu_bytes += bytes;
            sum += static_cast<double>(bytes);
        }
    };
    const int columns = shared::kMarchTexels >> shared::kColumnBase;
    add(grass::kColumnsFile, grass::kColumnFibresFile, columns, columns,
        r.variants * shared::kMarchLayers);
    for (int k = 0; k < shared::kMarchSets; ++k)
        add(grass::slabs_file(k), grass::slab_fibres_file(k), shared::kMarchTexels >> k,
            grass::kMarchRows, r.variants * 2 * (shared::kFinestSlabs >> k));
    return sum;
}

} // namespace

SetReport dry_run(const Preset& preset, const BakeOptions& options) {
    const Patch patch = unranked_patch(preset, options.threads);
    SetReport r;
    r.name = preset.name;
    r.seed = static_cast<std::uint64_t>(preset.seed);
    r.side_m = preset.side_m;
    r.canopy_m = canopy_height(patch);
    r.variants = patch.variants();
    r.density_per_m2 = preset.density_per_m2;
    r.blades = patch.blades.size();
    r.block_compressed = options.block;
    Account account;
    for (int k = 0; k < preset.levels; ++k) {
        const LevelPlan plan = plan_level(preset, r.canopy_m, k);
        const grass::TextureArray layers =
            shape_of(plan.size, plan.size, r.variants * plan.images * shared::kPlanes,
                     grass::TexelFormat::kRgba8);
        const grass::TextureArray slices =
            shape_of(plan.size, plan.rows, r.variants * 2 * plan.slices * shared::kPlanes,
                     grass::TexelFormat::kRgba8);
        LevelReport level{plan.size,
                          plan.texel_m,
                          plan.layers,
                          plan.slices,
                          plan.rows,
                          static_cast<int>(layers.mips.size()),
                          0};
        level.gpu_bytes = add_family(r, grass::layers_file(k), grass::layers_shape_file(k), layers,
                                     options.block) +
                          add_family(r, grass::slices_file(k), grass::slices_shape_file(k), slices,
                                     options.block);
        const auto both = static_cast<double>(bytes_of(layers) + bytes_of(slices));
        account.arrays += both;
        account.shapes += options.block ? both / 4 : 0;
        account.largest = std::max(account.largest, both);
        r.gpu_bytes += level.gpu_bytes;
        r.levels.push_back(level);
    }
    const double march = add_march(r);
    account.arrays += march;
    r.gpu_bytes += r.blades * sizeof(shared::BladeRecord);
    r.files.push_back(
        {grass::kBladesFile, 0,
         grass::encode_blades(patch.blades, patch.variant_begin, static_cast<float>(preset.side_m))
             .size(),
         ""});
    if (options.volume) {
        const std::uint64_t bytes =
            volume_bytes(patch, preset.side_m / static_cast<double>(preset.size));
        r.files.push_back({grass::kVolumeFile, 0, bytes, ""});
        account.volume = 30 * static_cast<double>(bytes); // the rasteriser's deposits
    }
    account.blades = static_cast<double>(r.blades);
    const auto texels = static_cast<double>(preset.size * preset.size);
    constexpr double kFloatsShare =
        32.0 / 12; // the march's images as floats, over what is kept of them
    account.scratch =
        std::max(resolve_threads(options.threads) * texels * 60, kFloatsShare * march);
    r.peak_bytes = peak_of(account, options);
    return r;
}

} // namespace sward::texgen
