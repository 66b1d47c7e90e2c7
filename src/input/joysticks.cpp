// SPDX-License-Identifier: Apache-2.0
#include "input/joysticks.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace sward::input {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNamedBytes = 11; // of the name in a GUID

template<std::size_t N> bool has(const std::array<std::uint8_t, N>& bits, int code) {
    return (bits[static_cast<std::size_t>(code) / 8] >> (code % 8) & 1) != 0;
}

std::string hex_pair(std::uint16_t value) {
    return fmt::format("{:02x}{:02x}", value & 0xff, value >> 8);
}

/// The number in "event17"; nothing for another name.
std::optional<int> event_number(const std::string& name) {
    constexpr std::string_view kStart = "event";
    int number = 0;
    if (!name.starts_with(kStart))
        return std::nullopt;
    const auto [end, error] =
        std::from_chars(name.data() + kStart.size(), name.data() + name.size(), number);
    return error == std::errc() && end == name.data() + name.size() ? std::optional(number)
                                                                    : std::nullopt;
}

std::optional<DeviceFacts> ask(int handle) {
    DeviceFacts facts;
    std::array<char, 256> name{};
    if (ioctl(handle, EVIOCGID, &facts.id) < 0 ||
        ioctl(handle, EVIOCGBIT(0, sizeof facts.events), facts.events.data()) < 0 ||
        ioctl(handle, EVIOCGBIT(EV_KEY, sizeof facts.keys), facts.keys.data()) < 0 ||
        ioctl(handle, EVIOCGBIT(EV_ABS, sizeof facts.axes), facts.axes.data()) < 0)
        return std::nullopt;
    if (ioctl(handle, EVIOCGNAME(name.size() - 1), name.data()) > 0)
        facts.name = name.data();
    return facts;
}

} // namespace

std::string guid_of(const input_id& id, const std::string& name) {
    std::string guid = hex_pair(id.bustype) + "0000";
    if (id.vendor != 0 && id.product != 0 && id.version != 0)
        return guid + hex_pair(id.vendor) + "0000" + hex_pair(id.product) + "0000" +
               hex_pair(id.version) + "0000";
    for (std::size_t i = 0; i < kNamedBytes; ++i)
        guid += fmt::format("{:02x}", i < name.size() ? static_cast<unsigned char>(name[i]) : 0);
    return guid + "00";
}

std::optional<Joystick> joystick_of(const DeviceFacts& facts) {
    if (!has(facts.events, EV_KEY) || !has(facts.events, EV_ABS))
        return std::nullopt;
    if (has(facts.keys, BTN_TOUCH) || has(facts.keys, BTN_TOOL_PEN) ||
        has(facts.keys, BTN_TOOL_FINGER) || has(facts.keys, BTN_MOUSE))
        return std::nullopt;
    bool plays = false;
    for (const int code : {ABS_WHEEL, ABS_GAS, ABS_BRAKE, ABS_RUDDER, ABS_THROTTLE})
        plays = plays || has(facts.axes, code);
    for (int code = BTN_JOYSTICK; code < BTN_DIGI; ++code)
        plays = plays || has(facts.keys, code);
    if (!plays)
        return std::nullopt;
    Joystick joystick;
    joystick.name = facts.name;
    joystick.guid = guid_of(facts.id, facts.name);
    for (int code = BTN_MISC; code < KEY_CNT; ++code)
        joystick.buttons += has(facts.keys, code);
    for (int code = 0; code < ABS_CNT; ++code) {
        const bool hat = code >= ABS_HAT0X && code <= ABS_HAT3Y;
        if (has(facts.axes, code))
            (hat ? joystick.hats : joystick.axes) += 1;
        if (hat && has(facts.axes, code))
            ++code; // its other axis
    }
    return joystick;
}

std::vector<Joystick> list_joysticks(int& unreadable, const fs::path& folder) {
    std::vector<std::pair<int, fs::path>> nodes;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (const auto number = event_number(at->path().filename().native()))
            nodes.emplace_back(*number, at->path());
    std::sort(nodes.begin(), nodes.end());
    std::vector<Joystick> joysticks;
    unreadable = 0;
    for (const auto& [number, node] : nodes) {
        const int handle = open(node.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
        if (handle < 0) {
            unreadable += errno == EACCES || errno == EPERM;
            continue;
        }
        const std::optional<DeviceFacts> facts = ask(handle);
        close(handle);
        if (!facts)
            continue;
        if (std::optional<Joystick> joystick = joystick_of(*facts)) {
            joystick->node = node;
            joysticks.push_back(std::move(*joystick));
        }
    }
    return joysticks;
}

} // namespace sward::input
