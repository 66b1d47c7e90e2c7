// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "app/panel.h"
#include "app/window.h"
#include "render/world.h"

namespace sward::app {

/// Thrown where Esc or the window's button ends what takes long.
struct Stopped {};

/// What the window shows while a scene loads: what is being done, how far it is, and that Esc ends
/// it. The window answers meanwhile.
class LoadScreen {
public:
    LoadScreen(Window& window, Panel& panel, std::string scene);

    /// Reads everything that the scene names, in a thread of its own, while the window is kept
    /// alive. Esc ends the program at once, for files are not read by halves. Throws what
    /// load_world() throws.
    [[nodiscard]] render::World read(const scene::Scene& scene);
    /// Draws, if the last time is long enough ago, and hears the window. Throws Stopped. Keeps the
    /// context's state.
    void show(std::string_view what);

private:
    void told(std::string_view what, std::optional<double> share);
    void draw();

    using Clock = std::chrono::steady_clock;
    Window& window_;
    Panel& panel_;
    std::string scene_;
    Clock::time_point start_ = Clock::now(), drawn_{};
    std::mutex mutex_; ///< guards what_ and share_
    std::string what_;
    double share_ = -1;
};

} // namespace sward::app
