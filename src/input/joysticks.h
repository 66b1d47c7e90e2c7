// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <linux/input.h>

namespace sward::input {

/// What the kernel says of an input device: its ids, its name, and which events it can send.
struct DeviceFacts {
    input_id id{};
    std::string name;
    template<std::size_t N> using Bits = std::array<std::uint8_t, (N + 7) / 8>;
    Bits<EV_CNT> events{};
    Bits<KEY_CNT> keys{};
    Bits<ABS_CNT> axes{};
};

struct Joystick {
    std::string guid; ///< as SDL and GLFW have it: 32 hex digits
    std::string name;
    int axes = 0, buttons = 0, hats = 0; ///< counted as GLFW numbers them
    std::filesystem::path node;          ///< /dev/input/event17
};

/// Bus, vendor, product and version; of a device that has none of these, bus and the start of its
/// name.
[[nodiscard]] std::string guid_of(const input_id& id, const std::string& name);
/// Nothing where it is no joystick, wheel, pedals or gamepad: keyboards, mice, touch pads and
/// tablets have axes too.
[[nodiscard]] std::optional<Joystick> joystick_of(const DeviceFacts& facts);

/// Those that are plugged in and may be read, by their nodes' numbers. Needs no window.
/// `unreadable` counts nodes that this user may not open.
[[nodiscard]] std::vector<Joystick>
list_joysticks(int& unreadable, const std::filesystem::path& folder = "/dev/input");

} // namespace sward::input
