// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "render/field_state.h"
#include "shared/bend.h"
#include "shared/sward.h"
#include "shells/far_appearance.h"

namespace sward::render {

namespace {

// Width correction (J8) begins below wmin + wspan pixels: only where blades are far thinner than at
// the hand-over, since a widened blade covers more than its shell image would.
constexpr float kWidthMin_px = 0.1f, kWidthSpan_px = 0.35f;
constexpr float kLivingFade = 0.8f; // of the reach of living blades: beyond, their pose goes to the
                                    // grouped one, in which they begin
constexpr float kSegment_px =
    18; // longer is cheaper; a blade's curve is nearly flat over so many pixels

/// World, relative to the eye, to clip coordinates. `jitter` in pixels.
glm::dmat4 clip_from_eye(const Lens& lens, const FrameSettings& settings, glm::dvec2 jitter) {
    glm::dmat4 projection = lens.clip_from_eye;
    projection[2][0] += 2 * jitter.x / settings.width;
    projection[2][1] += 2 * jitter.y / settings.height;
    return projection * lens.turn;
}

/// Bands by tier: the reference and --tiers blades draw geometry to one distance and hand nothing
/// on.
void fill_bands(shared::FrameConstants& out, const lod::Bands& bands,
                const FrameSettings& settings) {
    const bool geometry_only =
        settings.tiers == Tiers::kBlades || settings.tiers == Tiers::kReference;
    const auto reach =
        static_cast<float>(settings.tiers == Tiers::kReference ? settings.reference_distance_m
                                                               : settings.blades_distance_m);
    const glm::vec2 drawn = geometry_only ? glm::vec2(reach, reach * 1.001f) : bands.handover;
    out.handover_band = drawn;
    out.width_least_px = kWidthMin_px;
    out.width_span_px = kWidthSpan_px;
    if (settings.tiers == Tiers::kReference) {
        out.width_least_px = 0.0f; // the truth is not widened
        out.width_span_px = 1e-6f;
    }
    out.pose_band = bands.handover;
    out.segment_px = kSegment_px;
    for (std::size_t k = 0; k < bands.far.size(); ++k) {
        out.far_bands[k] = {glm::vec2(bands.far[k]), {bands.far[k].z, bands.far[k].w}};
    }
    out.ground_takes_over = geometry_only || settings.far == FarScheme::kMarch ? 0.0f : 1.0f;
    out.handover_mode = static_cast<int>(settings.handover);
    out.forced_level = settings.force_far_level;
    out.far_alone = settings.tiers == Tiers::kShells ? 1 : 0;
}

/// What is known of the set alone: where its patches lie from the anchor (world x, z), how it
/// looks, what lies under it.
void describe_set(shared::FrameConstants& out, const grass::GrassSet& set, glm::dvec2 anchor) {
    const double side = set.side_m;
    const glm::dvec2 tile = glm::floor(anchor / side);
    out.patch_offset_m = glm::vec2(anchor - tile * side);
    out.patch_side_m = set.side_m;
    out.canopy_m = set.canopy_m;
    out.anchor_tile = glm::ivec2(tile);
    out.patch_variants = set.variants;
    out.far_levels = static_cast<int>(set.levels.size());
    out.offset_range_m = set.offset_range_m;
    out.height_coding = set.height_coding;
    for (std::size_t i = 0; i < set.species.size(); ++i) {
        out.looks[i] = set.species[i].look;
    }
    out.soil = {0.085f, 0.062f, 0.040f};
    out.soil_cover = set.floor.cover;
    out.rock = {0.17f, 0.155f, 0.135f, 0}; // and scree
    out.moss = glm::vec4(set.floor.moss, 0);
    out.litter = glm::vec4(set.floor.litter, 0);
}

/// Fraction of the flutter's period: reduced here, where a day is still exact to microseconds.
double flutter_time(double time_s) {
    const double periods = time_s / shared::kFlutterPeriod_s;
    return periods - std::floor(periods);
}

} // namespace

glm::dvec3 FieldState::to_sun() const {
    return base::direction_of(world.scene.sun.azimuth_deg, world.scene.sun.elevation_deg);
}

void FieldState::light_shot(shared::FrameConstants& out, const glm::dvec3& eye) const {
    const Atmosphere::Day& day = atmosphere.at(to_sun());
    out.light = day.light;
    out.air = Atmosphere::thinned(day.air, eye.y - surface.range().x);
}

Shot FieldState::make_shot(const terrain::Clipmap& clipmap, const Lens& lens,
                           const FrameSettings& settings, glm::dvec2 jitter) const {
    Shot shot;
    const grass::GrassSet& set = world.grass;
    const glm::dvec3 eye = lens.eye;
    constexpr double kGrid = shared::kAnchorGrid_m;
    shot.anchor = {std::round(eye.x / kGrid) * kGrid, std::floor(eye.y),
                   std::round(eye.z / kGrid) * kGrid};
    const glm::dvec2 anchor(shot.anchor.x, shot.anchor.z);
    const glm::dvec3 lod_eye = settings.lod_eye.value_or(eye);
    const double focal_px = lens.focal_px(settings.width, settings.height);
    const double texel_m =
        set.levels.empty() ? 0 : static_cast<double>(set.side_m) / set.levels[0].layers.width;
    shot.bands = lod::bands(
        {}, {focal_px, ground->blade_width_m(), texel_m, static_cast<int>(set.levels.size())},
        world.scene.lod);

    shared::FrameConstants& out = shot.constants;
    const glm::dvec3 eye_here = eye - shot.anchor;
    const glm::dmat4 matrix =
        clip_from_eye(lens, settings, jitter) *
        glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, glm::dvec4(-eye_here, 1));
    out.clip_from_world = glm::mat4(matrix);
    out.world_from_clip = glm::mat4(glm::inverse(matrix));
    out.eye = glm::vec3(eye_here);
    out.focal_px = static_cast<float>(focal_px);
    out.lod_eye = glm::vec3(lod_eye - shot.anchor);
    out.flutter_time = static_cast<float>(flutter_time(time_s));

    describe_set(out, set, anchor);
    out.blade_width_m = static_cast<float>(ground->blade_width_m());
    out.density_scale = static_cast<float>(world.scene.grass.density);
    out.anchor_height_m = static_cast<float>(shot.anchor.y);
    fill_bands(out, shot.bands, settings);
    const double aside = glm::length(glm::dvec2(lod_eye.x - eye.x, lod_eye.z - eye.z));
    shot.detail = terrain::detail_of(
        lens.fov_deg, focal_px,
        settings.tiers == Tiers::kShells ? 0 : static_cast<double>(out.handover_band.y) + aside);
    clipmap.describe(out, anchor);
    out.picture_px = {settings.width, settings.height};
    ground->describe(out, anchor, settings.far == FarScheme::kMarch);
    light_shot(out, eye);
    out.wind = wind.field(anchor, time_s);
    if (tracks) {
        out.tracks = tracks->field(anchor);
    }
    if (const blades::LivingBlades* alive = living()) {
        const auto reach =
            static_cast<float>(std::max(alive->reach_m() - away_from_eyes(eye), 0.0));
        out.living_band = {kLivingFade * reach, std::max(reach, 1e-3f)};
        out.page_blades = static_cast<int>(alive->pass().blades_a_page());
    }
    out.near_m = static_cast<float>(lens.near_m);
    out.anchor_x = static_cast<int>(shot.anchor.x / shared::kAnchorGrid_m);
    out.anchor_z = static_cast<int>(shot.anchor.z / shared::kAnchorGrid_m);
    return shot;
}

} // namespace sward::render
