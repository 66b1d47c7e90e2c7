// SPDX-License-Identifier: Apache-2.0
#include "texgen/import/import.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "texgen/far/far_table.h"
#include "texgen/far/march_fit.h"
#include "texgen/import/import_field.h"
#include "texgen/import/import_palette.h"
#include "texgen/preset/preset.h"
#include "texgen/support/parallel.h"
#include "texgen/support/step_timer.h"

namespace sward::texgen {
namespace {

constexpr std::uint64_t kMaxCells = std::uint64_t{1}
                                    << 31; // of the box: the index takes 12 bytes for 64 of them
constexpr int kMinSize = 32, kMaxSize = 2048;

int nearest_size(int cells) {
    const int below = static_cast<int>(std::bit_floor(static_cast<unsigned>(cells)));
    return std::clamp(cells - below < 2 * below - cells ? below : 2 * below, kMinSize, kMaxSize);
}

void check(const Volume& volume, const ImportQuery& query, const std::filesystem::path& file) {
    const auto refuse = [&](base::ExitCode code, const char* what, const std::string& found,
                            const std::string& expected) {
        throw base::input_error(code, file, 0, what, found, expected);
    };
    if (volume.at.empty())
        refuse(base::ExitCode::kBadInput, "volume", "no voxel", "some grass");
    if (volume.cells.x != volume.cells.z)
        refuse(base::ExitCode::kBadInput, "volume",
               fmt::format("{} x {} voxels from above", volume.cells.x, volume.cells.z),
               "a square patch: --seam cuts it square");
    const std::uint64_t cells = static_cast<std::uint64_t>(volume.cells.x) *
                                static_cast<std::uint64_t>(volume.cells.y) *
                                static_cast<std::uint64_t>(volume.cells.z);
    if (cells > kMaxCells)
        refuse(base::ExitCode::kOverLimit, "volume", fmt::format("a box of {} voxels", cells),
               fmt::format("at most {}", kMaxCells));
    const double side = volume.cells.x * volume.voxel_m, canopy = volume.cells.y * volume.voxel_m;
    if (!(side >= 0.01 && side <= 1000) || !(canopy >= 0.0001 && canopy <= 100))
        refuse(base::ExitCode::kBadInput, "volume",
               fmt::format("{} m wide and {} m high", side, canopy),
               "0.01 to 1000 m and up to 100 m: see --scale and --up");
    if (canopy > 2 * side)
        refuse(base::ExitCode::kBadInput, "volume",
               fmt::format("{} m wide and {} m high", side, canopy),
               "a patch at least half as wide as it is high: see --up");
    std::uint64_t bytes = 0; // as the reader counts them
    for (int k = 0; k < query.levels; ++k) {
        const auto size = static_cast<std::uint64_t>(query.size >> k);
        const auto rows = static_cast<std::uint64_t>(canopy / side * static_cast<double>(size)) + 8;
        bytes += 11 * size *
                 (size * static_cast<std::uint64_t>(query.layers >> k) +
                  rows * 2 * static_cast<std::uint64_t>(query.slices >> k));
    }
    if (bytes > std::uint64_t{2} << 30 ||
        static_cast<double>(query.size) * canopy / side > kMaxSize)
        refuse(
            base::ExitCode::kOverLimit, "textures",
            fmt::format("{} bytes at --size {}", bytes, query.size),
            "at most 2 GiB and slices of 2048 rows: a smaller --size, fewer --layers or --slices");
}

/// Heights of the canopy's own hits.
HeightCaster cast_voxels(const VoxelField& field, const shared::GrassAppearance& look) {
    const auto canopy = std::make_shared<Canopy>(volume_canopy(field, look));
    const auto casters = std::make_shared<std::vector<Caster>>(canopy->bent(0));
    const double top = field.canopy();
    return [canopy, casters, top](const SampleRay& ray, std::uint64_t number,
                                  double density) -> std::optional<double> {
        const std::optional<GrassHit> hit = (*casters)[number % casters->size()](ray, number);
        // A thinner cloud is not known by its seeds: as if each ray's hit were there with that
        // chance.
        const bool there = hit && (density > 0.999 || base::hash_unit(0x7d1, 0, number) < density);
        return there ? std::optional<double>(hit->height * top) : std::nullopt;
    };
}

grass::FarMedium march_of(const VoxelField& field, const ImportQuery& query,
                          const grass::GrassSet& set) {
    const shared::GrassAppearance& look = set.species.front().look;
    const HeightCaster truth = cast_voxels(field, look);
    MarchBuilder builder(field.side(), set.canopy_m, 1,
                         heights_met(truth, field.side(), set.canopy_m));
    add_voxels(field, look, builder);
    const MarchData data = builder.finish(std::span(&look, 1));
    grass::FarMedium march = pack_march(data);
    march.correction = fit_march(data, truth, query.far_rays, query.threads);
    return march;
}

} // namespace

grass::GrassSet import_volume(const Volume& volume, const ImportQuery& given,
                              const std::filesystem::path& file) {
    ImportQuery query = given;
    if (query.size == 0)
        query.size = nearest_size(std::max(1, volume.cells.x));
    while (query.levels > 1 && query.size >> (query.levels - 1) < 8)
        --query.levels;
    check(volume, query, file);
    const StepTimer timer("import");
    VoxelField field(volume, query.density);
    Palette palette = palette_of(field);
    field.paint(std::move(palette.of_voxel));
    grass::GrassSet set;
    set.name = query.name;
    set.seed = volume.set_seed;
    set.side_m = static_cast<float>(field.side());
    set.canopy_m = std::nextafter(static_cast<float>(field.canopy()), 1e9f);
    set.variants = 1;
    set.variant_begin = {0, 0};
    set.species = std::move(palette.species);
    const double slab = field.side() / std::max(4, query.slices >> (query.levels - 1));
    const double texel = field.side() / (query.size >> (query.levels - 1));
    set.offset_range_m = static_cast<float>(field.farthest_root() + std::max(slab, texel) / 2 +
                                            texel / 2 + volume.voxel_m);
    const std::vector<double> seen = heights_seen(field, query.threads);
    for (int k = 0; k < query.levels; ++k)
        set.levels.push_back(project_level(field, query, k, set, seen));
    set.march = march_of(field, query, set);
    FarTable table =
        far_table(volume_canopy(field, set.species.front().look), query.far_rays, query.threads);
    set.far = std::move(table.rows);
    set.far_light = std::move(table.light);
    calibrate_shells(set, query.far_rays, query.threads);
    return set;
}

} // namespace sward::texgen
