// SPDX-License-Identifier: Apache-2.0
#include "app/keys.h"

#include <algorithm>
#include <array>

namespace sward::app {
namespace {

// action, key, name, help, also, count, repeats, ctrl
constexpr std::array kBindings = {
    KeyBinding{Action::kHelp, 'H', "H", "this help"},
    KeyBinding{Action::kLine, 'I', "I", "shows or hides the line with speed, height and times"},
    KeyBinding{Action::kPanel, 'T', "T", "shows or hides the panel"},
    KeyBinding{Action::kPause, 'P', "P, Space", "time stands, or goes on", key::kSpace},
    KeyBinding{Action::kStep, key::kPeriod, ".", "one step of time, and it stands", 0, 1, true},
    KeyBinding{Action::kSlower, key::kMinus, "-", "time at half its pace, to a sixteenth"},
    KeyBinding{Action::kFaster, key::kEqual, "=", "time at twice its pace, to four times"},
    KeyBinding{Action::kRealTime, key::kBackspace, "Backspace", "time at the clock's pace"},
    KeyBinding{Action::kEarlier, key::kLeftBracket, "[", "a quarter of an hour earlier in the day",
               0, 1, true},
    KeyBinding{Action::kLater, key::kRightBracket, "]", "a quarter of an hour later in the day", 0,
               1, true},
    KeyBinding{Action::kMoreWind, key::kPageUp, "PgUp", "wind stronger by 1 m/s", 0, 1, true},
    KeyBinding{Action::kLessWind, key::kPageDown, "PgDn", "wind weaker by 1 m/s", 0, 1, true},
    KeyBinding{Action::kWindLeft, key::kHome, "Home", "wind from 10 degrees further left", 0, 1,
               true},
    KeyBinding{Action::kWindRight, key::kEnd, "End", "wind from 10 degrees further right", 0, 1,
               true},
    KeyBinding{Action::kCamera, '1', "1-9", "the scene's cameras, in the order of their names", 0,
               9},
    KeyBinding{Action::kDriveCamera, 'C', "C",
               "driving, flying: the next camera of driver or pilot, chase, wheel"},
    KeyBinding{Action::kMoreThrottle, 'U', "U",
               "flying: a twentieth more throttle, a helicopter's lever a fiftieth up", 0, 1, true},
    KeyBinding{Action::kLessThrottle, 'J', "J", "flying: so much less", 0, 1, true},
    KeyBinding{Action::kEngine, 'N', "N", "flying: a helicopter's engine off, or on again"},
    KeyBinding{Action::kRecent, 'O', "O", "recent scenes"},
    KeyBinding{Action::kFullScreen, key::kF11, "F11", "full screen, or the window again"},
    KeyBinding{Action::kScreenshot, key::kF12, "F12",
               "screenshot: sward-NNNN in the working directory"},
    KeyBinding{Action::kSequence, 'V', "V",
               "begins or ends a sequence: every picture, in a folder sward-seq-NNNN"},
    KeyBinding{Action::kPose, 'K', "K",
               "prints the pose on stdout, in the form that --camera takes"},
    KeyBinding{Action::kFlow, 'F', "F", "shows or hides the flow of the wind"},
    KeyBinding{Action::kArrows, 'G', "G", "opens or closes the editor of the wind's arrows"},
    KeyBinding{Action::kReload, 'R', "R", "reloads shaders"},
    KeyBinding{Action::kQuit, key::kEscape, "Esc",
               "quits; while a scene loads or a picture takes long too"},
    KeyBinding{Action::kDelete, key::kDelete, "Del",
               "editor: takes out the selected point, with shift all that continues it"},
    KeyBinding{Action::kRedo, 'Y', "Ctrl+Y", "editor: redo", 0, 1, true, true},
    KeyBinding{Action::kSave, 'S', "Ctrl+S", "editor: saves the arrows into the scene file", 0, 1,
               false, true},
    KeyBinding{Action::kUndo, 'Z', "Ctrl+Z", "editor: undo", 0, 1, true, true},
};

constexpr std::array<std::string_view, 7> kMotion = {
    "W A S D    fly, sideways       Q E    down, up",
    "driving    W S drive, brake and back, A D steer, E hand brake",
    "flying     W S nose down, up, A D bank, Q E left, right pedal",
    "right mouse button    look",
    "wheel    speed       shift    eight times as fast",
    "gamepad    left stick fly, right stick look, triggers down and up,",
    "    right bumper fast",
};

} // namespace

std::span<const KeyBinding> key_bindings() {
    return kBindings;
}

std::span<const std::string_view> motion_lines() {
    return kMotion;
}

void KeyLog::take(const KeyEvent& event) {
    if (!event.repeat) {
        Hold& hold = holds_[event.key];
        if (event.down && !hold.down) {
            hold.since_s = event.time_s;
            hold.pressed = true;
        } else if (!event.down && hold.down) {
            hold.sum_s += std::max(0.0, event.time_s - hold.since_s);
        }
        hold.down = event.down;
    }
    if (!event.down)
        return;
    for (const KeyBinding& binding : kBindings) {
        const bool mine = (event.key >= binding.key && event.key < binding.key + binding.count) ||
                          (binding.also != 0 && event.key == binding.also);
        if (mine && binding.ctrl == event.ctrl && (binding.repeats || !event.repeat))
            presses_.push_back({binding.action, binding.count > 1 ? event.key - binding.key : 0});
    }
}

void KeyLog::release_all() {
    holds_.clear();
}

double KeyLog::held(int key, double now_s) const {
    const auto found = holds_.find(key);
    const double span = std::min(now_s - cleared_s_, kLongest_s);
    if (found == holds_.end())
        return 0;
    const Hold& hold = found->second;
    if (!(span > 0))
        return hold.down || hold.pressed ? 1 : 0;
    double sum = hold.sum_s + (hold.down ? std::max(0.0, now_s - hold.since_s) : 0.0);
    if (hold.pressed)
        sum = std::max(sum, kTap_s);
    return std::min(1.0, sum / span);
}

glm::dvec3 KeyLog::motion(double now_s) const {
    if (held(key::kLeftControl, now_s) > 0 || held(key::kRightControl, now_s) > 0)
        return glm::dvec3(0);
    const auto pair = [&](int minus, int plus) { return held(plus, now_s) - held(minus, now_s); };
    return {pair('A', 'D'), pair('Q', 'E'), pair('S', 'W')};
}

void KeyLog::clear(double now_s) {
    presses_.clear();
    for (auto& [key, hold] : holds_) {
        hold.pressed = false;
        hold.sum_s = 0;
        hold.since_s = now_s;
    }
    cleared_s_ = now_s;
}

} // namespace sward::app
