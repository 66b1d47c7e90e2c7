// SPDX-License-Identifier: Apache-2.0
#include "app/joystick_list.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/devices.h"
#include "base/error.h"
#include "base/log.h"
#include "input/controls_file.h"
#include "input/joysticks.h"

namespace sward::app {
namespace {

/// What to write for a device that is not in the file: its first axis and its first button.
std::string beginning_for(const input::Joystick& joystick) {
    input::DeviceBinding device{joystick.guid, base::printable(joystick.name), {}, {}};
    if (joystick.axes > 0)
        device.axes.push_back({});
    if (joystick.buttons > 0)
        device.buttons.push_back({0, "pause"});
    const std::string text = input::format_controls({{device}});
    return text.substr(text.find("\n[[") + 1); // without the file's first line
}

} // namespace

void list_joysticks() {
    const std::filesystem::path file = input::controls_file();
    const input::ControlMap map = load_device_controls();
    const std::string where = file.empty() ? "controls.toml" : base::printable(file.native(), 1024);
    int unreadable = 0;
    const std::vector<input::Joystick> joysticks = input::list_joysticks(unreadable);
    for (const input::Joystick& joystick : joysticks) {
        const input::DeviceBinding* const bound = map.find(joystick.guid);
        const std::string use = bound
                                    ? fmt::format("{} axes and {} buttons in {}",
                                                  bound->axes.size(), bound->buttons.size(), where)
                                    : "not in " + where;
        fmt::print("{}  {}: {} axes, {} buttons, {} hats, {}; {}\n", joystick.guid,
                   base::printable(joystick.name), joystick.axes, joystick.buttons, joystick.hats,
                   joystick.node.native(), use);
    }
    for (const input::Joystick& joystick : joysticks)
        if (map.find(joystick.guid) == nullptr)
            fmt::print("\n# for {}:\n{}", where, beginning_for(joystick));
    if (joysticks.empty())
        base::log_info("joysticks: none that can be read");
    if (unreadable > 0)
        base::log_info(fmt::format(
            "joysticks: {} devices of /dev/input may not be read by this user", unreadable));
    flush_results();
}

} // namespace sward::app
