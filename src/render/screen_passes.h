// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <glm/glm.hpp>

#include "gl/program.h"
#include "render/targets.h"

namespace sward::render {

/// Passes that cover the screen with one triangle: sky, resolve, tone map.
class ScreenPasses {
public:
    explicit ScreenPasses(bool aov);
    ~ScreenPasses();
    ScreenPasses(const ScreenPasses&) = delete;
    ScreenPasses& operator=(const ScreenPasses&) = delete;

    /// What a host has drawn, from its textures (single-sampled 2D, of the picture's size; colour
    /// 0: black): where its depth is not that of nothing. `host_depth`: Lens's. The scene targets
    /// are bound.
    void take_scene(std::uint32_t colour, std::uint32_t depth, glm::dvec2 host_depth);
    /// Fills what nothing covered. The scene targets are bound.
    void sky();
    /// Averages samples into the resolved targets, weighted; `first` replaces what they hold, later
    /// frames add to it.
    void resolve(const Targets& targets, float weight, bool first);
    /// Resolved radiance to the 8-bit picture.
    void tone_map(const Targets& targets, float exposure);
    /// Resolved radiance and depth into a host's textures, as take_scene; 0: none.
    void hand_out(const Targets& targets, std::uint32_t colour, std::uint32_t depth,
                  glm::dvec2 host_depth);
    void reload();

private:
    void triangle() const;
    bool aov_;
    gl::Program sky_, resolve_, tone_map_;
    std::unique_ptr<gl::Program> take_scene_,
        hand_out_; ///< made for the first host that wants them
    std::uint32_t host_framebuffer_ = 0;
    std::uint32_t vertex_array_ = 0;
};

} // namespace sward::render
