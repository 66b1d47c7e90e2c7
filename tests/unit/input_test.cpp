// SPDX-License-Identifier: Apache-2.0
// Joysticks, wheels and pedals: the file, the shape of an axis, buttons over time, what the kernel
// says of a device.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include <unistd.h>

#include <gtest/gtest.h>

#include "base/error.h"
#include "input/control_map.h"
#include "input/controls_file.h"
#include "input/joysticks.h"

namespace sward::input {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWheel = "030000006d0400004fc2000011010000";
constexpr const char* kPedals = "0300000030110000a301000011010000";

const std::string kFile = std::string(R"(
[[device]]
guid = ")") + kWheel + R"("
name = "Wheel \"X\""
[[device.axis]]
axis = 0
moves = "steer"
dead_zone = 0
curve = 1.5
[[device.axis]]
axis = 2
moves = "throttle"
invert = true
[[device.button]]
button = 4
does = "pause"

[[device]]
guid = "0300000030110000A301000011010000"
[[device.axis]]
axis = 1
moves = "brake"
)";

std::string complaint(const std::string& text) {
    try {
        static_cast<void>(parse_controls(text, "controls.toml"));
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ExitCode::kBadInput) << error.what();
        return error.what();
    }
    return "none";
}

TEST(ControlsFile, SaysWhatMovesWhat) {
    const ControlMap map = parse_controls(kFile, "controls.toml");
    ASSERT_EQ(map.devices.size(), 2u);
    const DeviceBinding& wheel = *map.find(kWheel);
    EXPECT_EQ(wheel.name, "Wheel \"X\"");
    ASSERT_EQ(wheel.axes.size(), 2u);
    EXPECT_EQ(wheel.axes[0].axis, Axis::kSteer);
    EXPECT_EQ(wheel.axes[0].dead_zone, 0);
    EXPECT_EQ(wheel.axes[0].curve, 1.5);
    EXPECT_FALSE(wheel.axes[0].invert);
    EXPECT_EQ(wheel.axes[1].number, 2);
    EXPECT_EQ(wheel.axes[1].axis, Axis::kThrottle);
    EXPECT_TRUE(wheel.axes[1].invert);
    EXPECT_EQ(wheel.axes[1].dead_zone, 0.05);
    ASSERT_EQ(wheel.buttons.size(), 1u);
    EXPECT_EQ(wheel.buttons[0].number, 4);
    EXPECT_EQ(wheel.buttons[0].action, "pause");
    ASSERT_NE(map.find(kPedals), nullptr); // in lower case
    EXPECT_EQ(map.find("0300000030110000a301000011010001"), nullptr);
    EXPECT_TRUE(parse_controls("", "controls.toml").devices.empty());
    for (std::size_t i = 0; i < kAxes; ++i)
        EXPECT_EQ(axis_of(name_of(static_cast<Axis>(i))), static_cast<Axis>(i));
    EXPECT_FALSE(axis_of("steering"));
}

TEST(ControlsFile, WhatIsWrittenIsReadBack) {
    const ControlMap map = parse_controls(kFile, "controls.toml");
    const std::string text = format_controls(map);
    const ControlMap again = parse_controls(text, "controls.toml");
    EXPECT_EQ(format_controls(again), text);
    EXPECT_EQ(again.devices[0].name, map.devices[0].name);
    EXPECT_EQ(again.devices[0].axes[0].curve, 1.5);
    EXPECT_EQ(again.devices[0].buttons[0].action, "pause");
    EXPECT_EQ(again.devices[1].axes[0].axis, Axis::kBrake);
    const fs::path folder =
        fs::path(testing::TempDir()) / ("sward-controls-" + std::to_string(getpid()));
    const fs::path file = folder / "deep" / "controls.toml";
    EXPECT_TRUE(load_controls(file).devices.empty()); // none yet
    EXPECT_TRUE(load_controls({}).devices.empty());
    save_controls(map, file);
    EXPECT_EQ(format_controls(load_controls(file)), text);
    fs::remove_all(folder);
    // Whatever a device calls itself.
    ControlMap odd;
    odd.devices.push_back({kWheel, "a\\b\"c\nd\x01", {}, {}});
    EXPECT_EQ(parse_controls(format_controls(odd), "controls.toml").devices[0].name, "a\\b\"c d ");
}

