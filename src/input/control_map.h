// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sward::input {

/// What an axis of a device can move.
enum class Axis {
    kSteer,
    kThrottle,
    kBrake,
    kClutch, // on the ground
    kRoll,
    kPitch,
    kYaw,
    kCollective, // in the air; the throttle too
    kMoveRight,
    kMoveUp,
    kMoveForward,
    kLookRight,
    kLookUp, // the free camera
    kCount
};
inline constexpr std::size_t kAxes = static_cast<std::size_t>(Axis::kCount);
/// As controls.toml names it: "steer".
[[nodiscard]] std::string_view name_of(Axis axis);
[[nodiscard]] std::optional<Axis> axis_of(std::string_view name);
/// Pedals and levers rest at one end and go from 0 to 1; all others rest in the middle, -1 to 1.
[[nodiscard]] bool is_one_sided(Axis axis);

struct AxisBinding {
    int number = 0; ///< of the device's axis, from 0
    Axis axis = Axis::kSteer;
    bool invert = false;
    double dead_zone =
        0.05; ///< of the way from where it rests to its end, in which nothing moves; 0 to 0.9
    double curve = 1; ///< power: above 1 finer about where it rests; 0.2 to 5
};
struct ButtonBinding {
    int number = 0;
    std::string action; ///< its name, which the reader of this does not know
};
struct DeviceBinding {
    std::string guid; ///< 32 hex digits in lower case, as SDL and GLFW have it
    std::string name; ///< for people; may be empty
    std::vector<AxisBinding> axes;
    std::vector<ButtonBinding> buttons;
};
struct ControlMap {
    std::vector<DeviceBinding> devices; ///< no GUID twice

    [[nodiscard]] const DeviceBinding* find(std::string_view guid) const;
};

/// What a device's axis at `raw` (-1 to 1; no number counts as 0) makes of its control: -1 to 1, or
/// 0 to 1 where that is one-sided.
[[nodiscard]] double shape(const AxisBinding& binding, double raw);

/// A device as it is now. Of devices with the same GUID each is its own.
struct DeviceReading {
    std::string_view guid;
    std::span<const float> axes;            ///< -1 to 1
    std::span<const unsigned char> buttons; ///< not 0: down
};

/// Controls out of devices, picture by picture: they come and go as they are plugged in.
class ControlReader {
public:
    explicit ControlReader(ControlMap map) : map_(std::move(map)) {}

    /// Devices without a binding, and numbers that a device does not have, say nothing.
    void read(std::span<const DeviceReading> devices);
    /// Of several that move the same control the one farthest from its rest counts. 0 where none
    /// does.
    [[nodiscard]] double axis(Axis axis) const { return axes_[static_cast<std::size_t>(axis)]; }
    /// Actions whose buttons went down since the read before, in the order of devices and buttons.
    /// What is down as a device appears has not gone down.
    [[nodiscard]] const std::vector<std::string>& pressed() const { return pressed_; }
    [[nodiscard]] bool held(std::string_view action) const;
    [[nodiscard]] const ControlMap& map() const { return map_; }

private:
    void read_buttons(const DeviceBinding& binding, const DeviceReading& device, int copy);

    ControlMap map_;
    std::array<double, kAxes> axes_{};
    std::vector<std::string> pressed_, held_;
    using Key = std::pair<std::string, int>; ///< GUID, and which of those that share it
    std::map<Key, std::vector<unsigned char>> before_, now_;
};

} // namespace sward::input
