// SPDX-License-Identifier: Apache-2.0
#include <epoxy/gl.h>

#include "blades/blade_tiles.h"
#include "render/impl.h"
#include "shared/bend.h"
#include "shared/bindings.h"
#include "shells/far_instances.h"
#include "shells/far_shares.h"

namespace sward::render {

namespace {

/// Where the mean wind turns an upright blade, at kLeanHeight: x, z.
glm::vec2 mean_bend(const shared::FrameConstants& frame) {
    const float canopy = frame.patch_grid.w;
    const glm::vec3 turn = shared::bend_turn(shared::kLeanHeight * canopy, canopy, {frame.wind.mean.x, frame.wind.mean.y}, frame.wind.mean.w);
    return {turn.x, turn.z};
}

void set_gl_state() {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glEnable(GL_MULTISAMPLE);
    constexpr float kClear[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, kClear);
    glClearBufferfv(GL_DEPTH, 0, kClear);
}

bool draws_blades(const FrameSettings& settings) { return settings.blades && settings.tiers != Tiers::kShells; }
bool draws_far(const FrameSettings& settings) { return settings.tiers == Tiers::kAll || settings.tiers == Tiers::kShells; }
bool marches(const FrameSettings& settings) { return draws_far(settings) && settings.far == FarScheme::kMarch && settings.shells; }
bool rasterises(const FrameSettings& settings) { return draws_far(settings) && settings.far != FarScheme::kMarch; }

} // namespace

void Renderer::Impl::build_pyramid(const FrameSettings& settings) {
    if (settings.cull.occlusion) {
        const gl::PassScope pass(timers, "depth pyramid");
        depth_pyramid.build(targets.scene_depth(), targets.samples());
    }
}

const blades::LivingBlades* Renderer::Impl::living(const FrameSettings& settings) const {
    if (!settings.physics || !draws_blades(settings)) {
        return nullptr;
    }
    return mesh_ground ? static_cast<const blades::LivingBlades*>(surface_simulation.get()) : simulation.get();
}

blades::LivingBlades* Renderer::Impl::wake(const FrameSettings& settings) {
    if (!settings.physics || !draws_blades(settings) || (!mesh_ground && world.grass.blades.empty())) {
        return nullptr;
    }
    const blades::LivingBlades::Settings wanted{{settings.simulated_radius_m, settings.most_simulated_bytes}};
    const auto* present = living(settings);
    const bool fits = present && present->settings().pages.radius_m == wanted.pages.radius_m &&
                      present->settings().pages.most_bytes == wanted.pages.most_bytes;
    if (mesh_ground) {
        surface_simulation = fits ? std::move(surface_simulation) : mesh_ground->grass().simulation(wanted);
        return surface_simulation.get();
    }
    simulation = fits ? std::move(simulation) : std::make_unique<blades::Simulation>(world.grass, response, wanted);
    return simulation.get();
}

void Renderer::Impl::simulate(const View& view, const FrameSettings& settings) {
    const glm::dvec3 eye = view.pose.position;
    blades::LivingBlades* const alive = wake(settings);
    if (!alive) {
        const gl::PassScope pass(timers, "wind");
        wind.advance(view.time_s, {eye.x, eye.z}, settings.most_wind_steps);
        wind.bind();
        return;
    }
    if (!mesh_ground) { // blades meet colliders on the ground that is drawn
        clipmap.update({eye.x, eye.z});
        clipmap.bind();
    }
    const Shot shot = make_shot(view, settings, glm::dvec2(0));
    frame_buffer.upload(&shot.constants, sizeof(shot.constants));
    frame_buffer.bind_uniform(BIND_FRAME);
    alive->advance(view.time_s, {wind, surface, colliders, eye, shot.anchor, settings.most_physics_steps, settings.most_wind_steps,
                                 &timers});
}

void Renderer::Impl::draw_blades(const FrameSettings& settings, const Shot& shot) {
    {
        const gl::PassScope pass(timers, "select blades");
        const auto tiles = blades::select_tiles(world.grass, surface, terrain::Frustum(shot.constants.clip_from_world),
                                                {shot.anchor, glm::vec3(shot.constants.lod_eye), glm::vec2(shot.constants.handover),
                                                 shot.constants.mode.x, living(settings) ? &simulation->pages() : nullptr});
        cull.upload(tiles, counts.blades_considered > 0);
        counts.blades_considered += tiles.considered;
    }
    blade_records.bind_storage(BIND_BLADES);
    for (std::size_t batch = 0; batch < cull.batches(); ++batch) {
        {
            const gl::PassScope pass(timers, "cull blades");
            cull.execute(batch, settings.tiers == Tiers::kReference ? blades::CullTests{true, false, false, false} : settings.cull);
        }
        const gl::PassScope pass(timers, "draw blades");
        passes(settings.aov).blades.execute(cull, living(settings) ? &living(settings)->pass() : nullptr);
    }
}

FieldView Renderer::Impl::prepare_field(const FrameSettings& settings, const Shot& shot) {
    const shared::FrameConstants& constants = shot.constants;
    {
        const gl::PassScope pass(timers, "clipmap");
        clipmap.update({shot.anchor.x + constants.eye.x, shot.anchor.z + constants.eye.z});
        clipmap.bind();
    }
    if (rasterises(settings)) {
        const gl::PassScope pass(timers, "far appearance");
        far_appearance.update(constants.light, constants.wind);
        far_appearance.bind();
    }
    FieldView field;
    {
        const gl::PassScope pass(timers, "select blocks");
        terrain::Detail detail = shot.detail;
        field.blocks = terrain::visible_blocks(clipmap, surface, terrain::Frustum(constants.clip_from_world), shot.anchor,
                                               {glm::vec3(constants.eye), world.grass.canopy_m}, detail);
        field.fine = detail.on();
        if (field.fine) {
            clipmap.bind_posts({shot.anchor.x, shot.anchor.z}, detail);
        }
    }
    if (rasterises(settings)) {
        const gl::PassScope pass(timers, "select far");
        field.shares = settings.far == FarScheme::kPublished ? shells::published_shares() : shells::fitted_shares(world.grass);
        field.far = shells::select_far(world.grass, field.blocks, shot.bands,
                                       {constants.eye, constants.lod_eye, constants.patch_grid, constants.mode.z != 0, settings.force_far_level,
                                        field.shares, mean_bend(constants)});
    }
    const gl::PassScope pass(timers, "block samples");
    block_samples.execute(field.blocks, field.fine);
    return field;
}

void Renderer::Impl::draw_field(const FrameSettings& settings, const Shot& shot, const FieldView& field) {
    DrawPasses& draw = passes(settings.aov);
    if (settings.terrain) {
        const gl::PassScope pass(timers, "terrain");
        draw.terrain.execute(static_cast<int>(field.blocks.size()), block_mesh, field.fine);
    }
    if (draws_blades(settings)) {
        build_pyramid(settings);
        draw_blades(settings, shot);
    }
    if (rasterises(settings) && settings.shells) {
        const gl::PassScope pass(timers, "shells");
        draw.shells.execute({far_textures, field.far.shells, block_mesh, field.shares});
    }
    if (rasterises(settings) && settings.slices) {
        const gl::PassScope pass(timers, "slices");
        draw.slices.execute({far_textures, field.far.slices, block_mesh, field.shares});
    }
}

void Renderer::Impl::draw_far(const FrameSettings& settings, const Shot& shot, const FieldView& field) {
    shells::MarchPass& march = passes(settings.aov).march;
    {
        const gl::PassScope pass(timers, "canopy");
        canopy.require(settings.width, settings.height, targets.samples());
        march.draw_canopy(canopy, static_cast<int>(field.blocks.size()), block_mesh);
    }
    const glm::dvec3 eye = shot.anchor + glm::dvec3(shot.constants.eye);
    const shells::MarchPass::Inputs inputs{march_textures, canopy, nullptr, {}, targets.samples(), static_cast<float>(eye.y - surface.height(eye.x, eye.z)),
                                           field.fine, settings.count_steps};
    const gl::PassScope pass(timers, "far field");
    targets.bind_resolved();
    march.choose(inputs);
    targets.bind_scene_textures();
    march.execute(inputs);
}

void Renderer::Impl::draw_picture(const View& view, const FrameSettings& settings, int picture, int pictures) {
    const int grid = pictures > 1 ? settings.reference_grid : 1;
    const glm::dvec2 jitter = (glm::dvec2(picture % grid, picture / grid) + 0.5) / static_cast<double>(grid) - 0.5;
    const Shot shot = make_shot(view, settings, jitter);
    const shared::FrameConstants& constants = shot.constants;
    DrawPasses& draw = passes(settings.aov);

    // Constants of the view: every pass below reads them.
    frame_buffer.upload(&constants, sizeof(constants));
    frame_buffer.bind_uniform(BIND_FRAME);

    // The ground around the eye, and what lies in view of it.
    const FieldView field = mesh_ground ? FieldView{} : prepare_field(settings, shot);
    targets.bind_scene();
    set_gl_state();
    draw_objects(settings, shot, view.time_s);
    if (mesh_ground) {
        draw_mesh_ground(settings, shot);
    } else {
        draw_field(settings, shot, field);
    }
    if (settings.sky) {
        const gl::PassScope pass(timers, "sky");
        draw.screen.sky();
    }
    {
        const gl::PassScope pass(timers, "resolve");
        draw.screen.resolve(targets, 1.0f / static_cast<float>(pictures), picture == 0);
    }
    if (marches(settings) && !march_textures.empty()) {
        {
            const gl::PassScope pass(timers, "far light");
            march_light.update(constants.light, constants.wind);
            march_light.bind();
        }
        if (mesh_ground) {
            draw_mesh_far(settings, shot);
        } else {
            draw_far(settings, shot, field);
        }
    }
}

void Renderer::Impl::draw_frame(const View& view, const FrameSettings& settings) {
    counts = {};
    last_settings = settings;
    timers.begin_frame(settings.wait_in_passes);
    targets.require(settings.width, settings.height, settings.samples, settings.aov);
    simulate(view, settings);
    const int pictures = settings.tiers == Tiers::kReference ? settings.reference_grid * settings.reference_grid : 1;
    for (int picture = 0; picture < pictures; ++picture) {
        draw_picture(view, settings, picture, pictures);
    }
    const gl::PassScope pass(timers, "tone map");
    passes(settings.aov).screen.tone_map(targets, settings.exposure);
}

} // namespace sward::render
