// SPDX-License-Identifier: Apache-2.0
// From a preset to a set in memory: patch, layers and slices, far table, shares.
#include <cmath>

#include "texgen/bake/far_level.h"
#include "texgen/bake/writer.h"
#include "texgen/far/far_table.h"
#include "texgen/far/march_fit.h"
#include "texgen/far/march_slope.h"
#include "texgen/patch/placing.h"
#include "texgen/support/step_timer.h"

namespace sward::texgen {

namespace {

void report_placing(const std::vector<double>& seen, double canopy_m, int layers) {
    base::log_debug(
        fmt::format("{} layers lie {:.1f} mm from what is seen, {:.1f} mm if placed evenly", layers,
                    1000 * placing_error(seen, place_layers(seen, canopy_m, layers)),
                    1000 * placing_error(seen, even_layers(canopy_m, layers))));
}

/// The far field's images of the patch, and what corrects them.
grass::FarMedium bake_march(const Preset& preset, const BakeOptions& options, const Patch& patch,
                            float canopy_m) {
    const HeightCaster truth = cast_blades(patch, canopy_m);
    MarchBuilder builder(preset.side_m, canopy_m, patch.variants(),
                         heights_met(truth, preset.side_m, canopy_m));
    {
        base::Progress progress("the march's images", static_cast<std::size_t>(patch.variants()));
        for (int v = 0; v < patch.variants(); ++v) {
            add_blades(patch, v, builder);
            progress.advance();
        }
    }
    MarchData data = builder.finish(patch.looks);
    fit_slopes(patch, static_cast<int>(preset.far_rays), options.threads, data.medium);
    grass::FarMedium march = pack_march(data);
    march.correction = fit_march(data, truth, static_cast<int>(preset.far_rays), options.threads);
    return march;
}

/// What the preset and its blades say of a set, before anything of it is drawn.
grass::GrassSet described(const Preset& preset, const Patch& patch) {
    grass::GrassSet set;
    set.name = preset.name;
    set.seed = static_cast<std::uint64_t>(preset.seed);
    set.side_m = static_cast<float>(preset.side_m);
    set.height_coding = height_coding(preset);
    set.variants = patch.variants();
    set.density_per_m2 = static_cast<float>(static_cast<double>(patch.variant_begin[1]) /
                                            (preset.side_m * preset.side_m));
    const auto colour = [](const Colour& c) { return glm::vec3(c[0], c[1], c[2]); };
    set.floor = {static_cast<float>(preset.floor_cover), colour(preset.floor_moss),
                 colour(preset.floor_litter)};
    double shares = 0;
    for (const Species& species : preset.species)
        shares += species.share;
    for (const Species& species : preset.species)
        set.species.push_back({species.name,
                               scene::kElementNames.at(static_cast<std::size_t>(species.element)),
                               static_cast<float>(species.share / shares), appearance(species)});
    // The numbers a reader gets are floats; the textures are drawn for those, not for their
    // doubles.
    set.canopy_m = std::nextafter(static_cast<float>(canopy_height(patch)), 1e9f);
    set.offset_range_m = std::nextafter(static_cast<float>(offset_range(preset, patch)), 1e9f);
    return set;
}

} // namespace

grass::GrassSet bake_set(const Preset& preset, const BakeOptions& options) {
    Patch patch;
    {
        const StepTimer timer("patch");
        patch = generate_patch(preset, options.threads);
    }
    grass::GrassSet set = described(preset, patch);
    const std::vector<double> seen = heights_seen(patch, set.canopy_m, options.threads);
    report_placing(seen, set.canopy_m, static_cast<int>(preset.layers));
    std::size_t images = 0;
    for (int k = 0; k < preset.levels; ++k)
        images += level_images(preset, k);
    {
        const StepTimer timer("layers and slices");
        base::Progress progress("layers and slices", images);
        const BakeFrame frame{preset, patch,           set.canopy_m, set.offset_range_m,
                              seen,   options.threads, &progress};
        for (int k = 0; k < preset.levels; ++k)
            set.levels.push_back(bake_level(frame, k));
    }
    {
        const StepTimer timer("march");
        set.march = bake_march(preset, options, patch, set.canopy_m);
    }
    {
        const StepTimer timer("far table");
        FarTable table = far_table(blade_canopy(patch, set.canopy_m),
                                   static_cast<int>(preset.far_rays), options.threads);
        set.far = std::move(table.rows);
        set.far_light = std::move(table.light);
    }
    {
        const StepTimer timer("shares of the shells");
        calibrate_shells(set, static_cast<int>(preset.far_rays), options.threads);
    }
    set.blades = std::move(patch.blades);
    set.variant_begin = std::move(patch.variant_begin);
    if (options.block)
        compress_shapes(set, options.threads);
    return set;
}

} // namespace sward::texgen
