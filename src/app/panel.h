// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "render/settings.h"
#include "scene/scene.h"

struct GLFWwindow;

namespace sward::app {

/// What the panel shows and does not edit.
struct PanelFacts {
    const render::FrameStats& stats;
    const scene::Pose& pose; ///< above the datum
    double ground_m = 0;
    std::string note; ///< of what moves the eye
    double frame_ms = 0;
    double time_s = 0;
    const std::string& gpu;
    const std::vector<std::string>& messages; ///< of shaders that did not build
};

/// Dear ImGui over the finished frame. Needs the window's context current from construction to
/// destruction.
class Panel {
public:
    explicit Panel(GLFWwindow* window);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    [[nodiscard]] bool has_mouse() const;
    [[nodiscard]] bool has_keyboard() const;
    /// Draws into the window's framebuffer; edits `settings` and `running` (whether simulated time
    /// goes on). `more` adds its own windows and overlays to the same ImGui frame.
    void draw(render::FrameSettings& settings, bool& running, const PanelFacts& facts,
              const std::function<void()>& more);

    bool shown = true;
    bool help = false;
};

} // namespace sward::app
