// SPDX-License-Identifier: Apache-2.0
#include "app/window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "base/error.h"

namespace sward::app {
namespace {

constexpr double kStickDeadZone = 0.15; // worn sticks rest this far from the middle
constexpr double kWaitSeconds = 0.2;

// Since the last poll: GLFW tells these only by callback.
double g_wheel = 0; // notches
std::array<bool, kKeys.size()> g_pressed{};
std::string g_glfw_error; // the last one, for the message

void on_error(int, const char* text) {
    g_glfw_error = text == nullptr ? "" : text;
}

/// Presses, not the state of keys: in a slow frame a key goes down and up again unseen.
void on_key(GLFWwindow*, int key, int, int action, int mods) {
    const auto code = [](char name) {
        return name == 0x1b ? GLFW_KEY_ESCAPE : name == 0x7f ? GLFW_KEY_DELETE : static_cast<int>(name);
    };
    const bool ctrl = (mods & GLFW_MOD_CONTROL) != 0;
    for (std::size_t i = 0; i < kKeys.size(); ++i)
        if (action == GLFW_PRESS && key == code(kKeys[i].key) && ctrl == kKeys[i].ctrl)
            g_pressed[i] = true;
}

void on_scroll(GLFWwindow*, double, double y) {
    g_wheel += y;
}

[[noreturn]] void fail(std::string_view what) {
    const std::string reason =
        g_glfw_error.empty() ? "" : " (" + base::printable(g_glfw_error, 200) + ")";
    glfwTerminate();
    throw base::Error(
        base::ExitCode::kNoGpu,
        fmt::format("view: found {}{}, expected a display with OpenGL 4.5; `sward render "
                    "SCENE -o OUT.png` draws the same without one",
                    what, reason));
}

bool has_display() {
    for (const char* const name : {"DISPLAY", "WAYLAND_DISPLAY"}) {
        const char* const value = std::getenv(name);
        if (value != nullptr && *value != '\0')
            return true;
    }
    return false;
}

double axis(float value) {
    const double size = std::abs(static_cast<double>(value));
    if (!(size > kStickDeadZone)) // also a NaN of a broken driver
        return 0;
    return std::copysign(std::min(1.0, (size - kStickDeadZone) / (1 - kStickDeadZone)), value);
}

} // namespace

Window::Window(const std::string& title, int width, int height, bool debug) {
    if (!has_display())
        fail("neither DISPLAY nor WAYLAND_DISPLAY set");
    glfwSetErrorCallback(on_error);
    if (glfwInit() != GLFW_TRUE)
        fail("no usable display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, debug ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0); // the renderer draws into targets of its own
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr)
        fail("no window with OpenGL 4.5");
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetKeyCallback(window_, on_key);
    glfwSetScrollCallback(window_, on_scroll);
    glfwSetInputMode(window_, GLFW_STICKY_KEYS, GLFW_TRUE); // a tap within one slow frame moves
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Window::show() {
    glfwShowWindow(window_);
}

bool Window::closed() const {
    return glfwWindowShouldClose(window_) != GLFW_FALSE;
}

glm::ivec2 Window::framebuffer_size() const {
    glm::ivec2 size{0, 0};
    if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_FALSE)
        glfwGetFramebufferSize(window_, &size.x, &size.y);
    return size;
}

void Window::wait() const {
    glfwWaitEventsTimeout(kWaitSeconds);
}

void Window::swap() {
    glfwSwapBuffers(window_);
}

Input Window::poll(bool panel_has_mouse, bool panel_has_keyboard) {
    glfwPollEvents();
    Input input;
    if (!panel_has_keyboard)
        input.pressed = g_pressed;
    g_pressed = {};
    if (!panel_has_keyboard)
        read_keyboard(input);
    read_mouse(input, panel_has_mouse);
    read_gamepad(input);
    input.move = glm::clamp(input.move, -1.0, 1.0);
    return input;
}

void Window::read_keyboard(Input& input) const {
    const auto pair = [&](int minus, int plus) {
        return static_cast<double>(glfwGetKey(window_, plus) == GLFW_PRESS) -
               static_cast<double>(glfwGetKey(window_, minus) == GLFW_PRESS);
    };
    input.move = {pair(GLFW_KEY_A, GLFW_KEY_D), pair(GLFW_KEY_Q, GLFW_KEY_E),
                  pair(GLFW_KEY_S, GLFW_KEY_W)};
    // Ctrl makes commands of letters: saving must not fly backwards. Asked after the letters, so that none of them sticks.
    if (glfwGetKey(window_, GLFW_KEY_LEFT_CONTROL) == GLFW_PRESS ||
        glfwGetKey(window_, GLFW_KEY_RIGHT_CONTROL) == GLFW_PRESS)
        input.move = {0, 0, 0};
    input.fast = glfwGetKey(window_, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                 glfwGetKey(window_, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
}

void Window::read_mouse(Input& input, bool panel_has_mouse) {
    input.wheel = panel_has_mouse ? 0 : g_wheel;
    g_wheel = 0;
    const bool held = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS &&
                      (looking_ || !panel_has_mouse);
    glm::dvec2 cursor{0, 0};
    if (held != looking_) {
        glfwSetInputMode(window_, GLFW_CURSOR, held ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
        glfwGetCursorPos(window_, &cursor.x, &cursor.y);
        looking_ = held; // the jump of the cursor as it is caught is no look
    } else {
        glfwGetCursorPos(window_, &cursor.x, &cursor.y);
        if (held)
            input.look_px = cursor - cursor_;
    }
    cursor_ = cursor;
}

void Window::read_gamepad(Input& input) {
    GLFWgamepadstate pad{};
    for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
        if (glfwJoystickIsGamepad(id) == GLFW_FALSE || glfwGetGamepadState(id, &pad) == GLFW_FALSE)
            continue;
        const auto trigger = [&](int index) {
            return 0.5 * (static_cast<double>(pad.axes[index]) + 1);
        };
        input.move += glm::dvec3(axis(pad.axes[GLFW_GAMEPAD_AXIS_LEFT_X]),
                                 trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER) -
                                     trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER),
                                 -axis(pad.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]));
        input.look_rate += glm::dvec2(axis(pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_X]),
                                      -axis(pad.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]));
        input.fast = input.fast || pad.buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] == GLFW_PRESS;
        return; // the first gamepad flies
    }
}

} // namespace sward::app
