// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "scene/scene.h"

namespace sward::scene {
namespace {

namespace fs = std::filesystem;

const std::string kHead =
    "[terrain]\nelevation = \"height.tif\"\n"; // two lines before what a test adds
const std::string kRoll =
    "[path.roll]\nkeys = [ { t = 0, position = [0, 3, 0] }, { t = 4, position = [8, 3, 0] } ]\n";

class WindSection : public testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "sward_wind_XXXXXX").string();
        dir_ = ::mkdtemp(name.data());
    }
    void TearDown() override { fs::remove_all(dir_); }
    Scene load(const std::string& text) {
        std::ofstream(dir_ / "s.toml") << kHead << text;
        return load_scene(dir_ / "s.toml");
    }
    /// What the message says after the directory.
    std::string error(const std::string& text) {
        try {
            (void)load(text);
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), base::ExitCode::kBadInput);
            return std::string(error.what()).substr(dir_.string().size() + 1);
        }
        return "no error";
    }
    std::string source(const std::string& keys) { return error("[[wind.source]]\n" + keys); }
    fs::path dir_;
};

TEST_F(WindSection, StepsAndArrowsThatMeanNothingAreRefused) {
    for (const char* step : {"0", "10", "-0.01", "nan", "inf"})
        EXPECT_NE(error(std::string("[wind]\nstep_s = ") + step + "\n").find("wind.step_s: found "),
                  std::string::npos)
            << step;
    const std::string arrow = "[[wind.arrow]]\nid = \"a\"\nroot = [1, 1]\nstrength_mps = 8\ntip = ";
    EXPECT_NE(error(arrow + "[1, 1]\n").find("wind.arrow[0].tip"), std::string::npos);
    EXPECT_EQ(error(arrow + "[1, 2]\n"), "no error");
}

TEST_F(WindSection, ReadsSpansOfArrows) {
    const Scene scene =
        load("[[wind.arrow]]\nid = \"a\"\nroot = [0, 0]\ntip = [1, 0]\nstrength_mps = 3\n"
             "[[wind.arrow]]\nid = \"b\"\nroot = [0, 0]\ntip = [1, 0]\nstrength_mps = 3\n"
             "start_s = 2\nend_s = 5.5\n");
    ASSERT_EQ(scene.wind.arrows.size(), 2u);
    EXPECT_EQ(scene.wind.arrows[0].start_s, 0);
    EXPECT_EQ(scene.wind.arrows[0].end_s, kForever);
    EXPECT_EQ(scene.wind.arrows[1].start_s, 2);
    EXPECT_EQ(scene.wind.arrows[1].end_s, 5.5);
}

