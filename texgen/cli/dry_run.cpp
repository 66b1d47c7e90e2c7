// SPDX-License-Identifier: Apache-2.0
#include "texgen/cli/dry_run.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "grass/blades_glb.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "shared/blade.h"
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

/// What the volume takes. Its leaves are of 8 x 8 x 8 voxels.
struct VolumeSize {
    double voxels = 0; ///< each once for each blade in it
    double leaves = 0;
    /// The halves of all grids; of a leaf the masks of them. Measured on meadow and fur.
    [[nodiscard]] double file_bytes() const { return 13.7 * voxels + 915 * leaves; }
};

/// The leaves that blades pass, by points along their middle and rims.
class LeafCount {
public:
    LeafCount(double side_m, double canopy_m, double leaf_m)
        : leaf_m_(leaf_m), side_(std::max(1, static_cast<int>(std::ceil(side_m / leaf_m - 1e-6)))),
          rows_(1 + static_cast<int>(canopy_m / leaf_m)),
          found_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) *
                 static_cast<std::size_t>(rows_)) {}

    void add(const shared::BladeRecord& blade) {
        const int steps = 1 + static_cast<int>(2 * static_cast<double>(blade.shape.y) / leaf_m_);
        for (int i = 0; i <= steps; ++i) {
            const float v = static_cast<float>(i) / static_cast<float>(steps);
            const shared::vec3 at =
                shared::blade_curve(shared::vec3(blade.v1), shared::vec3(blade.v2), v);
            for (const float rim : {-1.0f, 0.0f, 1.0f}) {
                const float across = rim * blade.v1.w * (1 - v * v);
                mark({blade.root.x + at.x + across * std::cos(blade.shape.x), at.y,
                      blade.root.y + at.z + across * std::sin(blade.shape.x)});
            }
        }
    }
    [[nodiscard]] double count() const {
        return static_cast<double>(std::ranges::count(found_, true));
    }

private:
    void mark(const glm::vec3& at) {
        const auto round = [&](float metres) { // on the torus
            const int i = static_cast<int>(std::floor(metres / leaf_m_)) % side_;
            return static_cast<std::size_t>(i < 0 ? i + side_ : i);
        };
        const auto row =
            static_cast<std::size_t>(std::clamp(static_cast<int>(at.y / leaf_m_), 0, rows_ - 1));
        const auto side = static_cast<std::size_t>(side_);
        found_[(row * side + round(at.z)) * side + round(at.x)] = true;
    }

    double leaf_m_;
    int side_, rows_;
    std::vector<bool> found_;
};

/// A blade passes length / voxel + width / voxel voxels, and more askew.
VolumeSize volume_size(const Patch& patch, double voxel_m) {
    constexpr double kSlant = 1.35;
    LeafCount leaves(patch.side_m, canopy_height(patch), 8 * voxel_m);
    VolumeSize size;
    for (const shared::BladeRecord& blade : patch.variant(0)) {
        const double width = 2 * blade.v1.w * 2 / 3;
        size.voxels += kSlant * blade.shape.y / voxel_m * (1 + width / voxel_m);
        leaves.add(blade);
    }
    size.leaves = leaves.count();
    return size;
}

/// What is in memory at the peak of a bake, in bytes. The factors are sizes of the code's own
/// structs and what was measured of meadow and fur (docs/texgen.md, Measured).
struct Account {
    double levels = 0;               ///< textures of the planes
    double shapes = 0;               ///< BC5 beside them
    double march = 0;                ///< textures of the march
    double largest = 0;              ///< of the two largest arrays
    double blades = 0, variants = 0; ///< counts
    double rasters = 0;              ///< the workers'
    VolumeSize volume;
};

/// While files are written: each worker packs an array, or one makes the volume.
double writing_bytes(const Account& a, const BakeOptions& options, int threads) {
    constexpr double kPackedShare = 1.3; // packed mips and the file's bytes, against the array
    constexpr double kLeafBytes = 22e3;  // in memory: four grids of floats, two of three
    constexpr double kVoxelBytes = 120;  // deposits and arrays, which grow by doubling
    const auto packing = [&](int workers) {
        return (options.compression == 0 ? 3 : kPackedShare) * a.largest * std::min(workers, 2) / 2;
    };
    if (!options.volume)
        return packing(threads);
    const double volume = std::max(a.volume.voxels * kVoxelBytes,
                                   a.volume.leaves * kLeafBytes + 3 * a.volume.file_bytes());
    return threads > 1 ? volume + packing(threads - 1) : std::max(volume, packing(1));
}

std::uint64_t peak_of(const Account& a, const BakeOptions& options) {
    constexpr double kLibraries = 137e6;
    constexpr double kHoles = 107e6;                         // that the fit leaves in the heap
    constexpr double kFieldBytes = 4500, kGridBytes = 1.1e6; // of a blade, of a variant, for rays
    constexpr double kFields = 3;              // the march's: at rest, level ground, a slope
    constexpr double kFloatsShare = 32.0 / 12; // its images as floats, over what is kept of them
    constexpr double kFitBytes = 20e6;
    constexpr double kBladeBytes = 1000; // records, outlines
    const int threads = resolve_threads(options.threads);
    const double held = kLibraries + a.levels + a.blades * kBladeBytes;
    const double fitting = (1 + kFloatsShare) * a.march + kFitBytes +
                           kFields * (a.blades * kFieldBytes + a.variants * kGridBytes);
    const double writing = kHoles + a.march + a.shapes + writing_bytes(a, options, threads);
    return static_cast<std::uint64_t>(held + std::max({a.rasters, fitting, writing}));
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
        account.levels += both;
        account.shapes += options.block ? both / 4 : 0;
        account.largest = std::max(account.largest, both);
        r.gpu_bytes += level.gpu_bytes;
        r.levels.push_back(level);
    }
    account.march = add_march(r);
    r.gpu_bytes += r.blades * sizeof(shared::BladeRecord);
    r.files.push_back(
        {grass::kBladesFile, 0,
         grass::encode_blades(patch.blades, patch.variant_begin, static_cast<float>(preset.side_m))
             .size(),
         ""});
    if (options.volume) {
        account.volume = volume_size(patch, preset.side_m / static_cast<double>(preset.size));
        r.files.push_back(
            {grass::kVolumeFile, 0, static_cast<std::uint64_t>(account.volume.file_bytes()), ""});
    }
    account.blades = static_cast<double>(r.blades);
    account.variants = r.variants;
    const auto texels = static_cast<double>(preset.size * preset.size);
    account.rasters = resolve_threads(options.threads) * texels * 60;
    r.peak_bytes = peak_of(account, options);
    return r;
}

} // namespace sward::texgen
