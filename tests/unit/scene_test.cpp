// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <locale>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "scene/heightfield.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace sward::scene {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

class TempDir {
public:
    TempDir() {
        std::string name = (fs::temp_directory_path() / "sward_scene_XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~TempDir() { fs::remove_all(path_); }
    fs::path operator/(const fs::path& name) const { return path_ / name; }
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string error_of(const std::function<void()>& act, ExitCode code = ExitCode::kBadInput) {
    try {
        act();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        return error.what();
    }
    return "no error";
}

const std::string kTerrain = "[terrain]\nelevation = \"height.tif\"\n";

class SceneFile : public testing::Test {
protected:
    Scene load(const std::string& text) {
        put(dir_ / "scene.toml", text);
        return load_scene(dir_ / "scene.toml");
    }
    /// The message without the directory.
    std::string error(const std::string& text, ExitCode code = ExitCode::kBadInput) {
        const std::string message = error_of([&] { (void)load(text); }, code);
        const std::string prefix = dir_.path().string() + "/";
        return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
    }
    TempDir dir_;
};

TEST_F(SceneFile, HasDefaults) {
    const Scene scene = load(kTerrain);
    EXPECT_EQ(scene.file, dir_ / "scene.toml");
    EXPECT_EQ(scene.terrain.elevation, dir_ / "height.tif");
    EXPECT_EQ(scene.terrain.detail_m, 0.5);
    EXPECT_FALSE(scene.terrain.size_m);
    EXPECT_TRUE(scene.terrain.mask.empty());
    EXPECT_EQ(scene.grass.set, "meadow.toml");
    EXPECT_EQ(scene.grass.density, 1.0);
    EXPECT_EQ(scene.sun.azimuth_deg, 135);
    EXPECT_EQ(scene.sun.elevation_deg, 35);
    EXPECT_EQ(scene.wind.cells, 1000);
    EXPECT_NEAR(scene.wind.step_s, 1.0 / 60, 1e-9);
    EXPECT_FALSE(scene.lod.far_end_m);
    EXPECT_TRUE(scene.cameras.empty());
}

TEST_F(SceneFile, ReadsEveryKey) {
    const Scene scene = load(R"(
[terrain]
elevation = "dem/height.png"
size_m = [4000, 3000.5]
height_m = [-10, 300]
mask = "mask.png"
detail_m = 0
classes = { 10 = 1.0, 20 = 0.25 }
[grass]
set = "sets/reed"
density = 0.75
[sun]
azimuth_deg = 200.5
elevation_deg = -4
[wind]
speed_mps = 12
direction_deg = 90
gust = 1
seed = 11
cells = 256
cell_m = 0.25
step_s = 0.01
confinement = 0
viscosity_m2s = 0.1
dissipation_per_s = 0.2
[[wind.arrow]]
id = "a"
root = [0, 0]
tip = [5, 0]
strength_mps = 8
radius_m = 6
[[wind.arrow]]
id = "b"
parent = "a"
root = [5, 0]
tip = [9, 4]
strength_mps = 3
[[wind.obstacle]]
box = [1, 2, 3, 4, 45]
[[wind.obstacle]]
circle = [12, -3, 2.5]
[[wind.obstacle]]
mesh = "barn.glb"
place = [-8, 20]
[[object]]
kind = "sphere"
radius_m = 0.75
path = "roll"
[[object]]
kind = "mesh"
mesh = "rock.glb"
position = [1, 2, 3]
yaw_deg = 30
[camera.road]
position = [0, 1.7, 5]
agl = false
yaw_deg = -90
pitch_deg = -5
fov_deg = 45
[path.roll]
fov_deg = 50
agl = false
keys = [ { t = 0, position = [0, 0.5, 10], yaw_deg = 20, pitch_deg = 3 }, { t = 4, position = [0, 0.5, -10] } ]
[lod]
handover_start_m = 5
handover_end_m = 9.5
far_end_m = 400
)");
    EXPECT_EQ(scene.terrain.elevation, dir_ / "dem/height.png");
    EXPECT_EQ(*scene.terrain.size_m, glm::dvec2(4000, 3000.5));
    EXPECT_EQ(*scene.terrain.height_m, glm::dvec2(-10, 300));
    EXPECT_EQ(scene.terrain.classes, (std::map<int, LandClass>{{10, 1.0}, {20, 0.25}}));
    EXPECT_EQ(scene.grass.set, "sets/reed");
    EXPECT_EQ(scene.grass.density, 0.75);
    EXPECT_EQ(scene.sun.elevation_deg, -4);
    EXPECT_EQ(scene.wind.cell_m, 0.25);
    EXPECT_EQ(scene.wind.dissipation_per_s, 0.2);
    ASSERT_EQ(scene.wind.arrows.size(), 2u);
    EXPECT_EQ(scene.wind.arrows[1].parent, "a");
    EXPECT_EQ(scene.wind.arrows[1].tip, glm::dvec2(9, 4));
    EXPECT_EQ(scene.wind.arrows[0].radius_m, 6);
    ASSERT_EQ(scene.wind.obstacles.size(), 3u);
    EXPECT_EQ(scene.wind.obstacles[0].kind, WindObstacle::Kind::kBox);
    EXPECT_EQ(scene.wind.obstacles[0].where.place, glm::dvec2(1, 2));
    EXPECT_EQ(scene.wind.obstacles[0].size, glm::dvec2(3, 4));
    EXPECT_EQ(scene.wind.obstacles[0].where.yaw_deg, 45);
    EXPECT_EQ(scene.wind.obstacles[2].mesh, dir_ / "barn.glb");
    ASSERT_EQ(scene.objects.size(), 2u);
    EXPECT_EQ(scene.objects[0].path, "roll");
    EXPECT_EQ(scene.objects[1].position, glm::dvec3(1, 2, 3));
    const Pose& road = scene.cameras.at("road");
    EXPECT_EQ(road.position, glm::dvec3(0, 1.7, 5));
    EXPECT_FALSE(road.agl);
    EXPECT_EQ(road.fov_deg, 45);
    const Path& roll = scene.paths.at("roll");
    ASSERT_EQ(roll.keys.size(), 2u);
    EXPECT_FALSE(roll.agl);
    EXPECT_EQ(roll.keys[1].yaw_deg, 20)
        << "a key that says nothing keeps the yaw of the key before";
    EXPECT_EQ(*scene.lod.handover_end_m, 9.5);
}

TEST_F(SceneFile, UnknownKeysNameTheNearest) {
    EXPECT_EQ(error(kTerrain + "detial_m = 1\n"),
              "scene.toml:3: unknown key: found terrain.detial_m, expected terrain.detail_m");
    EXPECT_EQ(error(kTerrain + "[wnid]\nspeed_mps = 1\n"),
              "scene.toml:3: unknown key: found wnid, expected wind");
    EXPECT_EQ(error(kTerrain + "[camera.road]\nposition = [0, 1, 0]\nfov = 60\n"),
              "scene.toml:5: unknown key: found camera.road.fov, expected camera.road.fov_deg");
    EXPECT_EQ(error(kTerrain + "[sun]\nsomething_else = 1\n"),
              "scene.toml:4: unknown key: found sun.something_else, expected one of azimuth_deg, "
              "elevation_deg");
    EXPECT_EQ(error(kTerrain +
                    "[[wind.arrow]]\nid = \"a\"\nroot = [0, 0]\ntop = [1, 0]\nstrength_mps = 1\n"),
              "scene.toml:6: unknown key: found wind.arrow[0].top, expected wind.arrow[0].tip");
}

TEST_F(SceneFile, ValuesAreCheckedForTypeAndRange) {
    const auto in_wind = [&](const std::string& line) {
        return error(kTerrain + "[wind]\n" + line + "\n");
    };
    EXPECT_EQ(in_wind("speed_mps = -1"),
              "scene.toml:4: wind.speed_mps: found -1, expected a number from 0 to 150 m/s");
    EXPECT_EQ(in_wind("speed_mps = nan"),
              "scene.toml:4: wind.speed_mps: found nan, expected a number from 0 to 150 m/s");
    EXPECT_EQ(in_wind("gust = inf"),
              "scene.toml:4: wind.gust: found inf, expected a number from 0 to 1");
    EXPECT_EQ(in_wind("gust = \"strong\""),
              "scene.toml:4: wind.gust: found \"strong\", expected a number from 0 to 1");
    EXPECT_EQ(in_wind("cells = 1e3"),
              "scene.toml:4: wind.cells: found 1000, expected a whole number from 16 to 4096");
    EXPECT_EQ(in_wind("seed = -1"),
              "scene.toml:4: wind.seed: found -1, expected a whole number from 0 to 2147483647");
    EXPECT_EQ(
        in_wind("cell_m = 1979-05-27"),
        "scene.toml:4: wind.cell_m: found a date or time, expected a number from 0.05 to 10 m");
    EXPECT_EQ(in_wind("arrow = 3"),
              "scene.toml:4: wind.arrow: found 3, expected an array of tables");
    EXPECT_EQ(error(kTerrain + "size_m = [4000]\n"),
              "scene.toml:3: terrain.size_m: found an array of 1, expected an array of 2 numbers");
    EXPECT_EQ(error(kTerrain + "size_m = [4000, 0]\n"),
              "scene.toml:3: terrain.size_m[1]: found 0, expected a number from 1 to 1200000 m");
    EXPECT_EQ(error("terrain = 4\n"), "scene.toml:1: terrain: found 4, expected a table");
    EXPECT_EQ(error(kTerrain + "mask = \"\"\n"),
              "scene.toml:3: terrain.mask: found \"\", expected a text of 1 to 4096 bytes");
    EXPECT_EQ(error(kTerrain + "mask = \"a\\u0000b\"\n"),
              "scene.toml:3: terrain.mask: found \"a\\x00b\", expected a text of 1 to 4096 bytes");
    EXPECT_EQ(error(kTerrain + "[camera.a]\nposition = [0, 1, 0]\nagl = 1\n"),
              "scene.toml:5: camera.a.agl: found 1, expected true or false");
    EXPECT_EQ(
        error(kTerrain + "[camera.a]\nposition = [0, 1, 0]\npitch_deg = 90.5\n"),
        "scene.toml:5: camera.a.pitch_deg: found 90.5, expected a number from -90 to 90 degrees");
    EXPECT_EQ(
        error(kTerrain + "[camera.\"a,b\"]\nposition = [0, 1, 0]\n"),
        "scene.toml:3: camera: name: found \"a,b\", expected 1 to 64 letters, digits, '_' or '-'");
    EXPECT_EQ(error(kTerrain + "[grass]\ndensity = 1.5\n"),
              "scene.toml:4: grass.density: found 1.5, expected a number from 0 to 1");
}

TEST_F(SceneFile, SurfacesCarryTheirOwnGrass) {
    const std::string kSurface = "[terrain]\nsurface = \"m.glb\"\n";
    const Scene plain = load(kSurface);
    EXPECT_EQ(plain.terrain.surface.filename(), "m.glb");
    EXPECT_EQ(plain.surface_grass.placement, Placement::kMixed);
    EXPECT_EQ(plain.surface_grass.share_in_tufts(), 0.5);
    const Scene scene = load(
        kSurface +
        "[surface_grass]\ndensity_per_m2 = 250\nplacement = \"tufts\"\nshape = \"triangle-tip\"\n"
        "tip_tau = 0.6\nblade_height_m = [0.1, 0.2]\nroot_colour = [0.1, 0.2, 0.3]\nseed = 9\n");
    EXPECT_EQ(scene.surface_grass.density_per_m2, 250);
    EXPECT_EQ(scene.surface_grass.share_in_tufts(), 1);
    EXPECT_EQ(scene.surface_grass.shape, BladeShape::kTriangleTip);
    EXPECT_EQ(scene.surface_grass.species.length_m, (Span{0.1, 0.2}));
    EXPECT_EQ(scene.surface_grass.species.root, (Colour{0.1, 0.2, 0.3}));
    const auto wrong = [&](const std::string& line) {
        return error(kSurface + "[surface_grass]\n" + line + "\n");
    };
    EXPECT_EQ(wrong("density_per_m2 = 0"), "scene.toml:4: surface_grass.density_per_m2: found 0, "
                                           "expected a number from 0.01 to 1000000 blades per m2");
    EXPECT_EQ(wrong("placement = \"clumps\""), "scene.toml:4: surface_grass.placement: found "
                                               "\"clumps\", expected one of single, tufts, mixed");
    EXPECT_EQ(wrong("shape = \"leaf\""),
              "scene.toml:4: surface_grass.shape: found \"leaf\", expected one of quad, triangle, "
              "quadratic, triangle-tip, dandelion");
    EXPECT_EQ(wrong("blade_height_m = [0.3, 0.1]"),
              "scene.toml:4: surface_grass.blade_height_m: found [0.3, 0.1], expected two "
              "rising numbers, the lesser first");
    EXPECT_EQ(wrong("blade_width_m = [0, 0.1]"), "scene.toml:4: surface_grass.blade_width_m[0]: "
                                                 "found 0, expected a number from 0.0001 to 1 m");
    EXPECT_EQ(wrong("tip_color = [1, 1, 1]"),
              "scene.toml:4: unknown key: found surface_grass.tip_color, expected "
              "surface_grass.tip_colour");
    EXPECT_EQ(wrong("tip_colour = [1, 1, 2]"),
              "scene.toml:4: surface_grass.tip_colour[2]: found 2, expected a number from 0 to 1");
    EXPECT_EQ(wrong("placement = \"single\"\ntuft_share = 0.3"),
              "scene.toml:5: surface_grass.tuft_share: found no mixed placement, expected "
              "placement = \"mixed\" beside it");
    const Scene of_set =
        load(kSurface + "[surface_grass]\nset = \"fur.toml\"\ndensity = 0.7\nslope_deg = 40\n");
    EXPECT_EQ(of_set.surface_grass.set, "fur.toml");
    EXPECT_EQ(of_set.grass.set, "fur.toml"); // what is looked up and baked
    EXPECT_EQ(of_set.grass.density, 0.7);
    EXPECT_EQ(wrong("set = \"fur.toml\"\nstiffness = [0.2, 0.4]"),
              "scene.toml:5: surface_grass.stiffness: found set beside it, which describes the "
              "blades, expected one of the two");
    EXPECT_EQ(wrong("density = 0.5"), "scene.toml:4: surface_grass.density: found no set, expected "
                                      "density_per_m2, or a set beside it");
    EXPECT_EQ(
        error(kTerrain + "[surface_grass]\nseed = 1\n"),
        "scene.toml:3: surface_grass: found terrain.elevation, expected terrain.surface beside it");
}

TEST_F(SceneFile, ObjectsStandOrFollowTheirPath) {
    const Scene scene =
        load(kTerrain +
             "[[object]]\nkind = \"sphere\"\nposition = [1, 2, 3]\nagl = false\nyaw_deg = 30\n"
             "[[object]]\nkind = \"mesh\"\nmesh = \"a.glb\"\npath = \"p\"\nyaw_deg = 10\ncolour = "
             "[0.5, 0, 0]\nmost_spheres = 40\n"
             "[path.p]\nagl = true\nkeys = [{ t = 0, position = [0, 1, 0], yaw_deg = 90 }, { t = "
             "2, position = [4, 1, 0] }]\n");
    const Pose still = object_pose(scene.objects[0], scene.paths, 7),
               moving = object_pose(scene.objects[1], scene.paths, 1);
    EXPECT_EQ(still.position, glm::dvec3(1, 2, 3));
    EXPECT_FALSE(still.agl);
    EXPECT_EQ(still.yaw_deg, 30);
    EXPECT_NEAR(moving.position.x, 2, 1e-9);
    EXPECT_TRUE(moving.agl);
    EXPECT_EQ(moving.yaw_deg, 100);
    EXPECT_EQ(scene.objects[1].most_spheres, 40);
    EXPECT_EQ(error(kTerrain + "[[object]]\nkind = \"sphere\"\npath = \"p\"\nagl = "
                               "true\n[path.p]\nkeys = [{ t = 0, position = [0, 0, 0] }]\n"),
              "scene.toml:6: object[0].agl: found a path beside it, expected agl in the path");
    EXPECT_EQ(
        error(kTerrain + "[[object]]\nkind = \"sphere\"\nposition = [0, 0, 0]\nradius_m = -1\n"),
        "scene.toml:6: object[0].radius_m: found -1, expected a number from 0.01 to 1000 m");
}

TEST_F(SceneFile, KeysDependOnEachOther) {
    EXPECT_EQ(error(""), "scene.toml:1: terrain: found nothing, expected this key");
    EXPECT_EQ(error("[terrain]\n"),
              "scene.toml:1: terrain: found neither, expected either elevation or surface");
    EXPECT_EQ(error(kTerrain + "surface = \"mesh.glb\"\n"),
              "scene.toml:1: terrain: found both, expected either elevation or surface");
    EXPECT_EQ(error(kTerrain + "height_m = [5, 5]\n"),
              "scene.toml:3: terrain.height_m: found [5, 5], expected the lower height first");
    EXPECT_EQ(error(kTerrain + "[terrain.classes]\n10 = 1\n"),
              "scene.toml:3: terrain.classes: found no mask, expected terrain.mask beside it");
    EXPECT_EQ(error(kTerrain + "mask = \"m.png\"\n[terrain.classes]\nforest = 1\n"),
              "scene.toml:5: terrain.classes: key: found \"forest\", expected a whole number from "
              "0 to 65535");
    EXPECT_EQ(error(kTerrain + "[camera.road]\nyaw_deg = 3\n"),
              "scene.toml:3: camera.road.position: found nothing, expected this key");
    EXPECT_EQ(error(kTerrain + "[path.a]\nkeys = []\n"),
              "scene.toml:4: path.a.keys: found none, expected at least one { t, position, "
              "yaw_deg, pitch_deg }");
    EXPECT_EQ(error(kTerrain + "[path.a]\nkeys = [{ t = 1, position = [0, 0, 0] }, { t = 1, "
                               "position = [1, 0, 0] }]\n"),
              "scene.toml:4: path.a.keys[1].t: found 1, expected more than 1, the key before");
    EXPECT_EQ(error(kTerrain + "[lod]\nhandover_start_m = 9\nhandover_end_m = 9\n"),
              "scene.toml:5: lod.handover_end_m: found 9, expected more than handover_start_m, 9");
    EXPECT_EQ(error(kTerrain + "[[wind.obstacle]]\ncircle = [0, 0, 1]\nbox = [0, 0, 1, 1, 0]\n"),
              "scene.toml:3: wind.obstacle[0]: found 2 shapes, expected one of box, circle, mesh");
}

TEST_F(SceneFile, ObjectsNameKindsAndPathsThatExist) {
    const std::string roll = kTerrain + "[path.roll]\nkeys = [{ t = 0, position = [0, 0, 0] }]\n";
    EXPECT_EQ(error(roll + "[[object]]\nkind = \"sphere\"\npath = \"rol\"\n"),
              "scene.toml:7: object[0].path: found \"rol\", expected \"roll\"");
    EXPECT_EQ(
        error(kTerrain + "[[object]]\nkind = \"sphere\"\npath = \"elsewhere\"\n"),
        "scene.toml:5: object[0].path: found \"elsewhere\", expected the NAME of a [path.NAME]");
    EXPECT_EQ(error(kTerrain + "[[object]]\nkind = \"cube\"\nposition = [0, 0, 0]\n"),
              "scene.toml:4: object[0].kind: found \"cube\", expected one of sphere, mesh, "
              "vehicle, rotor");
    EXPECT_EQ(error(kTerrain + "[[object]]\nkind = \"sphere\"\n"),
              "scene.toml:3: object[0]: found neither, expected either position or path");
    EXPECT_EQ(error(kTerrain + "[[object]]\nkind = \"mesh\"\nposition = [0, 0, 0]\n"),
              "scene.toml:3: object[0].mesh: found nothing, expected this key");
}

std::string arrow(const std::string& id, const std::string& parent) {
    return "[[wind.arrow]]\nid = \"" + id + "\"\nparent = \"" + parent +
           "\"\nroot = [0, 0]\ntip = [1, 0]\n" + "strength_mps = 1\n";
}

TEST_F(SceneFile, ArrowParentsExistAndEnd) {
    const auto first = [](const std::string& id) {
        return "[[wind.arrow]]\nid = \"" + id +
               "\"\nroot = [0, 0]\ntip = [1, 0]\nstrength_mps = 1\n";
    };
    EXPECT_EQ(error(kTerrain + arrow("a", "b") + arrow("b", "a")),
              "scene.toml:5: wind.arrow[0].parent: found \"b\", which leads back to itself, "
              "expected arrows that start somewhere");
    EXPECT_NE(error(kTerrain + arrow("a", "a")).find("leads back to itself"), std::string::npos);
    EXPECT_NE(
        error(kTerrain + arrow("x", "a") + arrow("a", "b") + arrow("b", "a")).find("leads back"),
        std::string::npos)
        << "a tail that leads into the circle";
    EXPECT_EQ(error(kTerrain + first("trunk") + arrow("b", "trnk")),
              "scene.toml:10: wind.arrow[1].parent: found \"trnk\", expected \"trunk\"");
    EXPECT_EQ(
        error(kTerrain + first("a") + first("a")),
        "scene.toml:9: wind.arrow[1].id: found \"a\" a second time, expected an id of its own");
    std::string chain = kTerrain + first("n0");
    for (int i = 1; i < 1024; ++i)
        chain += arrow("n" + std::to_string(i), "n" + std::to_string(i - 1));
    EXPECT_EQ(load(chain).wind.arrows.size(), 1024u);
    EXPECT_EQ(error(chain + arrow("last", "n0"), ExitCode::kOverLimit),
              "scene.toml:3: wind.arrow: found 1025 entries, expected at most 1024");
    EXPECT_NE(error(kTerrain +
                    "[[wind.arrow]]\nid = \"a\"\nroot = [1, 0]\ntip = [1, 0]\nstrength_mps = 1\n")
                  .find("wind.arrow[0].tip: found the root's own place"),
              std::string::npos);
}

TEST_F(SceneFile, HostileFilesAreRefused) {
    EXPECT_EQ(error(kTerrain + "elevation = \"b\"\n"),
              "scene.toml:3: not valid TOML: found Error while parsing key-value pair: cannot "
              "redefine existing "
              "string 'elevation', expected TOML 1.0");
    EXPECT_NE(error("x = [1").find("scene.toml:1: not valid TOML"), std::string::npos);
    EXPECT_NE(error(std::string("\0\1\2", 3)).find("not valid TOML"), std::string::npos);
    EXPECT_NE(error("x = \"\xff\xfe\"").find("not valid TOML"), std::string::npos);
    EXPECT_NE(error("x = " + std::string(100000, '[')).find("not valid TOML"), std::string::npos);
    EXPECT_NE(error("x = {").find("not valid TOML"), std::string::npos);
    std::string deep = "a", numbers = "1", quoted = "t = { a = '''\n'''', b";
    for (int i = 0; i < 250000; ++i)
        deep += ".a", numbers += ".1", quoted += ".b";
    EXPECT_EQ(error(deep + " = 1", ExitCode::kOverLimit),
              "scene.toml:1: dots in one line: found 250000, expected at most 32");
    EXPECT_NE(error(numbers + " = 1", ExitCode::kOverLimit).find("dots in one line"),
              std::string::npos);
    EXPECT_NE(error(quoted + " = 1 }", ExitCode::kOverLimit).find("scene.toml:2: dots in one line"),
              std::string::npos);
    EXPECT_EQ(error(std::string((1 << 20) + 1, '#'), ExitCode::kOverLimit),
              "scene.toml: file too large: found 1048577 bytes, expected at most 1048576");
    const std::string message = error("a\x1b[31m = 1");
    EXPECT_EQ(message.find('\x1b'), std::string::npos) << "text of the file is escaped";
}

TEST_F(SceneFile, ManyNumbersInALineAreNoDeepKey) {
    std::string keys = "keys = [";
    for (int i = 0; i < 40; ++i)
        keys += "{ t = " + std::to_string(i) + ".5, position = [0.5, 1.25, -3.75] }, ";
    const std::string dots(200, '.');
    EXPECT_EQ(
        load("# " + dots + "\n" + kTerrain + "[path.a]\n" + keys + "]\n").paths.at("a").keys.size(),
        40u);
}

TEST_F(SceneFile, EveryTruncationIsAnErrorOrAWholeScene) {
    std::string text = kTerrain + "[wind]\nspeed_mps = 4.5\n" + arrow("a", "b") + arrow("b", "a") +
                       "[camera.road]\nposition = [0, 1.7, 0]\n[path.p]\nkeys = [{ t = 0, position "
                       "= [0, 0, 0] }]\n";
    for (std::size_t n = 0; n < text.size(); ++n) {
        put(dir_ / "cut.toml", text.substr(0, n));
        try {
            (void)load_scene(dir_ / "cut.toml");
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), ExitCode::kBadInput) << n;
        }
    }
    for (std::size_t n = 0; n < text.size(); ++n) {
        std::string flipped = text;
        flipped[n] = static_cast<char>(flipped[n] ^ 0x91);
        put(dir_ / "flipped.toml", flipped);
        try {
            (void)load_scene(dir_ / "flipped.toml");
        } catch (const base::Error& error) {
            EXPECT_EQ(error.code(), ExitCode::kBadInput) << n;
        }
    }
}

TEST_F(SceneFile, FilesThatAreNoFiles) {
    ASSERT_EQ(::mkfifo((dir_ / "pipe").c_str(), 0600), 0);
    ::alarm(5);
    EXPECT_NE(
        error_of([&] { (void)load_scene(dir_ / "pipe"); }, ExitCode::kIo).find("found a FIFO"),
        std::string::npos);
    ::alarm(0);
    EXPECT_NE(
        error_of([&] { (void)load_scene(dir_.path()); }, ExitCode::kIo).find("found a directory"),
        std::string::npos);
    EXPECT_NE(
        error_of([&] { (void)load_scene(dir_ / "none.toml"); }, ExitCode::kIo).find("No such file"),
        std::string::npos);
}

TEST(ShippedScenes, Load) {
    const Scene scene = load_scene(fs::path(SWARD_SOURCE_DIR) / "terrains/jacksboro/scene.toml");
    EXPECT_TRUE(fs::exists(scene.terrain.elevation));
    for (const char* name : {"road", "knee", "hill30", "high300", "nadir", "horizon"})
        EXPECT_TRUE(scene.cameras.contains(name)) << name;
}

TEST(Pose, ParsesBothForms) {
    const Pose pose = parse_pose("1.5,2,-3e2,90,-5", "--camera");
    EXPECT_EQ(pose.position, glm::dvec3(1.5, 2, -300));
    EXPECT_EQ(pose.yaw_deg, 90);
    EXPECT_EQ(pose.pitch_deg, -5);
    EXPECT_TRUE(pose.agl);
    EXPECT_EQ(pose.fov_deg, 60);
    EXPECT_FALSE(parse_pose("abs:0,0,0,0,0", "--camera").agl);
}

TEST(Pose, RefusesWhatIsNone) {
    const auto error = [](const std::string& text) {
        return error_of([&] { (void)parse_pose(text, "--camera"); }, ExitCode::kUsage);
    };
    const std::string form =
        ", expected x,y,z,yaw,pitch or abs:x,y,z,yaw,pitch or geo:LAT,LON,HEIGHT,YAW,PITCH";
    EXPECT_EQ(error(""), "--camera: found nothing" + form);
    EXPECT_EQ(error("1,2,3,4"), "--camera: found 1,2,3,4" + form);
    EXPECT_EQ(error("1,2,3,4,5,6"), "--camera: found 1,2,3,4,5,6" + form);
    EXPECT_EQ(error("1,2,,4,5"), "--camera: found 1,2,,4,5" + form);
    EXPECT_EQ(error("1,2,3m,4,5"), "--camera: found 1,2,3m,4,5" + form);
    EXPECT_EQ(error("rel:1,2,3,4,5"), "--camera: found rel:1,2,3,4,5" + form);
    EXPECT_EQ(error("1,2,3,4,5\n"), "--camera: found 1,2,3,4,5\\n" + form);
    EXPECT_EQ(error("nan,2,3,4,5"),
              "--camera: found x = nan, expected a number from -1000000 to 1000000 m");
    EXPECT_EQ(error("1,2,1e400,4,5"),
              "--camera: found z = 1e400, expected a number from -1000000 to 1000000 m");
    EXPECT_EQ(error("1,2,3,4,91"),
              "--camera: found pitch = 91, expected a number from -90 to 90 degrees");
    EXPECT_EQ(error("1,2,3,inf,0"),
              "--camera: found yaw = inf, expected a number from -360 to 360 degrees");
}

TEST(Pose, FormatsWhatItParses) {
    Pose pose;
    pose.position = {-12.3456, 1.7, -0.0001};
    pose.yaw_deg = 725.5;
    pose.pitch_deg = -4.9996;
    EXPECT_EQ(format_pose(pose), "-12.346,1.700,0.000,5.500,-5.000");
    pose.agl = false;
    EXPECT_EQ(format_pose(pose), "abs:-12.346,1.700,0.000,5.500,-5.000");
    const Pose again = parse_pose(format_pose(pose), "--camera");
    EXPECT_NEAR(again.position.x, pose.position.x, 1e-3);
    EXPECT_FALSE(again.agl);
}

/// German writes "1,5". Not every machine has the locale, but localedef makes it where the sources
/// are installed.
bool set_german(const TempDir& dir) {
    if (std::setlocale(LC_ALL, "de_DE.UTF-8"))
        return true;
    const std::string make =
        "localedef -i de_DE -f UTF-8 " + (dir / "de_DE.UTF-8").string() + " >/dev/null 2>&1";
    ::setenv("LOCPATH", dir.path().c_str(), 1);
    return std::system(make.c_str()) == 0 && std::setlocale(LC_ALL, "de_DE.UTF-8");
}

TEST(Locale, GermanChangesNothing) {
    const TempDir dir;
    if (!set_german(dir)) {
        ::unsetenv("LOCPATH");
        GTEST_SKIP() << "no German locale here";
    }
    std::locale::global(std::locale("de_DE.UTF-8"));
    EXPECT_EQ(std::strtod("1,5", nullptr), 1.5) << "the locale is not in force";
    EXPECT_EQ(parse_pose("1.5,2,3,4,5", "--camera").position.x, 1.5);
    EXPECT_THROW((void)parse_pose("1,5,2,3,4,5", "--camera"), base::Error);
    EXPECT_EQ(format_pose(Pose{}), "0.000,1.700,0.000,0.000,0.000");
    put(dir / "scene.toml", kTerrain + "detail_m = 1.25\n");
    EXPECT_EQ(load_scene(dir / "scene.toml").terrain.detail_m, 1.25);
    put(dir / "scene.toml", kTerrain + "detail_m = 1234.5\n");
    EXPECT_NE(
        error_of([&] { (void)load_scene(dir / "scene.toml"); }).find("found 1234.5, expected"),
        std::string::npos);
    write_ppm(dir / "a.ppm", {1234, 1, std::vector<std::uint8_t>(1234 * 3)});
    EXPECT_TRUE(base::read_text(dir / "a.ppm", 1 << 20).starts_with("P6\n1234 1\n255\n"));
    std::locale::global(std::locale::classic());
    ::unsetenv("LOCPATH");
}

TEST(Path, PassesThroughItsKeysAndHoldsTheEnds) {
    Path path;
    path.keys = {{0, {0, 0, 0}, 350, 0}, {1, {1, 0, 0}, 10, 10}, {3, {5, 2, 0}, 190, -10}};
    for (const PathKey& key : path.keys) {
        const Pose pose = sample_path(path, key.t_s);
        EXPECT_LT(glm::length(pose.position - key.position), 1e-12);
        EXPECT_NEAR(std::remainder(pose.yaw_deg - key.yaw_deg, 360), 0, 1e-12);
        EXPECT_NEAR(pose.pitch_deg, key.pitch_deg, 1e-12);
    }
    EXPECT_EQ(sample_path(path, -5).position, path.keys.front().position);
    EXPECT_EQ(sample_path(path, 99).position, path.keys.back().position);
    EXPECT_EQ(sample_path(path, NAN).position, path.keys.front().position);
    EXPECT_NEAR(sample_path(path, 0.5).yaw_deg, 360, 1e-12) << "350 to 10 goes through north";
    EXPECT_EQ(sample_path(Path{}, 1).fov_deg, 60);
}

TEST(Path, IsSmoothAndKeepsAStraightLine) {
    Path line;
    for (const double t : {0.0, 1.0, 4.0, 5.0})
        line.keys.push_back({t, {2 * t, 1, -t}, 0, 0});
    for (double t = 0; t <= 5; t += 0.1)
        EXPECT_LT(glm::length(sample_path(line, t).position - glm::dvec3(2 * t, 1, -t)), 1e-9) << t;

    Path bend;
    bend.keys = {
        {0, {0, 0, 0}, 0, 0}, {1, {1, 0, 0}, 0, 0}, {2, {1, 0, 1}, 0, 0}, {3.5, {0, 0, 1}, 0, 0}};
    constexpr double kStep = 1e-5;
    for (const double t : {1.0, 2.0}) {
        const glm::dvec3 before =
            sample_path(bend, t).position - sample_path(bend, t - kStep).position;
        const glm::dvec3 after =
            sample_path(bend, t + kStep).position - sample_path(bend, t).position;
        EXPECT_LT(glm::length(after - before) / kStep, 1e-3) << "a kink at " << t;
    }
}

TEST(FillVoids, TakesTheNearestHeights) {
    const float v = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> one = {1, 1, 1, 1, v, 1, 1, 1, 9};
    EXPECT_EQ(fill_voids(3, 3, one), 1u);
    EXPECT_FLOAT_EQ(one[4], 2);
    std::vector<float> row = {4, v, v, v, v, v, 8};
    EXPECT_EQ(fill_voids(7, 1, row), 5u);
    EXPECT_EQ(row, (std::vector<float>{4, 4, 4, 6, 8, 8, 8}));
    std::vector<float> none = {v, v, v, v};
    EXPECT_EQ(fill_voids(2, 2, none), 0u);
}

class Hgt : public testing::Test {
protected:
    /// A tile of 1201 posts whose height is `height(column, row)`.
    void write(const std::string& name, const std::function<int(int, int)>& height) {
        std::string bytes;
        for (int j = 0; j < 1201; ++j)
            for (int i = 0; i < 1201; ++i) {
                const int h = height(i, j);
                bytes += static_cast<char>((h >> 8) & 255);
                bytes += static_cast<char>(h & 255);
            }
        put(dir_ / name, bytes);
    }
    TempDir dir_;
};

TEST(PlacesOnEarth, AreReadAndSettled) {
    const Pose pose = parse_pose("geo:49.5,-9.25,12,90,-5", "--camera");
    EXPECT_EQ(*pose.geo, glm::dvec2(49.5, -9.25));
    EXPECT_EQ(pose.position.y, 12);
    EXPECT_TRUE(pose.agl);
    EXPECT_EQ(pose.yaw_deg, 90);
    EXPECT_FALSE(parse_pose("abs:geo:1,2,3,4,5", "--camera").agl);
    for (const char* text : {"geo:1,2,3,4", "geo:91,2,3,4,5", "geo:1,361,3,4,5", "geo:nan,2,3,4,5",
                             "geo:", "GEO:1,2,3,4,5"})
        EXPECT_THROW((void)parse_pose(text, "--camera"), base::Error) << text;
    const std::string head = "[terrain]\nelevation='h'\n";
    Scene scene = parse_scene(
        head +
            "[camera.a]\ngeo=[1,2,3]\n[path.p]\nkeys=[{t=0,geo=[1,2,3]},{t=1,position=[7,8,9]}]\n"
            "[[object]]\nkind='sphere'\ngeo=[3,4,0]\n",
        "s.toml");
    const PlaceOnEarth ten_times = [](double latitude, double longitude) {
        return glm::dvec2(longitude * 10, -latitude * 10);
    };
    settle_places(scene, ten_times);
    EXPECT_EQ(scene.cameras.at("a").position, glm::dvec3(20, 3, -10));
    EXPECT_FALSE(scene.cameras.at("a").geo);
    EXPECT_EQ(scene.paths.at("p").keys[0].position, glm::dvec3(20, 3, -10));
    EXPECT_EQ(scene.paths.at("p").keys[1].position, glm::dvec3(7, 8, 9))
        << "a key does not take the place of the one before";
    EXPECT_EQ(scene.objects[0].position, glm::dvec3(40, 0, -30));
    Pose lost = pose;
    EXPECT_NE(error_of([&] { settle_place(lost, {}, "--camera"); }, ExitCode::kUsage)
                  .find("no place on Earth"),
              std::string::npos);
    lost = parse_pose("geo:80,80,0,0,0", "--camera");
    const PlaceOnEarth far = [](double, double) { return glm::dvec2(5e6, 0); };
    EXPECT_NE(error_of([&] { settle_place(lost, far, "scene"); }).find("5000 km from"),
              std::string::npos);
    EXPECT_THROW((void)parse_scene(head + "[camera.a]\ngeo=[1,2,3]\nposition=[1,2,3]\n", "s.toml"),
                 base::Error);
    EXPECT_THROW((void)parse_scene(head + "[camera.a]\ngeo=[1,2]\n", "s.toml"), base::Error);
    EXPECT_THROW((void)parse_scene(head + "[camera.a]\nyaw_deg=0\n", "s.toml"), base::Error);
}

TEST_F(Hgt, IsPlacedByItsName) {
    write("N36W085.hgt", [](int i, int j) { return i - j; });
    const Heightfield field = read_hgt(dir_ / "N36W085.hgt");
    EXPECT_EQ(field.width, 1201);
    EXPECT_EQ(field.metres[5], 5);
    EXPECT_EQ(field.metres[1201 * 10], -10) << "row 0 is north; signed";
    EXPECT_NEAR(field.origin->latitude_deg, 36.5, 1e-9);
    EXPECT_NEAR(field.origin->longitude_deg, -84.5, 1e-9);
    // One degree at 36.5 N on WGS 84: 110.967 km along the meridian, 89.591 km along the parallel.
    EXPECT_NEAR(field.extent_m().y, 110967, 2);
    EXPECT_NEAR(field.extent_m().x, 89591, 2);
}

TEST_F(Hgt, FillsVoidsAndRefusesNothingButVoids) {
    write("S01E010.hgt",
          [](int i, int j) { return i > 100 && i < 110 && j > 50 && j < 60 ? -32768 : 700; });
    for (const float metres : read_hgt(dir_ / "S01E010.hgt").metres)
        ASSERT_EQ(metres, 700);
    write("n00e000.hgt", [](int, int) { return -32768; });
    EXPECT_NE(error_of([&] {
                  (void)read_hgt(dir_ / "n00e000.hgt");
              }).find("n00e000.hgt: no elevation: found voids (-32768) only, expected heights"),
              std::string::npos);
}

TEST_F(Hgt, RefusesWrongSizesAndNames) {
    put(dir_ / "N36W085.hgt", std::string(1000, 'x'));
    EXPECT_NE(error_of([&] { (void)read_hgt(dir_ / "N36W085.hgt"); })
                  .find("not an .hgt tile: found 1000 bytes, expected 2884802 bytes (1201 x 1201 "
                        "posts), 25934402 (3601 x 3601)"),
              std::string::npos);
    put(dir_ / "N37W085.hgt", "");
    EXPECT_NE(error_of([&] { (void)read_hgt(dir_ / "N37W085.hgt"); }).find("found 0 bytes"),
              std::string::npos);
    for (const char* name :
         {"hill.hgt", "N9xW085.hgt", "X36W085.hgt", "N90E000.hgt", "N36W999.hgt"}) {
        write(name, [](int, int) { return 0; });
        EXPECT_NE(
            error_of([&] { (void)read_hgt(dir_ / name); }).find("expected a name like N36W085.hgt"),
            std::string::npos)
            << name;
    }
}

class RawElevation : public testing::Test {
protected:
    std::string error(const std::string& header, const std::vector<float>& posts,
                      ExitCode code = ExitCode::kBadInput) {
        write(header, posts);
        return error_of([&] { (void)read_raw_elevation(dir_ / "hill.raw"); }, code);
    }
    void write(const std::string& header, const std::vector<float>& posts) {
        put(dir_ / "hill.json", header);
        put(dir_ / "hill.raw",
            std::string(reinterpret_cast<const char*>(posts.data()), posts.size() * 4));
    }
    TempDir dir_;
};

TEST_F(RawElevation, ReadsPostsBesideTheirHeader) {
    write(R"({"width": 3, "height": 2, "spacing_m": [2, 0.5]})", {1, 2, 3, 4, NAN, 6.5f});
    const Heightfield field = read_raw_elevation(dir_ / "hill.raw");
    EXPECT_EQ(field.width, 3);
    EXPECT_EQ(field.height, 2);
    EXPECT_EQ(field.metres, (std::vector<float>{1, 2, 3, 4, 3.3f, 6.5f}));
    EXPECT_EQ(field.extent_m(), glm::dvec2(4, 0.5));
}

TEST_F(RawElevation, RefusesWhatDoesNotFit) {
    const std::string good = R"({"width": 2, "height": 2, "spacing_m": [1, 1]})";
    const auto holds = [](const std::string& message, const char* part) {
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    holds(error(good, {1, 2, 3}),
          "hill.raw: size of the file: found 12 bytes, expected 16 bytes for 2 x 2 posts");
    holds(error(good, {1, 2, 2e5f, 4}),
          "hill.raw: height at column 0, row 1: found 200000 m, expected -100000 to 100000 m");
    holds(error(good, {1, INFINITY, 3, 4}), "height at column 1, row 0: found inf");
    holds(error("{", {}), "hill.json: not valid JSON");
    holds(error("[]", {}), "hill.json: header: found array, expected a JSON object");
    holds(error(std::string(60000, '['), {}), "hill.json: not valid JSON");
    holds(error(R"({"width": 1, "height": 2, "spacing_m": [1, 1]})", {}),
          "width: found 1, expected a whole number");
    holds(error(R"({"width": -2, "height": 2, "spacing_m": [1, 1]})", {}), "width: found -2");
    holds(error(R"({"width": 2.5, "height": 2, "spacing_m": [1, 1]})", {}), "width: found 2.5");
    holds(error(R"({"height": 2, "spacing_m": [1, 1]})", {}), "width: found nothing");
    holds(error(R"({"width": 4294967298, "height": 2, "spacing_m": [1, 1]})", {},
                ExitCode::kOverLimit),
          "width: found 4294967298, expected at most 16384");
    holds(error(R"({"width": 2, "height": 2, "spacing_m": [0, 1]})", {}), "spacing_m[0]: found 0");
    holds(error(R"({"width": 2, "height": 2, "spacing_m": 3})", {}), "spacing_m: found number");
    holds(error(R"({"width": 2, "height": 2, "spacing_m": [1, 1], "witdh": 3})", {}),
          "unknown key: found witdh");
}

TEST(Ppm, WritesTheBytesAndRefusesAMismatch) {
    const TempDir dir;
    write_ppm(dir / "two.ppm", {2, 1, {1, 2, 3, 255, 0, 9}});
    EXPECT_EQ(base::read_text(dir / "two.ppm", 100),
              std::string("P6\n2 1\n255\n\x01\x02\x03\xff\x00\x09", 17));
    EXPECT_THROW(write_ppm(dir / "bad.ppm", {2, 2, {1, 2, 3}}), std::logic_error);
    EXPECT_FALSE(fs::exists(dir / "bad.ppm"));
    EXPECT_NE(error_of(
                  [&] {
                      write_ppm(dir / "missing/a.ppm", {1, 1, {1, 2, 3}});
                  },
                  ExitCode::kIo)
                  .find("expected a directory that exists"),
              std::string::npos);
}

} // namespace
} // namespace sward::scene
