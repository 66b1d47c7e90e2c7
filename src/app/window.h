// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "app/input.h"
#include "app/options.h"

struct GLFWwindow;

namespace sward::app {

/// A window with an OpenGL 4.5 core context, current on this thread while it lives. One at a time.
/// Throws Error(kNoGpu) without a display or without OpenGL 4.5, with a hint to `render`.
class Window {
public:
    Window(const std::string& title, const WindowPlace& place, bool debug);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    [[nodiscard]] bool closed() const;
    /// In pixels; 0 x 0 while minimised.
    [[nodiscard]] glm::ivec2 framebuffer_size() const;
    /// Takes the events since the last call. A panel that has the mouse or the keyboard keeps their
    /// input.
    [[nodiscard]] Input poll(bool panel_has_mouse, bool panel_has_keyboard);
    /// Joysticks, wheels and pedals, bound by their GUIDs; they come and go as they are plugged in.
    void use_devices(input::ControlMap map);
    /// Notes events and leaves them for poll(): often, while something takes long. Touches no GL
    /// state.
    void listen() const;
    /// Whether Esc was pressed, or the window closed, and poll() has not told yet.
    [[nodiscard]] bool asked_to_end() const;
    /// Forgets the keys pressed so far: they were meant for a scene that is gone.
    void forget_keys();
    /// A file that was dropped onto the window since the last call, the last one of them.
    [[nodiscard]] std::optional<std::filesystem::path> take_dropped();

    void toggle_full_screen();
    void set_title(const std::string& title);
    /// Sleeps until something happens: for a minimised window.
    void wait() const;
    void swap();
    [[nodiscard]] GLFWwindow* handle() const { return window_; }

private:
    void read_mouse(Input& input, bool panel_has_mouse);
    void read_devices(Input& input);
    void read_gamepad(Input& input) const;

    GLFWwindow* window_ = nullptr;
    bool looking_ = false;    ///< the right button holds the mouse
    glm::dvec2 cursor_{0, 0}; ///< where it was, pixels
    glm::ivec4 in_window_{0}; ///< x, y, width, height before full screen
    std::string title_;
    input::ControlReader devices_{{}};
};

} // namespace sward::app
