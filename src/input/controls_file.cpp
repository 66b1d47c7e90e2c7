// SPDX-License-Identifier: Apache-2.0
#include "input/controls_file.h"

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/file.h"
#include "scene/toml_reader.h"

namespace sward::input {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 20;
constexpr std::size_t kMostDevices = 64, kMostAxes = 64, kMostButtons = 256;
constexpr int kLastAxis = 63, kLastButton = 767; // a kernel's most
constexpr scene::Range kDeadZone{0, 0.9, ""}, kCurve{0.2, 5, ""};
constexpr std::size_t kGuidDigits = 32;

std::vector<std::string> axis_names() {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kAxes; ++i)
        names.emplace_back(name_of(static_cast<Axis>(i)));
    return names;
}

std::string perhaps(std::string_view name, std::span<const std::string> known) {
    const std::string nearest = base::nearest_name(name, known);
    return nearest.empty() ? "" : fmt::format(" (perhaps \"{}\")", nearest);
}

AxisBinding read_axis(scene::TableReader& table) {
    AxisBinding binding;
    std::string moves;
    table.require("axis");
    table.require("moves");
    table.integer("axis", binding.number, 0, kLastAxis);
    table.name("moves", moves);
    const std::optional<Axis> axis = axis_of(moves);
    if (!axis) {
        const std::vector<std::string> known = axis_names();
        throw table.error(
            "moves", fmt::format("\"{}\"", moves),
            fmt::format("one of {}{}", fmt::join(known, ", "), perhaps(moves, known)));
    }
    binding.axis = *axis;
    table.boolean("invert", binding.invert);
    table.number("dead_zone", binding.dead_zone, kDeadZone);
    table.number("curve", binding.curve, kCurve);
    table.finish();
    return binding;
}

ButtonBinding read_button(scene::TableReader& table) {
    ButtonBinding binding;
    table.require("button");
    table.require("does");
    table.integer("button", binding.number, 0, kLastButton);
    table.name("does", binding.action);
    table.finish();
    return binding;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

DeviceBinding read_device(scene::TableReader& table) {
    DeviceBinding device;
    std::string guid;
    table.require("guid");
    table.text("guid", guid);
    device.guid = lower(guid);
    const bool hex = std::all_of(device.guid.begin(), device.guid.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
    });
    if (device.guid.size() != kGuidDigits || !hex)
        throw table.error("guid", fmt::format("\"{}\"", base::printable(guid)),
                          "32 hex digits, as `sward view --list-joysticks` prints them");
    table.text("name", device.name);
    for (scene::TableReader& axis : table.tables("axis", kMostAxes))
        device.axes.push_back(read_axis(axis));
    for (scene::TableReader& button : table.tables("button", kMostButtons))
        device.buttons.push_back(read_button(button));
    table.finish();
    return device;
}

/// A name as TOML has it: base::printable has made control characters harmless, quotes and
/// backslashes are left.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text)
        out += (c == '"' || c == '\\')
                   ? std::string{'\\', c}
                   : std::string(1, static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c);
    return out + "\"";
}

} // namespace

ControlMap parse_controls(const std::string& text, const fs::path& file) {
    const toml::table document = scene::parse_toml(text, file);
    scene::TableReader root(document, file, "");
    ControlMap map;
    for (scene::TableReader& table : root.tables("device", kMostDevices)) {
        DeviceBinding device = read_device(table);
        if (map.find(device.guid) != nullptr)
            throw table.error("guid", fmt::format("\"{}\" for the second time", device.guid),
                              "each device once");
        map.devices.push_back(std::move(device));
    }
    root.finish();
    return map;
}

ControlMap load_controls(const fs::path& file) {
    std::error_code ignored;
    if (file.empty() || !fs::exists(fs::symlink_status(file, ignored)))
        return {};
    return parse_controls(base::read_text(file, kMostBytes), file);
}

void check_actions(const ControlMap& map, std::span<const std::string> known,
                   const fs::path& file) {
    for (const DeviceBinding& device : map.devices)
        for (const ButtonBinding& button : device.buttons)
            if (std::find(known.begin(), known.end(), button.action) == known.end())
                throw base::input_error(
                    base::ExitCode::kBadInput, file, 0,
                    fmt::format("device {}: button {}: does", device.guid, button.number),
                    fmt::format("\"{}\"", button.action),
                    fmt::format("one of {}{}", fmt::join(known, ", "),
                                perhaps(button.action, known)));
}

std::string format_controls(const ControlMap& map) {
    std::string text = "# Joysticks, wheels and pedals for sward view. `sward view "
                       "--list-joysticks` prints GUIDs; docs/controls.md explains the keys.\n";
    for (const DeviceBinding& device : map.devices) {
        text += fmt::format("\n[[device]]\nguid = \"{}\"\n", device.guid);
        if (!device.name.empty())
            text += fmt::format("name = {}\n", quoted(device.name));
        for (const AxisBinding& axis : device.axes)
            text += fmt::format("\n[[device.axis]]\naxis = {}\nmoves = \"{}\"\ninvert = "
                                "{}\ndead_zone = {}\ncurve = {}\n",
                                axis.number, name_of(axis.axis), axis.invert, axis.dead_zone,
                                axis.curve);
        for (const ButtonBinding& button : device.buttons)
            text += fmt::format("\n[[device.button]]\nbutton = {}\ndoes = \"{}\"\n", button.number,
                                button.action);
    }
    return text;
}

void save_controls(const ControlMap& map, const fs::path& file) {
    std::error_code failed;
    fs::create_directories(file.parent_path(), failed);
    if (failed)
        throw base::Error(
            base::ExitCode::kIo,
            fmt::format("{}: cannot write: found {}, expected a folder that can be made",
                        base::printable(file.native(), 1024), failed.message()));
    base::write_file_atomic(file, format_controls(map));
}

fs::path controls_file() {
    const auto from = [](const char* name) {
        const char* const value = std::getenv(name);
        const fs::path path = value == nullptr ? "" : value;
        return path.is_absolute() ? path : fs::path(); // as the XDG rules have it
    };
    fs::path folder = from("XDG_CONFIG_HOME");
    if (folder.empty() && !from("HOME").empty())
        folder = from("HOME") / ".config";
    return folder.empty() ? fs::path() : folder / "sward" / "controls.toml";
}

} // namespace sward::input
