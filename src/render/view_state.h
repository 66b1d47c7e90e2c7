// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blades/depth_pyramid.h"
#include "render/field_state.h"
#include "render/targets.h"
#include "scene/image.h"

namespace sward::render {

/// Textures of a host, single-sampled 2D of the picture's size, beside the view's own display
/// picture; 0: none.
struct HostTextures {
    std::uint32_t colour = 0,
                  depth = 0; ///< written: linear radiance; depth as the camera's matrix has it
    std::uint32_t scene_colour = 0,
                  scene_depth = 0; ///< read: what the host has drawn already, likewise
    [[nodiscard]] bool takes_scene() const { return scene_depth != 0; }
    [[nodiscard]] bool gives() const { return colour != 0 || depth != 0; }
    bool display = true; ///< the 8-bit picture is made
};

/// What sward::View holds: targets, constants and a clipmap of its own.
struct ViewState {
    explicit ViewState(std::shared_ptr<FieldState> of);

    /// Draws the field as it now is into the view's own targets, and the host's textures. Throws
    /// Error(kOverLimit) over the GPU's size or sample limit, (kBadInput) for a camera that is
    /// none.
    void draw(const Camera& camera, const FrameSettings& settings, const HostTextures& host);
    /// Copies the tone-mapped picture into the framebuffer `fbo` (0: the window's), bottom-left at
    /// `x`, `y`.
    void present(std::uint32_t fbo, int x, int y) const;

    /// The picture just drawn, tone-mapped, 8-bit sRGB. Waits for the GPU.
    [[nodiscard]] scene::Picture read_picture() const;
    /// The picture just drawn as linear floats. `names` out of color, depth, tier, coverage,
    /// tangent, normal, rank; needs settings.aov for all but color and depth. Channel names:
    /// docs/commands.md.
    [[nodiscard]] scene::Image read_aovs(const std::vector<std::string>& names) const;
    /// Counts and times of the picture just drawn and of the simulation before it. Waits for the
    /// GPU. What the passes count is there until another view of the field draws.
    [[nodiscard]] FrameStats stats() const;
    /// Recompiles what the view alone has; as FieldState::reload, which goes first.
    void reload(std::vector<std::string>& failures);

    std::shared_ptr<FieldState> field;
    Targets targets;
    shells::CanopyTargets canopy;
    shells::SurfaceTargets surface_canopy; ///< of a mesh
    terrain::Clipmap clipmap;
    terrain::BlockSamples block_samples;
    blades::DepthPyramid depth_pyramid;
    gl::Buffer frame_buffer;
    mutable gl::PassTimers timers; ///< reading their queries changes nothing
    FrameSettings last_settings;
    std::uint64_t blades_considered = 0;
    int reloads = 0; ///< of the field's that the clipmap knows of
};

} // namespace sward::render
