// SPDX-License-Identifier: Apache-2.0
// Landcover: what a scene says of its classes, what a texel of them holds, and areas and lines
// burnt over it.
#include <numeric>

#include "assets/land_features.h"
#include "assets/land_mask.h"
#include "assets_fixture.h"
#include "scene/ground_cover.h"
#include "scene/scene.h"

namespace sward::assets {
namespace {

using namespace tests;
using scene::GroundKind;
using scene::LandClass;

constexpr double kByte = 1 / 255.0;

class Land : public testing::Test {
protected:
    scene::Scene load(const std::string& text) {
        put(dir_ / "scene.toml", "[terrain]\nelevation = \"h.tif\"\nmask = \"m.png\"\n" + text);
        return scene::load_scene(dir_ / "scene.toml");
    }
    std::string error(const std::string& text) {
        const std::string message = error_of([&] { (void)load(text); });
        return message.substr(message.find("scene.toml"));
    }
    TempDir dir_;
};

LandClass look(double density, double height, double dryness, GroundKind ground) {
    LandClass entry(density);
    entry.height = height;
    entry.dryness = dryness;
    entry.ground = ground;
    return entry;
}

scene::Heightfield field(double side_m) {
    return {3, 3, glm::dvec2(side_m / 2), std::vector<float>(9, 100), {}};
}

double at(const scene::DensityMask& mask, glm::dvec2 place, scene::LandByte part) {
    const glm::ivec2 texel(
        glm::floor((place - mask.first_m) / mask.size_m * glm::dvec2(mask.width, mask.height)));
    return mask.land[static_cast<std::size_t>((texel.y * mask.width + texel.x) * scene::kLandBytes +
                                              part)] /
           255.0;
}

TEST_F(Land, AClassIsANumberOrATable) {
    const scene::TerrainSpec terrain =
        load("outside_class = 30\nclasses_mb = 16\n"
             "[terrain.classes]\n10 = 0.8\n30 = { density = 1, height = 0.8, dryness = -0.3 }\n80 "
             "= { ground = \"water\" }\n"
             "[[terrain.line]]\nfile = \"r.geojson\"\nwidth_m = 6\nwhere = \"kind = "
             "'road'\"\nground = \"asphalt\"\n"
             "[[terrain.area]]\nfile = \"p.gpkg\"\nlayer = \"ponds\"\nclass = 80\n")
            .terrain;
    EXPECT_EQ(terrain.classes.at(10), LandClass(0.8));
    EXPECT_EQ(terrain.classes.at(30), look(1, 0.8, -0.3, GroundKind::kSoil));
    EXPECT_EQ(terrain.classes.at(80), look(0, 1, 0, GroundKind::kWater));
    EXPECT_EQ(*terrain.outside, terrain.classes.at(30));
    EXPECT_EQ(terrain.classes_mb, 16);
    ASSERT_EQ(terrain.features.size(), 2u); // areas first
    EXPECT_EQ(terrain.features[0].look, terrain.classes.at(80));
    EXPECT_EQ(terrain.features[0].layer, "ponds");
    EXPECT_EQ(terrain.features[0].width_m, 0);
    EXPECT_EQ(terrain.features[1].file, dir_ / "r.geojson");
    EXPECT_EQ(terrain.features[1].look.ground, GroundKind::kAsphalt);
    EXPECT_EQ(terrain.features[1].width_m, 6);
    EXPECT_TRUE(terrain.has_land());
    EXPECT_FALSE(load("[terrain.classes]\n10 = 0.8\n").terrain.has_land())
        << "densities alone need no landcover";
}

TEST_F(Land, WhatAClassMayNotSay) {
    const std::string classes = "[terrain.classes]\n";
    EXPECT_EQ(error(classes + "30 = { density = 1, height = 3 }\n"),
              "scene.toml:5: terrain.classes.30.height: found 3, expected a number from 0.2 to 2");
    EXPECT_EQ(
        error(classes + "30 = { density = 1, dryness = 1.5 }\n"),
        "scene.toml:5: terrain.classes.30.dryness: found 1.5, expected a number from -1 to 1");
    EXPECT_EQ(error(classes + "30 = { ground = \"lava\" }\n"),
              "scene.toml:5: terrain.classes.30.ground: found \"lava\", expected one of soil, "
              "rock, sand, gravel, asphalt, water");
    EXPECT_EQ(error(classes + "30 = { height = 0.5 }\n"),
              "scene.toml:5: terrain.classes.30.density: found nothing, expected a number from 0 "
              "to 1, or a ground without grass");
    expect_holds(error(classes + "30 = { density = 1, heigth = 0.5 }\n"),
                 "terrain.classes.30.heigth");
    EXPECT_EQ(
        error("outside_class = 4\n" + classes + "30 = 1\n"),
        "scene.toml:4: terrain.outside_class: found 4, expected a class of [terrain.classes]");
    const std::string line = classes + "30 = 1\n[[terrain.line]]\nfile = \"r.geojson\"\n";
    EXPECT_EQ(error(line + "class = 30\n"),
              "scene.toml:6: terrain.line[0].width_m: found nothing, expected this key");
    EXPECT_EQ(
        error(line + "width_m = 2\nclass = 30\ndryness = 1\n"),
        "scene.toml:10: terrain.line[0].dryness: found class beside it, expected one of the two");
}

TEST_F(Land, ATexelHoldsWhatItsClassSays) {
    Channel channel;
    channel.width = channel.height = 40; // 2 m each
    for (int n = 0; n < 1600; ++n)
        channel.values.push_back(n % 40 < 20 ? 1.0f : 2.0f);
    scene::TerrainSpec spec;
    spec.classes = {{1, look(1, 1.5, 0.4, GroundKind::kSoil)},
                    {2, look(0, 1, 0, GroundKind::kAsphalt)}};
    const scene::DensityMask mask = land_mask(&channel, spec, field(80));
    EXPECT_EQ(glm::ivec2(mask.width, mask.height), glm::ivec2(160))
        << "a quarter of a pixel, and half a metre";
    EXPECT_EQ(mask.highest, 1.5);
    EXPECT_TRUE(mask.heights);
    EXPECT_NEAR(at(mask, {-20, 3}, scene::kLandHeight), 1.5 / 2, kByte);
    EXPECT_NEAR(at(mask, {-20, 3}, scene::kLandDryness), 0.7, kByte);
    EXPECT_EQ(at(mask, {-20, 3}, scene::kLandBare), 0);
    EXPECT_EQ(at(mask, {20, 3}, scene::kLandAsphalt), 1);
    EXPECT_EQ(at(mask, {20, 3}, scene::kLandBare), 1);
    EXPECT_EQ(at(mask, {20, 3}, scene::kLandHeight), 0) << "of what stands nowhere";
    // The border wanders about its place and keeps what is on each side.
    int differ = 0;
    double grass = 0;
    for (int row = 0; row < mask.height; ++row) {
        const auto begin = mask.density.begin() + row * mask.width;
        grass += std::accumulate(begin, begin + mask.width, 0.0);
        differ += std::equal(begin, begin + mask.width, mask.density.begin()) ? 0 : 1;
    }
    EXPECT_GT(differ, 100);
    EXPECT_NEAR(grass / double(mask.density.size()), 0.5, 0.01);
    EXPECT_NEAR(mask.class_shares.at(1), 0.5, 0.01);
}

TEST_F(Land, WheelsAndProgramsAskWhatLiesAtAPlace) {
    const auto texel = [](double grass, std::vector<std::pair<scene::LandByte, double>> shares,
                          scene::DensityMask& mask) {
        std::array<std::uint8_t, scene::kLandBytes> land{};
        for (const auto& [byte, share] : shares)
            land[byte] = static_cast<std::uint8_t>(std::lround(255 * share));
        mask.density.push_back(static_cast<float>(grass));
        mask.land.insert(mask.land.end(), land.begin(), land.end());
    };
    using scene::GroundCover;
    scene::DensityMask mask; // four texels of 10 m from x = -20 on
    mask.width = 4;
    mask.height = 1;
    mask.first_m = {-20, -5};
    mask.size_m = {40, 10};
    texel(0.9, {}, mask);
    texel(0.4, {{scene::kLandBare, 0.55}, {scene::kLandAsphalt, 0.55}}, mask);
    texel(0.7, {{scene::kLandBare, 0.2}, {scene::kLandWater, 0.2}}, mask);
    texel(0, {{scene::kLandBare, 1}, {scene::kLandGravel, 0.3}, {scene::kLandWater, 0.1}}, mask);
    mask.outside = {255, 128, 128, 0, 0, 0, 0, 0, 0};
    const glm::vec3 up(0, 1, 0);
    const scene::GroundCoverMap map(field(80), mask);
    const GroundCover grass = map.at({-15, 0}, up), road = map.at({-5, 0}, up),
                      shore = map.at({5, 0}, up), soil = map.at({15, 0}, up);
    EXPECT_NEAR(grass.grass, 0.9, kByte);
    EXPECT_FALSE(grass.bare() || grass.shore);
    EXPECT_TRUE(road.bare());
    EXPECT_EQ(road.ground, GroundKind::kAsphalt);
    EXPECT_FALSE(shore.bare());
    EXPECT_TRUE(shore.shore);
    EXPECT_TRUE(soil.bare());
    EXPECT_EQ(soil.ground, GroundKind::kSoil) << "three fifths of it";
    EXPECT_EQ(map.at({30, 0}, up).grass, 1) << "what goes on outside";
    EXPECT_FALSE(map.at({41, 0}, up).known);
    EXPECT_FALSE(map.at({NAN, 0}, up).known);
    mask.outside.reset();
    mask.bounded = true;
    EXPECT_TRUE(scene::GroundCoverMap(field(80), mask).at({30, 0}, up).bare());
    mask.bounded = false;
    EXPECT_EQ(scene::GroundCoverMap(field(80), mask).at({-30, 0}, up).grass, grass.grass)
        << "its rim goes on";
    const scene::GroundCoverMap none(field(80), {});
    EXPECT_EQ(none.at({0, 0}, up).grass, 1);
    EXPECT_TRUE(none.at({0, 0}, glm::normalize(glm::vec3(2, 1, 0))).bare()) << "too steep";
}

TEST_F(Land, MemoryIsBounded) {
    Channel channel;
    channel.width = channel.height = 600; // 1 m each
    channel.values.assign(360000, 1.0f);
    scene::TerrainSpec spec;
    spec.classes = {{1, look(1, 0.5, 0, GroundKind::kSoil)}};
    spec.classes_mb = 1;
    const scene::DensityMask mask = land_mask(&channel, spec, field(600));
    EXPECT_LE(mask.width * mask.height * 12, 1.01 * (1 << 20));
    EXPECT_NEAR(at(mask, {0, 0}, scene::kLandHeight), 0.25, kByte);
}

std::vector<float> covered(const FeatureRows& rows, int size) {
    std::vector<float> all;
    for (int j = 0; j < size; ++j) {
        std::vector<float> row(static_cast<std::size_t>(size), 0.0f);
        rows.cover(j, row);
        all.insert(all.end(), row.begin(), row.end());
    }
    return all;
}

TEST_F(Land, LinesAndAreasCoverWhatTheyAre) {
    constexpr int kSize = 200; // of half a metre
    const auto area_of = [](const std::vector<float>& shares) {
        return 0.25 * std::accumulate(shares.begin(), shares.end(), 0.0);
    };
    for (const glm::dvec2 way : {glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1),
                                 glm::dvec2(1, 0.1), glm::dvec2(-0.3, 1)}) {
        LandShapes line;
        const glm::dvec2 half = 30.0 * glm::normalize(way);
        line.lines = {{-half, glm::dvec2(0), half}};
        const std::vector<float> shares =
            covered(FeatureRows(line, 4, {-50, -50}, {0.5, 0.5}), kSize);
        EXPECT_NEAR(area_of(shares), 60 * 4 + 3.14159 * 4, 3)
            << way.x << ", " << way.y;            // round ends
        for (double s = -29; s < 29; s += 0.25) { // no gap along it
            const glm::ivec2 texel(glm::floor((glm::normalize(way) * s + 50.0) / 0.5));
            EXPECT_EQ(shares[static_cast<std::size_t>(texel.y * kSize + texel.x)], 1.0f);
        }
    }
    LandShapes ring; // a square with a hole
    const auto square = [](double half) {
        return LandShapes::Ring{
            {-half, -half}, {half, -half}, {half, half}, {-half, half}, {-half, -half}};
    };
    ring.areas = {{square(20.1), square(10)}};
    EXPECT_NEAR(area_of(covered(FeatureRows(ring, 0, {-50, -50}, {0.5, 0.5}), kSize)),
                40.2 * 40.2 - 400, 3);
}

TEST_F(Land, FeaturesComeInTheTerrainsFrame) {
    put(dir_ / "f.geojson", R"({"type":"FeatureCollection","features":[
        {"type":"Feature","properties":{"kind":"road"},
         "geometry":{"type":"LineString","coordinates":[[10,47],[10.001,47]]}},
        {"type":"Feature","properties":{"kind":"track"},
         "geometry":{"type":"LineString","coordinates":[[10,47.001],[10.001,47.001]]}}]})");
    scene::Heightfield ground = field(400);
    ground.origin = scene::Georeference{47, 10, "", {76000, 111000}, "test"};
    scene::LandFeature feature;
    feature.file = dir_ / "f.geojson";
    feature.width_m = 5;
    EXPECT_EQ(read_features(feature, ground).lines.size(), 2u);
    feature.where = "kind = 'track'";
    const LandShapes shapes = read_features(feature, ground);
    ASSERT_EQ(shapes.lines.size(), 1u);
    EXPECT_NEAR(shapes.lines[0][1].x, 76, 1e-6);
    EXPECT_NEAR(shapes.lines[0][1].y, -111, 1e-6) << "south is positive";
    feature.where = "kind = 'canal'";
    expect_holds(error_of([&] { (void)read_features(feature, ground); }),
                 "geometry: found none that \"where\" lets through, expected at least one line");
    feature.where = "no such thing =";
    expect_holds(error_of([&] { (void)read_features(feature, ground); }),
                 "expected a condition on the file's attributes");
    feature.where = "";
    feature.width_m = 0;
    expect_holds(error_of([&] { (void)read_features(feature, ground); }),
                 "expected at least one area");
    feature.layer = "roads";
    expect_holds(error_of([&] { (void)read_features(feature, ground); }),
                 "layer: found no \"roads\"");
    ground.origin.reset();
    expect_holds(error_of([&] { (void)read_features(feature, ground); }),
                 "found no place on Earth");
    put(dir_ / "f.geojson", "{\"type\": \"Feature");
    ground.origin = scene::Georeference{47, 10, "", {76000, 111000}, "test"};
    expect_holds(error_of([&] { (void)read_features(feature, ground); }),
                 "expected GeoJSON or GeoPackage");
}

} // namespace
} // namespace sward::assets