TEST_F(WindSection, ReadsEveryKindOfSource) {
    const Scene scene = load(kRoll + R"(
[[wind.source]]
kind = "rotor"
path = "roll"
radius_m = 5
mass_kg = 2200
[[wind.source]]
kind = "rotor"
place = [1, 2]
radius_m = 5
strength_mps = 12
height_m = 3
reach_m = 40
[[wind.source]]
kind = "jet"
place = [3, 4]
yaw_deg = 90
strength_mps = 20
radius_m = 1.5
length_m = 9
[[wind.source]]
kind = "wake"
path = "roll"
radius_m = 1
length_m = 15
[[wind.source]]
kind = "cyclone"
place = [0, 0]
strength_mps = 30
radius_m = 8
inflow = 0.3
clockwise = true
[[wind.source]]
kind = "wave"
place = [0, 0]
yaw_deg = 10
strength_mps = 4
radius_m = 100
wavelength_m = 15
travel_mps = 6
start_s = 1
end_s = 20
[[wind.source]]
kind = "fan"
place = [-4, 0]
strength_mps = 6
radius_m = 2
)");
    const auto& s = scene.wind.sources;
    ASSERT_EQ(s.size(), 7u);
    using Kind = WindSource::Kind;
    const Kind kinds[] = {Kind::kRotor,   Kind::kRotor, Kind::kJet, Kind::kWake,
                          Kind::kCyclone, Kind::kWave,  Kind::kFan};
    for (std::size_t i = 0; i < s.size(); ++i)
        EXPECT_EQ(s[i].kind, kinds[i]) << i;
    EXPECT_EQ(s[0].where.path, "roll");
    EXPECT_EQ(*s[0].mass_kg, 2200);
    EXPECT_FALSE(s[0].height_m);
    EXPECT_EQ(*s[1].height_m, 3);
    EXPECT_EQ(s[1].reach_m, 40);
    EXPECT_EQ(s[2].where.yaw_deg, 90);
    EXPECT_EQ(s[2].length_m, 9);
    EXPECT_FALSE(s[3].strength_mps);
    EXPECT_EQ(s[4].inflow, 0.3);
    EXPECT_TRUE(s[4].clockwise);
    EXPECT_EQ(s[5].wavelength_m, 15);
    EXPECT_EQ(*s[5].travel_mps, 6);
    EXPECT_EQ(s[5].start_s, 1);
    EXPECT_EQ(s[5].end_s, 20);
    EXPECT_EQ(s[6].where.place, glm::dvec2(-4, 0));
}

TEST_F(WindSection, RefusesSourcesThatCannotBe) {
    EXPECT_EQ(source("place = [0, 0]\n"),
              "s.toml:3: wind.source[0].kind: found nothing, expected this key");
    EXPECT_EQ(source("kind = \"roter\"\nplace = [0, 0]\n"),
              "s.toml:4: wind.source[0].kind: found \"roter\", expected \"rotor\"");
    EXPECT_EQ(source("kind = \"tornado-like\"\n"),
              "s.toml:4: wind.source[0].kind: found \"tornado-like\", expected one of "
              "rotor, jet, wake, cyclone, wave, fan");
    EXPECT_EQ(source("kind = \"fan\"\nstrength_mps = 3\nradius_m = 2\n"),
              "s.toml:3: wind.source[0]: found neither, expected either place or path");
    EXPECT_EQ(source("kind = \"fan\"\nplace = [0, 0]\nradius_m = 2\n"),
              "s.toml:3: wind.source[0].strength_mps: found nothing, expected this key");
    EXPECT_EQ(
        source("kind = \"fan\"\nplace = [0, 0]\nstrength_mps = nan\nradius_m = 2\n"),
        "s.toml:6: wind.source[0].strength_mps: found nan, expected a number from 0 to 300 m/s");
    EXPECT_EQ(source("kind = \"fan\"\nplace = [0, 0]\nstrength_mps = 3\nradius_m = 0\n"),
              "s.toml:7: wind.source[0].radius_m: found 0, expected a number from 0.05 to 1000 m");
    EXPECT_EQ(
        source("kind = \"fan\"\nplace = [0, 0]\nstrength_mps = 3\nradius_m = 2\nreach_m = 2\n"),
        "s.toml:8: wind.source[0].reach_m: found 2, expected more than radius_m, 2");
    EXPECT_EQ(source("kind = \"fan\"\npath = \"rol\"\nstrength_mps = 3\nradius_m = 2\n" + kRoll),
              "s.toml:5: wind.source[0].path: found \"rol\", expected \"roll\"");
    EXPECT_EQ(source("kind = \"rotor\"\nplace = [0, 0]\nheight_m = 2\nradius_m = 2\nstrength_mps = "
                     "4\nmass_kg = 500\n"),
              "s.toml:3: wind.source[0]: found both, expected either strength_mps or mass_kg");
    EXPECT_EQ(source("kind = \"rotor\"\nplace = [0, 0]\nradius_m = 2\nstrength_mps = 4\n"),
              "s.toml:3: wind.source[0].height_m: found nothing, expected this key");
    EXPECT_EQ(source("kind = \"wake\"\nplace = [0, 0]\nradius_m = 2\nlength_m = 5\n"),
              "s.toml:3: wind.source[0].strength_mps: found nothing, expected this key");
    EXPECT_EQ(
        source(
            "kind = \"cyclone\"\nplace = [0, 0]\nradius_m = 2\nstrength_mps = 5\ninflow = 1.5\n"),
        "s.toml:8: wind.source[0].inflow: found 1.5, expected a number from 0 to 1");
    EXPECT_NE(
        source("kind = \"fan\"\nplace = [0, 0]\nstrength_mps = 3\nradius_m = 2\nwavelength_m = 3\n")
            .find("s.toml:8: unknown key: found wind.source[0].wavelength_m"),
        std::string::npos)
        << "a key of another kind";
    EXPECT_EQ(source("kind = \"fan\"\nplace = [0, 0]\nstrength_mps = 3\nradius_m = 2\nstart_s = "
                     "4\nend_s = 4\n"),
              "s.toml:9: wind.source[0].end_s: found 4, expected more than start_s, 4");
}

