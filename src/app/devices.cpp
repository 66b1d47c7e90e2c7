// SPDX-License-Identifier: Apache-2.0
#include "app/devices.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>
#include <vector>

#include "input/controls_file.h"

namespace sward::app {
namespace {

constexpr std::string_view kHandBrake = "hand_brake";
constexpr int kCameras = 9;

constexpr std::array<std::pair<std::string_view, Action>, 25> kNames = {{
    {"pause", Action::kPause},
    {"step", Action::kStep},
    {"slower", Action::kSlower},
    {"faster", Action::kFaster},
    {"real_time", Action::kRealTime},
    {"earlier", Action::kEarlier},
    {"later", Action::kLater},
    {"more_wind", Action::kMoreWind},
    {"less_wind", Action::kLessWind},
    {"wind_left", Action::kWindLeft},
    {"wind_right", Action::kWindRight},
    {"next_camera", Action::kDriveCamera},
    {"help", Action::kHelp},
    {"line", Action::kLine},
    {"panel", Action::kPanel},
    {"recent", Action::kRecent},
    {"full_screen", Action::kFullScreen},
    {"screenshot", Action::kScreenshot},
    {"sequence", Action::kSequence},
    {"pose", Action::kPose},
    {"flow", Action::kFlow},
    {"reload", Action::kReload},
    {"more_throttle", Action::kMoreThrottle},
    {"less_throttle", Action::kLessThrottle},
    {"quit", Action::kQuit},
}};

} // namespace

std::span<const std::string> button_actions() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const auto& [name, action] : kNames)
            all.emplace_back(name);
        for (int camera = 1; camera <= kCameras; ++camera)
            all.push_back("camera_" + std::to_string(camera));
        all.emplace_back(kHandBrake);
        return all;
    }();
    return names;
}

std::optional<Press> press_named(std::string_view name) {
    for (const auto& [known, action] : kNames)
        if (name == known)
            return Press{action};
    for (int camera = 1; camera <= kCameras; ++camera)
        if (name == "camera_" + std::to_string(camera))
            return Press{Action::kCamera, camera - 1};
    return std::nullopt;
}

input::ControlMap load_device_controls() {
    const std::filesystem::path file = input::controls_file();
    input::ControlMap map = input::load_controls(file);
    input::check_actions(map, button_actions(), file);
    return map;
}

void add_devices(const input::ControlReader& devices, Input& input) {
    using input::Axis;
    for (std::size_t i = 0; i < input::kAxes; ++i)
        input.axes[i] = devices.axis(static_cast<Axis>(i));
    input.move += glm::dvec3(input.axis(Axis::kMoveRight), input.axis(Axis::kMoveUp),
                             input.axis(Axis::kMoveForward));
    input.look_rate += glm::dvec2(input.axis(Axis::kLookRight), input.axis(Axis::kLookUp));
    input.hand_brake = input.hand_brake || devices.held(kHandBrake);
    for (const std::string& name : devices.pressed())
        if (const std::optional<Press> press = press_named(name))
            input.presses.push_back(*press);
}

} // namespace sward::app
