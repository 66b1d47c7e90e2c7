// SPDX-License-Identifier: Apache-2.0
#include "app/window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include "app/devices.h"
#include "base/error.h"

namespace sward::app {
namespace {

constexpr double kStickDeadZone = 0.15; // worn sticks rest this far from the middle
constexpr double kWaitSeconds = 0.2;

// GLFW tells these by callback alone, and of one window at a time.
double g_wheel = 0; // notches since the last poll
KeyLog g_keys;
std::optional<std::filesystem::path> g_dropped;
std::string g_glfw_error; // the last one, for the message

static_assert(key::kSpace == GLFW_KEY_SPACE && key::kMinus == GLFW_KEY_MINUS &&
              key::kPeriod == GLFW_KEY_PERIOD && key::kEqual == GLFW_KEY_EQUAL &&
              key::kLeftBracket == GLFW_KEY_LEFT_BRACKET &&
              key::kRightBracket == GLFW_KEY_RIGHT_BRACKET && key::kEscape == GLFW_KEY_ESCAPE &&
              key::kBackspace == GLFW_KEY_BACKSPACE && key::kDelete == GLFW_KEY_DELETE &&
              key::kPageUp == GLFW_KEY_PAGE_UP && key::kPageDown == GLFW_KEY_PAGE_DOWN &&
              key::kHome == GLFW_KEY_HOME && key::kEnd == GLFW_KEY_END &&
              key::kF11 == GLFW_KEY_F11 && key::kF12 == GLFW_KEY_F12 &&
              key::kLeftShift == GLFW_KEY_LEFT_SHIFT &&
              key::kLeftControl == GLFW_KEY_LEFT_CONTROL &&
              key::kRightShift == GLFW_KEY_RIGHT_SHIFT &&
              key::kRightControl == GLFW_KEY_RIGHT_CONTROL && 'A' == GLFW_KEY_A &&
              '1' == GLFW_KEY_1);

void on_error(int, const char* text) {
    g_glfw_error = text == nullptr ? "" : text;
}

void on_key(GLFWwindow*, int key, int, int action, int mods) {
    g_keys.take({key, action != GLFW_RELEASE, action == GLFW_REPEAT, (mods & GLFW_MOD_CONTROL) != 0,
                 glfwGetTime()});
}

void on_focus(GLFWwindow*, int focused) {
    if (focused == GLFW_FALSE)
        g_keys.release_all();
}

void on_drop(GLFWwindow*, int count, const char** paths) {
    if (count > 0)
        g_dropped = paths[count - 1];
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

Window::Window(const std::string& title, const WindowPlace& place, bool debug) : title_(title) {
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
    window_ = glfwCreateWindow(place.width, place.height, title.c_str(), nullptr, nullptr);
    if (window_ == nullptr)
        fail("no window with OpenGL 4.5");
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetKeyCallback(window_, on_key);
    glfwSetWindowFocusCallback(window_, on_focus);
    glfwSetDropCallback(window_, on_drop);
    glfwSetScrollCallback(window_, on_scroll);
    if (place.at)
        glfwSetWindowPos(window_, place.at->x, place.at->y);
    glfwShowWindow(window_);
    if (place.at) // some window managers place a window as it is shown
        glfwSetWindowPos(window_, place.at->x, place.at->y);
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
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

void Window::listen() const {
    glfwPollEvents();
}

bool Window::asked_to_end() const {
    const auto& presses = g_keys.presses();
    return closed() || std::any_of(presses.begin(), presses.end(), [](const Press& press) {
               return press.action == Action::kQuit;
           });
}

void Window::forget_keys() {
    g_keys.clear(glfwGetTime());
}

std::optional<std::filesystem::path> Window::take_dropped() {
    return std::exchange(g_dropped, {});
}

void Window::set_title(const std::string& title) {
    if (title == title_)
        return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::toggle_full_screen() {
    if (glfwGetWindowMonitor(window_) != nullptr) {
        glfwSetWindowMonitor(window_, nullptr, in_window_.x, in_window_.y, in_window_.z,
                             in_window_.w, 0);
        return;
    }
    glfwGetWindowPos(window_, &in_window_.x, &in_window_.y);
    glfwGetWindowSize(window_, &in_window_.z, &in_window_.w);
    // The monitor that holds the window's middle.
    int count = 0;
    GLFWmonitor** const monitors = glfwGetMonitors(&count);
    const glm::ivec2 middle{in_window_.x + in_window_.z / 2, in_window_.y + in_window_.w / 2};
    GLFWmonitor* chosen = glfwGetPrimaryMonitor();
    for (int i = 0; i < count; ++i) {
        glm::ivec2 at{0};
        glfwGetMonitorPos(monitors[i], &at.x, &at.y);
        const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
        if (mode != nullptr && middle.x >= at.x && middle.y >= at.y &&
            middle.x < at.x + mode->width && middle.y < at.y + mode->height)
            chosen = monitors[i];
    }
    const GLFWvidmode* const mode = chosen == nullptr ? nullptr : glfwGetVideoMode(chosen);
    if (mode != nullptr)
        glfwSetWindowMonitor(window_, chosen, 0, 0, mode->width, mode->height, mode->refreshRate);
    glfwSwapInterval(1); // some drivers forget it
}

Input Window::poll(bool panel_has_mouse, bool panel_has_keyboard) {
    glfwPollEvents();
    const double now = glfwGetTime();
    Input input;
    if (!panel_has_keyboard) {
        input.presses = g_keys.presses();
        input.move = g_keys.motion(now);
        input.fast = g_keys.shift(now);
    }
    g_keys.clear(now);
    read_mouse(input, panel_has_mouse);
    read_gamepad(input);
    read_devices(input);
    input.move = glm::clamp(input.move, -1.0, 1.0);
    return input;
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

void Window::use_devices(input::ControlMap map) {
    devices_ = input::ControlReader(std::move(map));
}

void Window::read_devices(Input& input) {
    std::vector<input::DeviceReading> readings;
    for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
        const char* const guid = glfwGetJoystickGUID(id);
        if (guid == nullptr)
            continue;
        int axes = 0, buttons = 0;
        const float* const axis = glfwGetJoystickAxes(id, &axes);
        const unsigned char* const button = glfwGetJoystickButtons(id, &buttons);
        readings.push_back({guid,
                            {axis, static_cast<std::size_t>(axes)},
                            {button, static_cast<std::size_t>(buttons)}});
    }
    devices_.read(readings);
    add_devices(devices_, input);
}

/// The first gamepad flies by its standard layout, unless controls.toml says what it does.
void Window::read_gamepad(Input& input) const {
    GLFWgamepadstate pad{};
    for (int id = GLFW_JOYSTICK_1; id <= GLFW_JOYSTICK_LAST; ++id) {
        const char* const guid = glfwGetJoystickGUID(id);
        if (glfwJoystickIsGamepad(id) == GLFW_FALSE ||
            glfwGetGamepadState(id, &pad) == GLFW_FALSE ||
            (guid != nullptr && devices_.map().find(guid) != nullptr))
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
        return;
    }
}

} // namespace sward::app
