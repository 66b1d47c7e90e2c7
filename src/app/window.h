// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <glm/glm.hpp>

struct GLFWwindow;

namespace sward::app {

/// What the keys of the viewer do once when pressed. The order is that of kKeys.
enum class Action { kFlow, kArrows, kHelp, kPose, kScreenshot, kReload, kPanel, kQuit, kDelete, kRedo, kSave, kUndo, kCount };

struct KeyBinding {
    char key; ///< as on a US keyboard; 0x1b is Esc, 0x7f Del
    const char* name;
    const char* help;
    bool ctrl = false; ///< only together with Ctrl; the others only without
};
/// Declared once: the window listens to these, the help overlay lists them.
inline constexpr std::array<KeyBinding, static_cast<std::size_t>(Action::kCount)> kKeys = {{
    {'F', "F", "show the flow of the wind"},
    {'G', "G", "edit the wind's arrows: gusts that a click sets"},
    {'H', "H", "this help"},
    {'K', "K", "print the pose on stdout, in the form --camera takes"},
    {'P', "P", "screenshot: sward-NNNN in the working directory"},
    {'R', "R", "reload shaders"},
    {'T', "T", "show or hide the panel"},
    {0x1b, "Esc", "quit"},
    {0x7f, "Del", "editor: take out the selected point, with shift all that continues it"},
    {'Y', "Ctrl+Y", "editor: redo", true},
    {'S', "Ctrl+S", "editor: save the arrows into the scene file", true},
    {'Z', "Ctrl+Z", "editor: undo", true},
}};

/// What keyboard, mouse and gamepad ask for in one frame.
struct Input {
    glm::dvec3 move{0, 0, 0};   ///< right, up, forward: -1..1 each
    glm::dvec2 look_px{0, 0};   ///< mouse, right and down, while its right button is held
    glm::dvec2 look_rate{0, 0}; ///< gamepad: yaw and pitch, -1..1
    double wheel = 0;           ///< notches, up positive
    bool fast = false;
    std::array<bool, static_cast<std::size_t>(Action::kCount)> pressed{};

    [[nodiscard]] bool has(Action action) const {
        return pressed[static_cast<std::size_t>(action)];
    }
};

/// A window with an OpenGL 4.5 core context, current on this thread while it lives. Starts hidden:
/// a scene may take a while to load. One at a time. Throws Error(kNoGpu) without a display or
/// without OpenGL 4.5, with a hint to `render`.
class Window {
public:
    Window(const std::string& title, int width, int height, bool debug);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    void show();
    [[nodiscard]] bool closed() const;
    /// In pixels; 0 x 0 while minimised.
    [[nodiscard]] glm::ivec2 framebuffer_size() const;
    /// Takes the events since the last call. A panel that has the mouse or the keyboard keeps their
    /// input.
    [[nodiscard]] Input poll(bool panel_has_mouse, bool panel_has_keyboard);
    /// Sleeps until something happens: for a minimised window.
    void wait() const;
    void swap();
    [[nodiscard]] GLFWwindow* handle() const { return window_; }

private:
    void read_keyboard(Input& input) const;
    void read_mouse(Input& input, bool panel_has_mouse);
    static void read_gamepad(Input& input);

    GLFWwindow* window_ = nullptr;
    bool looking_ = false;    ///< the right button holds the mouse
    glm::dvec2 cursor_{0, 0}; ///< where it was, pixels
};

} // namespace sward::app