TEST(ControlsFile, MistakesAreToldWithTheirPlace) {
    const std::string device = std::string("[[device]]\nguid = \"") + kWheel + "\"\n";
    const auto tells = [](const std::string& text, const std::string& piece) {
        const std::string said = complaint(text);
        EXPECT_NE(said.find(piece), std::string::npos) << said << "\nwithout " << piece;
        EXPECT_TRUE(said.starts_with("controls.toml")) << said;
    };
    tells("[[device]]\n", "guid");
    tells("[[device]]\nguid = \"0300\"\n", "32 hex digits");
    tells("[[device]]\nguid = \"0300000030110000a30100001101000g\"\n", "32 hex digits");
    tells(device + device, "second time");
    tells(device + "[[device.axis]]\nmoves = \"steer\"\n", "axis");
    tells(device + "[[device.axis]]\naxis = 0\n", "moves");
    tells(device + "[[device.axis]]\naxis = 0\nmoves = \"steerr\"\n", "perhaps \"steer\"");
    tells(device + "[[device.axis]]\naxis = 64\nmoves = \"steer\"\n", "0 to 63");
    tells(device + "[[device.axis]]\naxis = 0.5\nmoves = \"steer\"\n", "axis");
    tells(device + "[[device.axis]]\naxis = 0\nmoves = \"steer\"\ndead_zone = 1\n", "0 to 0.9");
    tells(device + "[[device.axis]]\naxis = 0\nmoves = \"steer\"\ncurve = nan\n", "0.2 to 5");
    tells(device + "[[device.axis]]\naxis = 0\nmoves = \"steer\"\nfactor = 2\n", "factor");
    tells(device + "[[device.button]]\nbutton = -1\ndoes = \"pause\"\n", "button");
    tells(device + "[[device.button]]\nbutton = 1\ndoes = \"so much\"\n", "does");
    tells("devices = 1\n", "devices");
    tells("[[device]\n", "not valid TOML");
    EXPECT_THROW(static_cast<void>(parse_controls(std::string(100, '.') + "a", "controls.toml")),
                 base::Error);
    const std::vector<std::string> known = {"pause", "reset"};
    const ControlMap map = parse_controls(
        device + "[[device.button]]\nbutton = 1\ndoes = \"puase\"\n", "controls.toml");
    try {
        check_actions(map, known, "controls.toml");
        FAIL();
    } catch (const base::Error& error) {
        EXPECT_NE(std::string(error.what()).find("perhaps \"pause\""), std::string::npos)
            << error.what();
    }
    check_actions(parse_controls(kFile, "controls.toml"), known, "controls.toml");
}

TEST(ControlsFile, StandsWhereTheDesktopKeepsSettings) {
    setenv("HOME", "/home/a", 1);
    unsetenv("XDG_CONFIG_HOME");
    EXPECT_EQ(controls_file(), "/home/a/.config/sward/controls.toml");
    setenv("XDG_CONFIG_HOME", "/etc/b", 1);
    EXPECT_EQ(controls_file(), "/etc/b/sward/controls.toml");
    setenv("XDG_CONFIG_HOME", "relative", 1);
    EXPECT_EQ(controls_file(), "/home/a/.config/sward/controls.toml");
    unsetenv("HOME");
    EXPECT_EQ(controls_file(), "");
}

TEST(ControlMap, AnAxisHasADeadZoneACurveAndItsEnds) {
    const AxisBinding steer{0, Axis::kSteer, false, 0.1, 2};
    EXPECT_EQ(shape(steer, 0), 0);
    EXPECT_EQ(shape(steer, 0.1), 0);
    EXPECT_EQ(shape(steer, -0.1), 0);
    EXPECT_NEAR(shape(steer, 0.55), 0.25, 1e-12);
    EXPECT_NEAR(shape(steer, -0.55), -0.25, 1e-12);
    EXPECT_EQ(shape(steer, 1), 1);
    EXPECT_EQ(shape(steer, -1), -1);
    EXPECT_EQ(shape(steer, 7), 1);
    EXPECT_EQ(shape(steer, std::numeric_limits<double>::quiet_NaN()), 0);
    const AxisBinding reversed{0, Axis::kSteer, true, 0, 1};
    EXPECT_EQ(shape(reversed, 0.25), -0.25);
    // A pedal that rests at 1 and goes to -1.
    const AxisBinding pedal{0, Axis::kBrake, true, 0.2, 1};
    EXPECT_EQ(shape(pedal, 1), 0);
    EXPECT_EQ(shape(pedal, 0.6), 0);
    EXPECT_NEAR(shape(pedal, -0.2), 0.5, 1e-12);
    EXPECT_EQ(shape(pedal, -1), 1);
}

