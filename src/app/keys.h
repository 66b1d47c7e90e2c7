// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace sward::app {

/// Keys by their place on a US keyboard. The numbers are GLFW's, which window.cpp makes sure of;
/// letters and digits are their characters.
namespace key {
inline constexpr int kSpace = 32, kMinus = 45, kPeriod = 46, kEqual = 61, kLeftBracket = 91,
                     kRightBracket = 93;
inline constexpr int kEscape = 256, kBackspace = 259, kDelete = 261, kPageUp = 266, kPageDown = 267,
                     kHome = 268, kEnd = 269;
inline constexpr int kF11 = 300, kF12 = 301;
inline constexpr int kLeftShift = 340, kLeftControl = 341, kRightShift = 344, kRightControl = 345;
} // namespace key

/// What a press asks for, once.
enum class Action {
    kFlow,
    kArrows,
    kHelp,
    kLine,
    kPose,
    kDriveCamera,
    kRecent,
    kPause,
    kReload,
    kPanel,
    kSequence,
    kCamera,
    kStep,
    kSlower,
    kFaster,
    kRealTime,
    kEarlier,
    kLater,
    kMoreWind,
    kLessWind,
    kWindLeft,
    kWindRight,
    kMoreThrottle,
    kLessThrottle,
    kEngine,
    kFullScreen,
    kScreenshot,
    kQuit,
    kDelete,
    kRedo,
    kSave,
    kUndo
};

struct KeyBinding {
    Action action;
    int key;
    std::string_view name; ///< as help and docs/simulator.md write it
    std::string_view help;
    int also = 0;         ///< another key that does the same; 0: none
    int count = 1;        ///< so many keys from `key` on, each with its number
    bool repeats = false; ///< goes on while it is held
    bool ctrl = false;    ///< only together with Ctrl; the others only without
};

/// Declared once: the window listens to these, the help lists them, a test holds docs/simulator.md
/// to them.
[[nodiscard]] std::span<const KeyBinding> key_bindings();
/// Motion, which is asked for as long as a key is held: lines for the help, likewise.
[[nodiscard]] std::span<const std::string_view> motion_lines();

struct Press {
    Action action;
    int number = 0; ///< of the keys of a binding, from 0
};

struct KeyEvent {
    int key = 0;
    bool down = false;
    bool repeat = false;
    bool ctrl = false;
    double time_s = 0; ///< of any clock that goes forward
};

/// Keys by their events: whatever happens between two slow pictures is kept, in its order.
class KeyLog {
public:
    void take(const KeyEvent& event);
    /// The window lost the keyboard: no key is held any more, for nobody would tell of its release.
    void release_all();

    /// What was asked for since the last clear().
    [[nodiscard]] const std::vector<Press>& presses() const { return presses_; }
    /// Share of the time since the last clear() that a key was held, 0 to 1. A tap counts as
    /// kTap_s, though a slow picture sees both its ends at once; a picture of more than kLongest_s
    /// counts as that long, for nothing moves further in it.
    [[nodiscard]] double held(int key, double now_s) const;
    /// Right, up, forward, -1 to 1 each, of W A S D Q E; nothing with Ctrl, which makes commands of
    /// letters.
    [[nodiscard]] glm::dvec3 motion(double now_s) const;
    [[nodiscard]] bool shift(double now_s) const {
        return held(key::kLeftShift, now_s) > 0 || held(key::kRightShift, now_s) > 0;
    }
    /// A picture has begun: what was held goes on being held, the rest is over.
    void clear(double now_s);

    static constexpr double kTap_s = 0.05, kLongest_s = 0.25;

private:
    struct Hold {
        bool down = false, pressed = false;
        double since_s = 0; ///< it is down, or since the last clear()
        double sum_s = 0;   ///< held and released since the last clear()
    };
    std::map<int, Hold> holds_;
    std::vector<Press> presses_;
    double cleared_s_ = 0;
};

} // namespace sward::app
