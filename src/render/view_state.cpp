// SPDX-License-Identifier: Apache-2.0
#include "render/view_state.h"

#include <epoxy/gl.h>

#include "gl/memory.h"
#include "render/frame.h"
#include "render/reload.h"

namespace sward::render {

ViewState::ViewState(std::shared_ptr<FieldState> of)
    : field(std::move(of)), clipmap(field->posts), frame_buffer(sizeof(shared::FrameConstants)),
      reloads(field->reloads) {}

void ViewState::draw(const Camera& camera, const FrameSettings& settings,
                     const HostTextures& host) {
    last_settings = settings;
    if (field->ground->far_alone() && last_settings.tiers == Tiers::kAll) {
        last_settings.tiers = Tiers::kShells; // a far-only set: the far tier from the eye's feet on
    }
    const Lens checked = lens_of(camera); // before anything is changed
    static_cast<void>(checked);
    blades_considered = 0;
    timers.begin_frame(last_settings.wait_in_passes);
    targets.require(last_settings.width, last_settings.height, last_settings.samples,
                    last_settings.aov);
    Frame(*this, camera, last_settings, host).draw();
    field->counted = this;
}

void ViewState::present(std::uint32_t fbo, int x, int y) const {
    glBlitNamedFramebuffer(targets.display().id(), fbo, 0, 0, targets.width(), targets.height(), x,
                           y, x + targets.width(), y + targets.height(), GL_COLOR_BUFFER_BIT,
                           GL_NEAREST);
}

FrameStats ViewState::stats() const {
    FrameStats stats;
    field->add_stats(stats);
    for (const auto& row : timers.rows()) {
        stats.passes.push_back({row.name, row.gpu_ms, row.cpu_ms});
    }
    stats.gpu_bytes = gl::gpu_bytes();
    stats.blades_considered = blades_considered;
    const FrameSettings& settings = last_settings;
    if (!settings.physics || !draws_blades(settings)) {
        stats.blades_simulated = stats.patches_stepped = stats.physics_steps = stats.physics_bytes =
            stats.sphere_pairs = 0;
    }
    if (field->counted != this) {
        return stats;
    }
    const Ground& ground = *field->ground;
    if (ground.has_far() && (settings.tiers == Tiers::kAll || settings.tiers == Tiers::kShells)) {
        const auto samples = static_cast<std::uint64_t>(targets.samples());
        const DrawPasses& passes = field->passes(settings.aov);
        if (settings.far != FarScheme::kMarch && !ground.on_charts()) {
            stats.shell_fragments = settings.shells ? passes.shells.samples_passed() / samples : 0;
            stats.slice_fragments = settings.slices ? passes.slices.samples_passed() / samples : 0;
        } else if (settings.far == FarScheme::kMarch && settings.shells &&
                   !field->march_textures.empty()) {
            stats.shell_fragments = passes.march.pixels().y;
            stats.slice_fragments = passes.march.pixels().x;
            if (settings.count_steps) {
                stats.march_steps = passes.march.work().x;
                stats.march_reads = passes.march.work().y;
            }
        }
    }
    if (stats.blades_considered > 0) {
        const auto counts = ground.cull_counts(samples_decide(settings, targets.samples()));
        stats.blades_drawn = counts[CULL_KEPT];
        stats.culled_by_frustum = counts[CULL_FRUSTUM];
        stats.culled_by_orientation = counts[CULL_ORIENTATION];
        stats.culled_by_distance = counts[CULL_DISTANCE];
        stats.culled_by_occlusion = counts[CULL_OCCLUSION];
        stats.culled_by_samples = counts[CULL_SAMPLES];
    }
    return stats;
}

void ViewState::reload(std::vector<std::string>& failures) {
    render::reload(&depth_pyramid, failures);
    render::reload(&block_samples, failures);
    clipmap.refill();
    reloads = field->reloads;
}

} // namespace sward::render