TEST(ControlReader, TakesDevicesAsTheyComeAndGo) {
    ControlReader reader(parse_controls(kFile, "controls.toml"));
    const std::vector<float> wheel = {0.5f, 0, 1}, pedals = {0, 1};
    std::vector<unsigned char> up(8, 0), down(8, 0);
    down[4] = 1;
    const DeviceReading other{"00000000000000000000000000000000", wheel, down};
    const DeviceReading both[] = {other, {kWheel, wheel, up}, {kPedals, pedals, {}}};
    reader.read(both);
    EXPECT_NEAR(reader.axis(Axis::kSteer), std::pow(0.5, 1.5), 1e-12);
    EXPECT_EQ(reader.axis(Axis::kThrottle), 0); // inverted: rests at 1
    EXPECT_EQ(reader.axis(Axis::kBrake), 1);
    EXPECT_EQ(reader.axis(Axis::kRoll), 0);
    EXPECT_TRUE(reader.pressed().empty());
    const DeviceReading pressed[] = {{kWheel, wheel, down}};
    reader.read(pressed);
    EXPECT_EQ(reader.pressed(), std::vector<std::string>{"pause"});
    EXPECT_TRUE(reader.held("pause"));
    EXPECT_EQ(reader.axis(Axis::kBrake), 0); // unplugged
    reader.read(pressed);
    EXPECT_TRUE(reader.pressed().empty());
    EXPECT_TRUE(reader.held("pause"));
    reader.read({});
    EXPECT_FALSE(reader.held("pause"));
    EXPECT_EQ(reader.axis(Axis::kSteer), 0);
    reader.read(pressed); // plugged in with a finger on it
    EXPECT_TRUE(reader.pressed().empty());
    // Two of a kind: each has its own buttons, and the axis that is farther out counts.
    const std::vector<float> left = {-0.9f};
    const DeviceReading twins[] = {{kWheel, wheel, up}, {kWheel, left, up}},
                        one[] = {{kWheel, wheel, up}, {kWheel, left, down}};
    reader.read(twins);
    EXPECT_LT(reader.axis(Axis::kSteer), -0.8);
    reader.read(one);
    EXPECT_EQ(reader.pressed().size(), 1u);
}

template<std::size_t N>
void set(std::array<std::uint8_t, N>& bits, std::initializer_list<int> codes) {
    for (const int code : codes)
        bits[static_cast<std::size_t>(code) / 8] =
            static_cast<std::uint8_t>(bits[static_cast<std::size_t>(code) / 8] | 1 << (code % 8));
}

TEST(Joysticks, AreNamedAndCountedAsSdlAndGlfwDo) {
    DeviceFacts facts;
    facts.id = {0x03, 0x046d, 0xc24f, 0x0111};
    facts.name = "G29";
    set(facts.events, {EV_KEY, EV_ABS});
    set(facts.keys, {BTN_TRIGGER, BTN_THUMB, BTN_DEAD});
    set(facts.axes, {ABS_X, ABS_Z, ABS_RZ, ABS_HAT0X, ABS_HAT0Y});
    const std::optional<Joystick> wheel = joystick_of(facts);
    ASSERT_TRUE(wheel);
    EXPECT_EQ(wheel->guid, kWheel);
    EXPECT_EQ(wheel->axes, 3);
    EXPECT_EQ(wheel->buttons, 3);
    EXPECT_EQ(wheel->hats, 1);
    EXPECT_EQ(guid_of({0x05, 0, 0, 0}, "Fly Stick Pro Max"), "05000000466c7920537469636b205000");
    EXPECT_EQ(guid_of({0x05, 0, 0, 0}, "Fly"), "05000000466c79000000000000000000");
    // A touch pad and a keyboard have what a joystick has, and more.
    DeviceFacts pad = facts;
    set(pad.keys, {BTN_TOUCH});
    EXPECT_FALSE(joystick_of(pad));
    DeviceFacts keyboard;
    set(keyboard.events, {EV_KEY, EV_ABS});
    set(keyboard.keys, {KEY_A});
    set(keyboard.axes, {ABS_VOLUME});
    EXPECT_FALSE(joystick_of(keyboard));
    DeviceFacts silent = facts;
    silent.events = {};
    EXPECT_FALSE(joystick_of(silent));
    int unreadable = -1;
    EXPECT_TRUE(list_joysticks(unreadable, "/nonexistent").empty());
    EXPECT_EQ(unreadable, 0);
    static_cast<void>(list_joysticks(unreadable)); // whatever is plugged in here
    EXPECT_GE(unreadable, 0);
}

} // namespace
} // namespace sward::input
