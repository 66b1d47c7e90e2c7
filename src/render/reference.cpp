// SPDX-License-Identifier: Apache-2.0
// The reference's blades: of all that stand, those that a sample falls on.
#include <algorithm>

#include <epoxy/gl.h>

#include "render/impl.h"

namespace sward::render {

namespace {

/// Of a pixel in the bound framebuffer.
std::vector<glm::vec2> sample_places(int samples) {
    std::vector<glm::vec2> places(static_cast<std::size_t>(samples), glm::vec2(0.5f));
    for (int i = 0; samples > 1 && i < samples; ++i) {
        glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i), &places[static_cast<std::size_t>(i)].x);
    }
    return places;
}

/// What any picture of a round sees: its first one's view and a pixel around it.
terrain::Frustum frustum_of_round(const Shot& shot) {
    const glm::ivec4& layout = shot.constants.clip_layout;
    const glm::vec4 shrunk(1 / (1 + 2.0f / static_cast<float>(layout.y)), 1 / (1 + 2.0f / static_cast<float>(layout.z)), 1, 1);
    return terrain::Frustum(glm::mat4(glm::vec4(shrunk.x, 0, 0, 0), glm::vec4(0, shrunk.y, 0, 0), glm::vec4(0, 0, 1, 0), glm::vec4(0, 0, 0, 1)) *
                            shot.constants.clip_from_world);
}

} // namespace

glm::dvec2 jitter_of(const FrameSettings& settings, int picture) {
    const int grid = settings.tiers == Tiers::kReference ? settings.reference_grid : 1;
    return (glm::dvec2(picture % grid, picture / grid) + 0.5) / static_cast<double>(grid) - 0.5;
}

bool Renderer::Impl::samples_decide(const FrameSettings& settings) const {
    return settings.tiers == Tiers::kReference && settings.cull.samples && !mesh_ground && targets.samples() <= shared::kMostSamples;
}

void Renderer::Impl::choose_blades(const FrameSettings& settings, const Shot& shot) {
    const blades::LivingBlades* const alive = living(settings);
    blades::TileList tiles;
    {
        const gl::PassScope pass(timers, "select blades");
        tiles = blades::select_tiles(world.grass, surface, frustum_of_round(shot),
                                     {shot.anchor, glm::vec3(shot.constants.lod_eye), glm::vec2(shot.constants.handover), shot.constants.mode.x,
                                      alive ? &simulation->pages() : nullptr});
    }
    const int most = tiles.items.size() > blades::SampleCull::kMostKept ? 1 : blades::SampleCull::kRound;
    round_begin = shot.picture;
    round_end = std::min(shot.picture + most, shot.pictures);
    std::vector<glm::vec2> jitters;
    for (int picture = round_begin; picture < round_end; ++picture) {
        jitters.emplace_back(jitter_of(settings, picture) - jitter_of(settings, round_begin));
    }
    sample_cull->upload(tiles, sample_places(targets.samples()), jitters, counts.blades_considered > 0);
    counts.blades_considered += tiles.considered * jitters.size();
    const gl::PassScope pass(timers, "choose blades");
    sample_cull->choose(alive ? &alive->pass() : nullptr);
}

void Renderer::Impl::draw_sampled_blades(const FrameSettings& settings, const Shot& shot) {
    const blades::PhysicsPass* const alive = living(settings) ? &living(settings)->pass() : nullptr;
    if (!sample_cull) {
        sample_cull = std::make_unique<blades::SampleCull>();
    }
    blade_records.bind_storage(BIND_BLADES);
    if (shot.picture == 0 || shot.picture >= round_end) {
        choose_blades(settings, shot);
    }
    for (std::size_t batch = 0; batch < sample_cull->batches(); ++batch) {
        {
            const gl::PassScope pass(timers, "gather blades");
            sample_cull->gather(batch, shot.picture - round_begin, alive);
        }
        const gl::PassScope pass(timers, "draw blades");
        passes(settings.aov).blades.execute(*sample_cull, alive);
    }
}

} // namespace sward::render
