// SPDX-License-Identifier: Apache-2.0
#include "input/control_map.h"

#include <algorithm>
#include <cmath>

namespace sward::input {
namespace {

struct Named {
    std::string_view name;
    bool one_sided;
};
constexpr std::array<Named, kAxes> kNames = {{{"steer", false},
                                              {"throttle", true},
                                              {"brake", true},
                                              {"clutch", true},
                                              {"roll", false},
                                              {"pitch", false},
                                              {"yaw", false},
                                              {"collective", true},
                                              {"move_right", false},
                                              {"move_up", false},
                                              {"move_forward", false},
                                              {"look_right", false},
                                              {"look_up", false}}};

} // namespace

std::string_view name_of(Axis axis) {
    return kNames[static_cast<std::size_t>(axis)].name;
}

std::optional<Axis> axis_of(std::string_view name) {
    const auto found = std::find_if(kNames.begin(), kNames.end(),
                                    [&](const Named& named) { return named.name == name; });
    return found == kNames.end() ? std::nullopt
                                 : std::optional(static_cast<Axis>(found - kNames.begin()));
}

bool is_one_sided(Axis axis) {
    return kNames[static_cast<std::size_t>(axis)].one_sided;
}

const DeviceBinding* ControlMap::find(std::string_view guid) const {
    const auto found =
        std::find_if(devices.begin(), devices.end(),
                     [&](const DeviceBinding& device) { return device.guid == guid; });
    return found == devices.end() ? nullptr : &*found;
}

double shape(const AxisBinding& binding, double raw) {
    double value = std::isfinite(raw) ? std::clamp(raw, -1.0, 1.0) : 0;
    if (binding.invert)
        value = -value;
    if (is_one_sided(binding.axis))
        value = 0.5 * (value + 1);
    const double far = (std::abs(value) - binding.dead_zone) / (1 - binding.dead_zone);
    return far <= 0 ? 0 : std::copysign(std::pow(far, binding.curve), value);
}

void ControlReader::read(std::span<const DeviceReading> devices) {
    axes_ = {};
    pressed_.clear();
    held_.clear();
    now_.clear();
    for (const DeviceReading& device : devices) {
        const DeviceBinding* const binding = map_.find(device.guid);
        if (binding == nullptr)
            continue;
        for (const AxisBinding& axis : binding->axes) {
            if (static_cast<std::size_t>(axis.number) >= device.axes.size())
                continue;
            double& value = axes_[static_cast<std::size_t>(axis.axis)];
            const double shaped =
                shape(axis, double(device.axes[static_cast<std::size_t>(axis.number)]));
            if (std::abs(shaped) > std::abs(value))
                value = shaped;
        }
        int copy = 0;
        while (now_.contains({binding->guid, copy}))
            ++copy;
        read_buttons(*binding, device, copy);
    }
    before_ = now_;
}

void ControlReader::read_buttons(const DeviceBinding& binding, const DeviceReading& device,
                                 int copy) {
    const auto before = before_.find({binding.guid, copy});
    now_[{binding.guid, copy}].assign(device.buttons.begin(), device.buttons.end());
    for (const ButtonBinding& button : binding.buttons) {
        const auto number = static_cast<std::size_t>(button.number);
        if (number >= device.buttons.size() || device.buttons[number] == 0)
            continue;
        held_.push_back(button.action);
        if (before != before_.end() && number < before->second.size() &&
            before->second[number] == 0)
            pressed_.push_back(button.action);
    }
}

bool ControlReader::held(std::string_view action) const {
    return std::find(held_.begin(), held_.end(), action) != held_.end();
}

} // namespace sward::input