TEST_F(WindSection, ObstaclesMoveByPaths) {
    const Scene scene = load(
        kRoll +
        "[[wind.obstacle]]\nbox = [0, 1, 2, 4, 15]\npath = \"roll\"\n"
        "[[wind.obstacle]]\nmesh = \"barn.glb\"\nplace = [3, 4]\nyaw_deg = 20\nheight_m = 1.2\n"
        "[[wind.obstacle]]\nmesh = \"car.glb\"\npath = \"roll\"\n");
    const auto& all = scene.wind.obstacles;
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].where.path, "roll");
    EXPECT_EQ(all[0].size, glm::dvec2(2, 4));
    EXPECT_EQ(all[1].height_m, 1.2);
    EXPECT_EQ(all[1].where.yaw_deg, 20);
    EXPECT_EQ(all[2].height_m, 0.5);
    const auto obstacle = [&](const std::string& keys) {
        return error("[[wind.obstacle]]\n" + keys);
    };
    EXPECT_EQ(obstacle("circle = [0, 0, 1]\npath = \"no\"\n"),
              "s.toml:5: wind.obstacle[0].path: found \"no\", expected the NAME of a [path.NAME]");
    EXPECT_EQ(obstacle("mesh = \"a.glb\"\n"),
              "s.toml:3: wind.obstacle[0]: found neither, expected place or path");
    EXPECT_NE(obstacle("circle = [0, 0, 1]\nheight_m = 3\n")
                  .find("unknown key: found wind.obstacle[0].height_m"),
              std::string::npos);
    EXPECT_EQ(
        obstacle("circle = [0, 0, 0]\n"),
        "s.toml:4: wind.obstacle[0].circle[2]: found 0, expected a number from 0.01 to 100000 m");
}

TEST_F(WindSection, AnObstacleOverTheWholeWindowIsRefused) {
    const std::string window = "[wind]\ncells = 64\ncell_m = 0.5\n";
    EXPECT_EQ(error(window + "[[wind.obstacle]]\nbox = [0, 0, 40, 32, 0]\n"),
              "s.toml:7: wind.obstacle[0].box: found 40 x 32 m, expected less than covers the "
              "wind's whole window "
              "(wind.cells * wind.cell_m = 32 m a side)");
    EXPECT_NE(error(window + "[[wind.obstacle]]\ncircle = [0, 0, 22.7]\n")
                  .find("a radius of 22.7 m, expected less"),
              std::string::npos);
    EXPECT_EQ(error(window + "[[wind.obstacle]]\ncircle = [0, 0, 22.6]\n"), "no error");
    EXPECT_EQ(error(window + "[[wind.obstacle]]\nbox = [0, 0, 400, 31.9, 0]\n"), "no error")
        << "a wall";
}

} // namespace
} // namespace sward::scene
