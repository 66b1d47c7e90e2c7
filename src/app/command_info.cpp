// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <optional>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/io.h"
#include "app/paths.h"
#include "app/world_loader.h"
#include "gl/context.h"

namespace sward::app {
namespace {

void row(std::string_view name, std::string_view value) {
    fmt::print("{:<10} {}\n", name, value);
}

void print_gpu() {
    try {
        const gl::HeadlessContext context;
        const gl::ContextInfo info = gl::context_info();
        row("gpu", fmt::format("{} ({}), EGL {}", info.renderer, info.vendor, context.platform()));
        row("opengl", fmt::format("{}, GLSL {}", info.version, info.glsl_version));
        row("limits",
            fmt::format("samples {}, texture side {}, array layers {}, storage block {} MiB",
                        info.max_samples, info.max_texture_size, info.max_array_layers,
                        info.max_storage_bytes >> 20));
    } catch (const base::Error& error) {
        row("gpu", fmt::format("none that can render: {}", error.what()));
    }
}

std::string cache_text() {
    try {
        return set_cache_directory().string();
    } catch (const base::Error& error) {
        return fmt::format("none: {}", error.what());
    }
}

} // namespace

namespace {

/// "12.5 km" or "340 m".
std::string length(double metres) {
    return metres < 10000 ? fmt::format("{:.6g} m", metres)
                          : fmt::format("{:.6g} km", metres / 1000);
}

void print_ground(const scene::Heightfield& ground) {
    const glm::dvec2 extent = ground.extent_m(), half = 0.5 * extent;
    row("extent", fmt::format("{} x {}: x {:.1f} to {:.1f}, z {:.1f} to {:.1f} m", length(extent.x),
                              length(extent.y), -half.x, half.x, -half.y, half.y));
    row("posts", fmt::format("{} x {}, {:.6g} x {:.6g} m apart", ground.width, ground.height,
                             ground.spacing_m.x, ground.spacing_m.y));
    if (ground.origin) {
        row("crs", fmt::format("{}; drawn {} about the origin", ground.origin->source,
                               ground.origin->crs.empty() ? "by degrees of its middle latitude"
                                                          : "azimuthal equidistant"));
        row("origin", fmt::format("{:.7f}, {:.7f} (latitude, longitude, WGS 84)",
                                  ground.origin->latitude_deg, ground.origin->longitude_deg));
    } else {
        row("crs", "none: the terrain has no place on Earth");
    }
    const auto [low, high] = std::minmax_element(ground.metres.begin(), ground.metres.end());
    row("heights", fmt::format("{:.2f} to {:.2f} m", *low, *high));
}

/// The entry of a class; of one that says a density alone, that.
std::string look_text(const scene::LandClass& look) {
    std::string text = fmt::format("density {}", look.density);
    if (!look.plain())
        text += fmt::format(", height {}, dryness {}, ground {}", look.height, look.dryness,
                            scene::kGroundNames[static_cast<std::size_t>(look.ground)]);
    return text;
}

void print_mask(const scene::TerrainSpec& terrain, const scene::DensityMask& mask) {
    double sum = 0;
    for (const float density : mask.density)
        sum += density;
    const std::string place = mask.size_m.x > 0
                                  ? fmt::format("x {:.1f} to {:.1f}, z {:.1f} to {:.1f} m",
                                                mask.first_m.x, mask.first_m.x + mask.size_m.x,
                                                mask.first_m.y, mask.first_m.y + mask.size_m.y)
                                  : std::string("spread over the terrain");
    row("mask", fmt::format("{} x {} texels, {}; mean density {:.4f}", mask.width, mask.height,
                            place, sum / double(mask.density.size())));
    for (const auto& [value, share] : mask.class_shares) {
        const auto found = terrain.classes.find(value);
        const std::string name = value < 0 ? "no value" : fmt::format("class {}", value);
        row(name, fmt::format("{:.3f} % of the terrain, {}", 100 * share,
                              look_text(found == terrain.classes.end() ? scene::LandClass{}
                                                                       : found->second)));
    }
    if (terrain.outside)
        row("outside", look_text(*terrain.outside));
    for (const scene::LandFeature& feature : terrain.features)
        row(feature.width_m > 0 ? "line" : "area",
            fmt::format("{}{}, {}", base::printable(feature.file.filename().native()),
                        feature.width_m > 0 ? fmt::format(", {} m wide", feature.width_m) : "",
                        look_text(feature.look)));
}

void print_scene(const Options& options) {
    // Everything is read before the first line: a refusal prints nothing else.
    const scene::Scene scene = load_scene(options);
    const auto print_name = [&] { row("scene", base::printable(scene.file.native(), 1024)); };
    if (!scene.terrain.surface.empty()) {
        const scene::Mesh mesh = load_mesh(scene.terrain.surface);
        print_name();
        row("surface",
            fmt::format("{} triangles, {} vertices", mesh.triangles.size(), mesh.positions.size()));
        return;
    }
    const scene::Heightfield ground = load_elevation(scene.terrain);
    std::optional<scene::DensityMask> mask;
    if (scene.terrain.has_mask())
        mask = load_mask(scene.terrain, ground);
    print_name();
    print_ground(ground);
    if (mask)
        print_mask(scene.terrain, *mask);
    else
        row("mask", "none: grass by the slope");
}

} // namespace

void run_info(const Options& options) {
    if (!options.scene.empty()) {
        print_scene(options);
        flush_results();
        return;
    }
    row("sward", fmt::format("{} ({} build)", SWARD_VERSION, build_name()));
    print_gpu();
    row("formats", format_libraries());
    row("data", data_directory().string());
    row("scene", default_scene().string());
    row("presets", presets_directory().string());
    row("sets", cache_text());
    row("texgen", texgen_program().string());
    flush_results();
}

} // namespace sward::app
