// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/sim_clock.h"
#include "app/weather.h"
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
    const std::string& gpu;
    const std::vector<std::string>& cameras; ///< of the scene, in the order of their keys
};

/// What it edits.
struct PanelEdits {
    render::FrameSettings& settings;
    SimClock& clock;
    Weather& weather;
    std::optional<int> camera = {}; ///< chosen in this frame
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

    /// Everything below stands between these two. end() draws into the window's framebuffer.
    void begin();
    void end();

    void draw(PanelEdits& edits, const PanelFacts& facts);
    /// One line along the upper edge.
    static void draw_line(const std::string& line);
    void draw_help();
    /// A list to choose from; what was chosen.
    [[nodiscard]] std::optional<std::filesystem::path>
    draw_recent(const std::vector<std::filesystem::path>& scenes);
    /// Shaders that did not build.
    static void draw_messages(const std::vector<std::string>& messages);
    /// A few words at the lower edge.
    static void draw_word(const std::string& word);
    /// All there is while a scene loads. `share` below 0: not known.
    static void draw_load(const std::string& scene, const std::string& what, double share,
                          double elapsed_s);

    bool shown = true;
    bool help = false;
    bool recent = false;
};

} // namespace sward::app
