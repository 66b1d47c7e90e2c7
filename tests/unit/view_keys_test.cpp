// SPDX-License-Identifier: Apache-2.0
// What the viewer's keys, clock, line and lists do, without a window.
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "app/cockpit_line.h"
#include "app/devices.h"
#include "app/frame_times.h"
#include "app/keys.h"
#include "app/parse.h"
#include "app/recent_scenes.h"
#include "app/sim_clock.h"
#include "app/view_scene.h"
#include "app/weather.h"
#include "base/error.h"
#include "base/file.h"

namespace {

using namespace sward::app;
namespace input = sward::input;
namespace key = sward::app::key;

KeyEvent down(int code, double time_s, bool ctrl = false, bool repeat = false) {
    return {code, true, repeat, ctrl, time_s};
}
KeyEvent up(int code, double time_s) {
    return {code, false, false, false, time_s};
}

std::vector<Action> actions(const KeyLog& log) {
    std::vector<Action> all;
    for (const Press& press : log.presses())
        all.push_back(press.action);
    return all;
}

TEST(Keys, EveryPressBetweenTwoSlowPicturesIsKept) {
    KeyLog log;
    for (const int code : std::initializer_list<int>{'T', 'T', 'H', key::kSpace, 'P'}) {
        log.take(down(code, 1));
        log.take(up(code, 1));
    }
    EXPECT_EQ(actions(log), (std::vector{Action::kPanel, Action::kPanel, Action::kHelp,
                                         Action::kPause, Action::kPause}));
    log.clear(2);
    EXPECT_TRUE(log.presses().empty());
}

TEST(Keys, CtrlAndRepeatsAreToldApart) {
    KeyLog log;
    log.take(down('S', 0));
    EXPECT_TRUE(log.presses().empty());
    log.take(down('S', 0, true));
    log.take(down('Z', 0, true, true));  // undo goes on while held
    log.take(down('T', 0, false, true)); // a toggle does not
    log.take(down('T', 0, true));        // nor is it Ctrl+T
    EXPECT_EQ(actions(log), (std::vector{Action::kSave, Action::kUndo}));
}

TEST(Keys, CamerasHaveNumbers) {
    KeyLog log;
    log.take(down('1', 0));
    log.take(down('9', 0));
    log.take(down('0', 0));
    ASSERT_EQ(log.presses().size(), 2u);
    EXPECT_EQ(log.presses()[0].number, 0);
    EXPECT_EQ(log.presses()[1].number, 8);
}

TEST(Keys, NoTwoBindingsShareAKey) {
    std::set<std::pair<int, bool>> seen;
    std::set<std::string_view> names;
    for (const KeyBinding& binding : key_bindings()) {
        EXPECT_TRUE(names.insert(binding.name).second) << binding.name;
        EXPECT_FALSE(binding.help.empty());
        for (int i = 0; i < binding.count; ++i)
            EXPECT_TRUE(seen.insert({binding.key + i, binding.ctrl}).second) << binding.name;
        if (binding.also != 0) {
            EXPECT_TRUE(seen.insert({binding.also, binding.ctrl}).second) << binding.name;
        }
    }
    for (const char motion : std::string("WASDQE"))
        EXPECT_FALSE(seen.contains({motion, false})) << motion;
}

/// docs/simulator.md has one table of keys: each binding a row, in this order, and no other row.
TEST(Keys, ThePageOfThePilotsHasThem) {
    const std::string page =
        sward::base::read_text(std::string(SWARD_SOURCE_DIR) + "/docs/simulator.md", 1u << 20);
    const std::string head = "| key |  |\n| -- | -- |\n";
    const std::size_t begin = page.find(head);
    ASSERT_NE(begin, std::string::npos);
    const std::size_t end = page.find("\n\n", begin);
    std::string wanted;
    for (const KeyBinding& binding : key_bindings())
        wanted += "| `" + std::string(binding.name) + "` | " + std::string(binding.help) + " |\n";
    EXPECT_EQ(page.substr(begin + head.size(), end + 1 - begin - head.size()), wanted);
}

TEST(Keys, HeldIsTheShareOfThePicture) {
    KeyLog log;
    log.clear(0);
    log.take(down('W', 0.10));
    log.take(up('W', 0.15));
    EXPECT_NEAR(log.held('W', 0.2), 0.25, 1e-12);
    EXPECT_NEAR(log.motion(0.2).z, 0.25, 1e-12);
    log.take(down('A', 0.1));
    EXPECT_NEAR(log.motion(0.2).x, -0.5, 1e-12);
    log.clear(0.2); // A stays down
    EXPECT_NEAR(log.held('A', 0.25), 1, 1e-12);
    EXPECT_EQ(log.held('W', 0.25), 0);
}

TEST(Keys, ATapMovesEvenIfBothItsEndsComeAtOnce) {
    KeyLog log;
    log.clear(0);
    log.take(down('D', 3));
    log.take(up('D', 3));
    EXPECT_NEAR(log.held('D', 3), KeyLog::kTap_s / KeyLog::kLongest_s, 1e-12);
    log.clear(3);
    EXPECT_EQ(log.held('D', 4), 0);
}

TEST(Keys, CtrlMovesNothingAndALostWindowHoldsNothing) {
    KeyLog log;
    log.clear(0);
    log.take(down('W', 0));
    log.take(down(key::kLeftControl, 0));
    EXPECT_EQ(log.motion(1), glm::dvec3(0));
    log.take(up(key::kLeftControl, 0.5));
    log.clear(1);
    EXPECT_EQ(log.motion(2).z, 1);
    log.release_all();
    EXPECT_EQ(log.motion(3), glm::dvec3(0));
}

TEST(SimClock, GoesByTheClockAndNeverLeaps) {
    SimClock clock(10, 1.0 / 60, {});
    EXPECT_DOUBLE_EQ(clock.tick(0.1).dt_s, 0.1);
    EXPECT_DOUBLE_EQ(clock.time_s(), 10.1);
    EXPECT_DOUBLE_EQ(clock.tick(50).dt_s, SimClock::kLongest_s);
    EXPECT_EQ(clock.tick(-1).dt_s, 0);
    EXPECT_EQ(clock.tick(std::nan("")).dt_s, 0);
}

TEST(SimClock, PauseHoldsTimeAndNotTheCamera) {
    SimClock clock(0, 0.5, {});
    clock.toggle_pause();
    const SimClock::Tick tick = clock.tick(0.1);
    EXPECT_EQ(tick.dt_s, 0);
    EXPECT_DOUBLE_EQ(tick.real_s, 0.1);
    clock.single_step();
    clock.single_step();
    EXPECT_DOUBLE_EQ(clock.tick(0.1).dt_s, 1);
    EXPECT_EQ(clock.tick(0.1).dt_s, 0);
    clock.toggle_pause();
    EXPECT_DOUBLE_EQ(clock.tick(0.1).dt_s, 0.1);
    clock.single_step(); // from a run: stands, after one step
    EXPECT_DOUBLE_EQ(clock.tick(0.1).dt_s, 0.5);
    EXPECT_TRUE(clock.paused());
}

TEST(SimClock, SlowMotionHasEnds) {
    SimClock clock(0, 1.0 / 60, 0.1);
    for (int i = 0; i < 20; ++i)
        clock.slower();
    EXPECT_DOUBLE_EQ(clock.rate(), 1.0 / 16);
    EXPECT_DOUBLE_EQ(clock.tick(9).dt_s, 0.1 / 16); // by the fixed step, whatever the clock says
    for (int i = 0; i < 20; ++i)
        clock.faster();
    EXPECT_EQ(clock.rate(), 4);
    clock.real_time();
    EXPECT_DOUBLE_EQ(clock.tick(9).dt_s, 0.1);
}

TEST(FrameTimes, PercentilesAreOfTheLastPictures) {
    FrameTimes times;
    EXPECT_EQ(times.percentile(0.5), 0);
    times.add(7);
    EXPECT_EQ(times.percentile(0), 7);
    EXPECT_EQ(times.percentile(0.99), 7);
    for (std::size_t i = 0; i < FrameTimes::kWindow; ++i)
        times.add(1000); // pushes the 7 out
    EXPECT_EQ(times.percentile(0), 1000);
    for (int i = 1; i <= 100; ++i)
        times.add(i);
    for (std::size_t i = 100; i < FrameTimes::kWindow; ++i)
        times.add(0);
    FrameTimes hundred;
    for (int i = 100; i >= 1; --i)
        hundred.add(i);
    EXPECT_EQ(hundred.percentile(0.5), 50);
    EXPECT_EQ(hundred.percentile(0.99), 99);
    EXPECT_EQ(hundred.percentile(1), 100);
}

TEST(SunDay, TheScenesOwnHourIsItsOwnSun) {
    for (const double latitude : {-60.0, 0.0, 45.0, 70.0, 90.0})
        for (const double azimuth : {0.0, 40.0, 135.0, 180.0, 271.0})
            for (const double elevation : {-30.0, 5.0, 35.0, 80.0}) {
                const SunDay day({azimuth, elevation}, latitude);
                const auto sun = day.at(day.hour());
                EXPECT_NEAR(sun.elevation_deg, elevation, 1e-6);
                EXPECT_NEAR(std::remainder(sun.azimuth_deg - azimuth, 360), 0, 1e-5)
                    << latitude << " " << elevation;
            }
}

TEST(SunDay, RisesInTheEastAndStandsHighestAtNoon) {
    // An equinox in middle latitudes: due east at 6, due south at noon, 90 - latitude high.
    const SunDay day({180, 45}, 45);
    EXPECT_NEAR(day.hour(), 12, 1e-9);
    EXPECT_NEAR(day.at(6).azimuth_deg, 90, 1e-6);
    EXPECT_NEAR(day.at(6).elevation_deg, 0, 1e-6);
    EXPECT_NEAR(day.at(18).azimuth_deg, 270, 1e-6);
    EXPECT_NEAR(day.at(0).elevation_deg, -45, 1e-6);
    // A morning sun is before noon, here and in the south, where it stands in the north at noon.
    EXPECT_LT(SunDay({110, 20}, 45).hour(), 12);
    EXPECT_GT(SunDay({250, 20}, 45).hour(), 12);
    EXPECT_NEAR(SunDay({0, 50}, -40).hour(), 12, 1e-9);
    EXPECT_EQ(hour_text(14.0833), "14:05");
    EXPECT_EQ(hour_text(-0.5), "23:30");
    EXPECT_EQ(hour_text(23.9999), "00:00");
}

TEST(Weather, KeysTurnSunAndWindWithinTheirRanges) {
    sward::scene::Scene scene;
    Weather weather(scene, 45);
    const double hour = weather.hour;
    weather.act(Action::kLater);
    EXPECT_DOUBLE_EQ(weather.hour, hour + 0.25);
    EXPECT_GT(weather.sun().azimuth_deg, scene.sun.azimuth_deg);
    for (int i = 0; i < 96; ++i)
        weather.act(Action::kEarlier);
    EXPECT_NEAR(weather.hour, hour + 0.25, 1e-9); // around the clock
    for (int i = 0; i < 100; ++i)
        weather.act(Action::kLessWind);
    EXPECT_EQ(weather.wind.speed_mps, 0);
    for (int i = 0; i < 100; ++i)
        weather.act(Action::kMoreWind);
    EXPECT_EQ(weather.wind.speed_mps, 60);
    weather.wind.direction_deg = 5;
    weather.act(Action::kWindLeft);
    EXPECT_DOUBLE_EQ(weather.wind.direction_deg, 355);
    weather.act(Action::kWindRight);
    EXPECT_DOUBLE_EQ(weather.wind.direction_deg, 5);
}

TEST(CockpitLine, SaysWhatAPilotAsks) {
    CockpitFacts facts;
    facts.speed_mps = 12.5;
    facts.above_ground_m = 1.72;
    facts.heading_deg = -1;
    facts.p50_ms = 16.66;
    facts.p99_ms = 21.3;
    facts.living = 12'345;
    facts.drawn = 340'000;
    facts.marched = 999'999;
    facts.hour = "09:30";
    facts.time_s = 3.25;
    EXPECT_EQ(cockpit_line(facts), "45 km/h  1.7 m above ground  hdg 359  |  16.7/21.3 ms  |  "
                                   "living 12.3k  drawn 340k  far 1.0M px  |  09:30  t 3.2 s");
    facts.heading_deg = 359.6;
    facts.above_ground_m = std::nan("");
    facts.rate = 0.25;
    facts.note = "set 5 m/s";
    const std::string slow = cockpit_line(facts);
    EXPECT_NE(slow.find("hdg 000"), std::string::npos) << slow;
    EXPECT_NE(slow.find("  - m above"), std::string::npos) << slow;
    EXPECT_NE(slow.find("TIME 1/4  |  set 5 m/s"), std::string::npos) << slow;
    facts.paused = true;
    EXPECT_NE(cockpit_line(facts).find("PAUSED"), std::string::npos);
    EXPECT_EQ(short_count(999), "999");
    EXPECT_EQ(short_count(1000), "1.0k");
    EXPECT_EQ(short_count(99'949), "99.9k");
    EXPECT_EQ(short_count(999'499), "999k");
    EXPECT_EQ(short_count(7'300'000), "7.3M");
}

TEST(WindowPlace, IsReadAsXWritesIt) {
    const WindowPlace plain = parse_window("--window", "800x600");
    EXPECT_EQ(plain.width, 800);
    EXPECT_EQ(plain.height, 600);
    EXPECT_FALSE(plain.at);
    EXPECT_EQ(parse_window("--window", "800x600+10+20").at, glm::ivec2(10, 20));
    EXPECT_EQ(parse_window("--window", "800x600+-1920+0").at, glm::ivec2(-1920, 0));
    for (const char* bad : {"", "800", "800x", "x600", "800x600+", "800x600+1", "800x600+1+2+3",
                            "800x600+a+2", "0x600", "800x600-1-2", "800x600+99999+0", " 800x600"})
        try {
            static_cast<void>(parse_window("--window", bad));
            ADD_FAILURE() << bad;
        } catch (const sward::base::Error& error) {
            EXPECT_EQ(error.code(), sward::base::ExitCode::kUsage) << bad;
            EXPECT_NE(std::string(error.what()).find("--window"), std::string::npos);
        }
}

TEST(Step, IsANumberOrAFraction) {
    constexpr NumberRange kRange{1e-6, 10, "seconds"};
    EXPECT_EQ(parse_step("--fixed-timestep", "0.5", kRange), 0.5);
    EXPECT_EQ(parse_step("--fixed-timestep", "1/144", kRange), 1.0 / 144);
    for (const char* bad :
         {"1/0", "0/1", "/3", "1/", "1/2/3", "a/b", "1/-3", "100/1", "nan/1", "1/1e300"})
        EXPECT_THROW(static_cast<void>(parse_step("--fixed-timestep", bad, kRange)),
                     sward::base::Error)
            << bad;
}

TEST(RecentScenes, NewestFirstEachOnceNineAtMost) {
    std::vector<std::filesystem::path> list;
    for (int i = 0; i < 20; ++i)
        list = with_recent(std::move(list), "/scenes/" + std::to_string(i % 12));
    ASSERT_EQ(list.size(), kMostRecent);
    EXPECT_EQ(list.front(), "/scenes/7");
    list = with_recent(std::move(list), "/scenes/5");
    EXPECT_EQ(list[0], "/scenes/5");
    EXPECT_EQ(std::count(list.begin(), list.end(), "/scenes/5"), 1);
    EXPECT_EQ(parse_recent(format_recent(list)), list);
}

TEST(RecentScenes, AHostileFileGivesNothing) {
    EXPECT_TRUE(parse_recent("relative\n\n\x01/x\n/a\x1b[31m\n").empty());
    EXPECT_EQ(parse_recent("/a\n/a\n/b").size(), 2u);
    EXPECT_EQ(parse_recent(std::string(100, '\n')).size(), 0u);
    EXPECT_TRUE(read_recent("/nonexistent/list").empty());
    EXPECT_EQ(format_recent({"/with\nline", "/good"}), "/good\n");
}

TEST(ViewScene, AnElevationFileIsASceneOfItsOwn) {
    EXPECT_TRUE(is_elevation("/a/b.tif"));
    EXPECT_TRUE(is_elevation("N36W085.HGT"));
    EXPECT_FALSE(is_elevation("/a/scene.toml"));
    EXPECT_FALSE(is_elevation("/a.tif/scene"));
    const std::string name = "we\"ird \\ \x01name.tif";
    const auto scene = sward::scene::parse_scene(elevation_scene("/dir/" + name), "/dir/" + name);
    EXPECT_EQ(scene.terrain.elevation, "/dir/" + name);
    EXPECT_EQ(scene_title(scene), name);
    EXPECT_EQ(
        scene_title(sward::scene::parse_scene(elevation_scene("h.raw"), "/land/hills/scene.toml")),
        "hills");
}

TEST(Devices, MoveAndPressWhatControlsTomlSays) {
    const std::string guid(32, 'a');
    input::ControlReader reader({{{guid,
                                   "",
                                   {{0, input::Axis::kSteer, false, 0, 1},
                                    {1, input::Axis::kMoveForward, true, 0, 1},
                                    {2, input::Axis::kLookUp, false, 0, 1}},
                                   {{0, "pause"}, {1, "camera_3"}, {2, "hand_brake"}}}}});
    const std::vector<float> axes = {0.5f, -1, 0.25f};
    std::vector<unsigned char> buttons = {0, 0, 0};
    reader.read(std::vector{input::DeviceReading{guid, axes, buttons}});
    Input asked;
    asked.move = {0, 0.5, -0.25};
    add_devices(reader, asked);
    EXPECT_EQ(asked.axis(input::Axis::kSteer), 0.5);
    EXPECT_EQ(asked.move, glm::dvec3(0, 0.5, 0.75));
    EXPECT_EQ(asked.look_rate, glm::dvec2(0, 0.25));
    EXPECT_TRUE(asked.presses.empty());
    EXPECT_FALSE(asked.hand_brake);

    buttons = {1, 1, 1};
    reader.read(std::vector{input::DeviceReading{guid, axes, buttons}});
    asked = {};
    add_devices(reader, asked);
    ASSERT_EQ(asked.presses.size(), 2u);
    EXPECT_EQ(asked.presses[0].action, Action::kPause);
    EXPECT_EQ(asked.presses[1].action, Action::kCamera);
    EXPECT_EQ(asked.presses[1].number, 2);
    EXPECT_TRUE(asked.hand_brake);
}

TEST(Devices, EveryNameIsAPressAndStandsInThePage) {
    const std::string page =
        sward::base::read_text(std::string(SWARD_SOURCE_DIR) + "/docs/controls.md", 1u << 20);
    for (const std::string& name : button_actions()) {
        EXPECT_EQ(press_named(name).has_value(), name != "hand_brake") << name;
        EXPECT_NE(page.find('`' + name + '`'), std::string::npos) << name;
    }
    EXPECT_FALSE(press_named("camera_0") || press_named("camera_10") || press_named(""));
}

} // namespace
