// SPDX-License-Identifier: Apache-2.0
// Where elevation and masks lie on Earth: whatever their CRS, extent, spacing or rotation, one
// belongs over the other.
#include <array>

#include "assets_fixture.h"

namespace sward::assets {
namespace {

using namespace tests;

std::vector<std::uint16_t> projected(std::uint16_t epsg) {
    return {1, 1, 0, 3, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, epsg};
}

class Places : public testing::Test {
protected:
    Heightfield elevation(const Tiff& tiff) {
        put(dir_ / "height.tif", tiff.bytes());
        spec_.elevation = dir_ / "height.tif";
        return load_elevation(spec_);
    }
    scene::DensityMask mask(const Tiff& tiff, const Heightfield& ground,
                            const std::map<int, double>& classes = {}) {
        put(dir_ / "mask.tif", tiff.bytes());
        spec_.mask = dir_ / "mask.tif";
        spec_.classes = {classes.begin(), classes.end()};
        return load_mask(spec_, ground);
    }
    TempDir dir_;
    TerrainSpec spec_;
};

/// A flat DEM of 81 x 61 posts.
Tiff flat(const std::vector<std::uint16_t>& keys, const std::vector<double>& matrix) {
    Tiff tiff = raster<float>(81, 61, [](double, double) { return 50; });
    tiff.geokeys = keys;
    tiff.matrix = matrix;
    return tiff;
}

/// Latitude and longitude of a place of the terrain, by Newton steps on the way back.
glm::dvec2 on_earth(const scene::Georeference& frame, glm::dvec2 place) {
    glm::dvec2 geo(frame.latitude_deg, frame.longitude_deg);
    for (int step = 0; step < 8; ++step) {
        constexpr double kE = 1e-4;
        const glm::dvec2 at = local_place(frame, geo.x, geo.y);
        const glm::dvec2 da = (local_place(frame, geo.x + (geo.x > 0 ? -kE : kE), geo.y) - at) /
                              (geo.x > 0 ? -kE : kE);
        const glm::dvec2 db = (local_place(frame, geo.x, geo.y + kE) - at) / kE;
        const double det = da.x * db.y - da.y * db.x;
        const glm::dvec2 off = place - at;
        geo += glm::dvec2(off.x * db.y - off.y * db.x, da.x * off.y - da.y * off.x) / det;
    }
    return geo;
}

/// Middle of what stands within `reach` of a place, x and z.
glm::dvec2 middle_of(const scene::DensityMask& mask, const Heightfield& ground, glm::dvec2 place,
                     double reach) {
    const glm::dvec2 size = mask.size_m.x > 0 ? mask.size_m : ground.extent_m();
    const glm::dvec2 first = mask.size_m.x > 0 ? mask.first_m : -0.5 * ground.extent_m();
    glm::dvec2 sum(0);
    double weight = 0;
    for (int j = 0; j < mask.height; ++j)
        for (int i = 0; i < mask.width; ++i) {
            const glm::dvec2 at =
                first + (glm::dvec2(i, j) + 0.5) * size / glm::dvec2(mask.width, mask.height);
            const double density =
                mask.density[static_cast<std::size_t>(j) * static_cast<std::size_t>(mask.width) +
                             static_cast<std::size_t>(i)];
            if (glm::length(at - place) < reach)
                sum += density * at, weight += density;
        }
    return weight > 0 ? sum / weight : glm::dvec2(NAN);
}

struct Ground {
    const char* name;
    Tiff dem;
    double turn_deg = 0; ///< added to the mask's longitudes
    double pixel = 2e-4; ///< of the mask, degrees of latitude
};

std::vector<Ground> grounds() {
    const double c = 30 * std::cos(0.4), s = 30 * std::sin(0.4);
    return {{"UTM at the zone's edge", flat(kUtm32, affine(30, 0, 735000, 0, -30, 5500000))},
            {"geographic", flat(kWgs84, affine(5e-4, 0, 10, 0, -3e-4, 49.5))},
            {"turned", flat(kUtm32, affine(c, s, 500000, s, -c, 4100000))},
            {"polar", flat(projected(3413), affine(30, 0, 250000, 0, -30, -380000))},
            {"the south", flat(projected(3031), affine(30, 0, -900000, 0, -30, 700000))},
            {"across 180 degrees", flat(kWgs84, affine(5e-4, 0, 179.98, 0, -5e-4, -16))},
            {"across 180 degrees, the mask on the other side",
             flat(kWgs84, affine(5e-4, 0, 179.98, 0, -5e-4, -16)), -360},
            {"0 to 360 degrees", flat(kWgs84, affine(5e-4, 0, 286, 0, -5e-4, 40))},
            {"Mercator past its end",
             flat(projected(3857), affine(40, 0, 20036500, 0, -40, -1700000))}};
}

TEST_F(Places, ClassesInAnotherCrsLieWhereTheyBelong) {
    for (Ground& ground : grounds()) {
        SCOPED_TRACE(ground.name);
        const Heightfield field = elevation(ground.dem);
        ASSERT_TRUE(field.origin);
        const double post = std::min(field.spacing_m.x, field.spacing_m.y);
        std::vector<glm::dvec2> places, marks;
        for (const glm::dvec2 share :
             {glm::dvec2(0), glm::dvec2(-0.42, -0.42), glm::dvec2(0.42, -0.42),
              glm::dvec2(-0.42, 0.42), glm::dvec2(0.42)}) {
            places.push_back(share * field.extent_m());
            marks.push_back(on_earth(*field.origin, places.back()));
            ASSERT_LT(glm::length(local_place(*field.origin, marks.back().x, marks.back().y) -
                                  places.back()),
                      0.01);
        }
        // A geographic raster with a box about each mark, wider than the terrain.
        const double per_degree = 111000, stretch = 1 / std::cos(marks[0].x * M_PI / 180);
        const double pixel = 0.5 * post / per_degree;
        const auto columns = static_cast<std::uint32_t>(1.5 * glm::length(field.extent_m()) /
                                                        per_degree / pixel),
                   rows = columns;
        const double west = marks[0].y - 0.5 * columns * pixel * stretch,
                     north = marks[0].x + 0.5 * rows * pixel;
        Tiff classes = raster<std::int16_t>(columns, rows, [&](double i, double j) {
            const glm::dvec2 at(north - (j + 0.5) * pixel, west + (i + 0.5) * pixel * stretch);
            for (const glm::dvec2& mark : marks)
                if (std::abs(at.x - mark.x) < 5 * pixel &&
                    std::abs(std::remainder(at.y - mark.y, 360)) < 5 * pixel * stretch)
                    return 30.0;
            return 7.0;
        });
        classes.geokeys = kWgs84;
        classes.matrix = affine(pixel * stretch, 0, west + ground.turn_deg, 0, -pixel, north);
        const scene::DensityMask density = mask(classes, field, {{30, 1.0}});
        for (const glm::dvec2& place : places)
            EXPECT_LT(glm::length(middle_of(density, field, place, 8 * post) - place), 0.5 * post)
                << place.x << ", " << place.y;
        EXPECT_FALSE(density.bounded);
        EXPECT_NEAR(density.class_shares.at(7) + density.class_shares.at(30), 1, 1e-6);
    }
}

TEST_F(Places, AMaskOnTheGridOfItsDemStaysOnIt) {
    const Tiff dem = flat(kUtm32, affine(30, 0, 735000, 0, -30, 5500000));
    const Heightfield field = elevation(dem);
    Tiff bare = raster<std::uint8_t>(
        81, 61, [](double i, double j) { return i == 60 && j == 12 ? 255 : 0; });
    bare.geokeys = dem.geokeys;
    bare.matrix = dem.matrix;
    const scene::DensityMask density = mask(bare, field);
    // The pixel's middle by the CRS itself: UTM's grid is turned against the frame by the
    // meridian's convergence.
    Tiff peak =
        raster<float>(81, 61, [](double i, double j) { return i == 60 && j == 12 ? 100 : 0; });
    peak.geokeys = dem.geokeys;
    peak.matrix = dem.matrix;
    const Heightfield marked = elevation(peak);
    glm::dvec2 sum(0);
    double weight = 0;
    for (int j = 0; j < marked.height; ++j)
        for (int i = 0; i < marked.width; ++i) {
            const double h = std::max(
                0.0f,
                marked.metres[static_cast<std::size_t>(j) * static_cast<std::size_t>(marked.width) +
                              static_cast<std::size_t>(i)]);
            sum += h * (glm::dvec2(i, j) - glm::dvec2(marked.width - 1, marked.height - 1) / 2.0) *
                   marked.spacing_m;
            weight += h;
        }
    const glm::dvec2 place = sum / weight;
    EXPECT_LT(glm::length(middle_of(density, field, place, 200) - place), 6);
}

TEST_F(Places, MasksAboutAPole) {
    // Meridians as a mask: pixels of every width down to none, and half of the terrain on either
    // side of one.
    const Heightfield field =
        elevation(flat(projected(3413), affine(1000, 0, -40000, 0, -1000, 31000)));
    for (const double west : {-180.0, 0.0}) {
        Tiff halves =
            raster<std::int16_t>(360, 200, [](double i, double) { return i < 180 ? 30 : 7; });
        halves.geokeys = kWgs84;
        halves.matrix = affine(1, 0, west, 0, -0.01, 90);
        const scene::DensityMask density = mask(halves, field, {{30, 1.0}});
        EXPECT_FALSE(density.bounded);
        EXPECT_LT(density.density.size(), std::size_t{1} << 22)
            << "not as fine as its finest pixel";
        EXPECT_NEAR(density.class_shares.at(30), 0.5, 0.03) << west;
        EXPECT_NEAR(density.class_shares.at(7), 1 - density.class_shares.at(30), 1e-6) << west;
    }
}

TEST_F(Places, ARoadKeepsItsShareOfAWiderTexel) {
    // 8 m of road in a mask of 1 m, on posts of 90 m.
    Tiff dem = raster<float>(41, 41, [](double, double) { return 50; });
    dem.geokeys = kUtm32;
    dem.matrix = affine(90, 0, 500000, 0, -90, 5500000);
    const Heightfield field = elevation(dem);
    Tiff road = raster<std::uint8_t>(
        1200, 1200, [](double i, double) { return i >= 600 && i < 608 ? 0 : 255; });
    road.geokeys = kUtm32;
    road.matrix = affine(1, 0, 501000, 0, -1, 5499000);
    const scene::DensityMask density = mask(road, field);
    EXPECT_TRUE(density.bounded) << "it covers a part of the terrain";
    EXPECT_NEAR(density.size_m.x, 1200, 30);
    const double texel = density.size_m.x / density.width;
    EXPECT_NEAR(texel, 1, 0.05) << "as fine as the mask, not as its posts";
    for (const int j : {density.height / 8, density.height / 2, density.height * 7 / 8}) {
        double missing = 0;
        float least = 1;
        for (int i = density.width / 4; i < density.width * 3 / 4; ++i) {
            const float value =
                density
                    .density[static_cast<std::size_t>(j) * static_cast<std::size_t>(density.width) +
                             static_cast<std::size_t>(i)];
            missing += (1 - value) * texel;
            least = std::min(least, value);
        }
        EXPECT_NEAR(missing, 8, 0.3);
        EXPECT_EQ(least, 0);
    }
}

TEST_F(Places, AMaskThatIsElsewhereIsToldApart) {
    const Heightfield field = elevation(flat(kUtm32, affine(30, 0, 500000, 0, -30, 5500000)));
    Tiff away = raster<std::uint8_t>(10, 10, [](double, double) { return 255; });
    away.geokeys = kUtm32;
    away.matrix = affine(30, 0, 700000, 0, -30, 5500000);
    expect_holds(error_of([&] { (void)mask(away, field); }),
                 "mask.tif: place of the mask: found 0.3 x 0.3 km, 19");
    away.matrix.clear();
    away.geokeys.clear();
    const scene::DensityMask spread = mask(away, field);
    EXPECT_EQ(spread.size_m, glm::dvec2(0)) << "no place: over all of the terrain";
    EXPECT_EQ(spread.width, 10);
}

TEST_F(Places, ClassesKeepTheirBordersAndDensitiesAreSmooth) {
    const Heightfield field = elevation(flat(kUtm32, affine(10, 0, 500000, 0, -10, 5500000)));
    Tiff wide = raster<std::uint8_t>(
        12, 12, [](double i, double) { return i < 6 ? 0 : 255; }); // pixels of 100 m
    wide.geokeys = kUtm32;
    wide.matrix = affine(100, 0, 499800, 0, -100, 5500200);
    const auto ramp = [&](const scene::DensityMask& density) { // metres between 5 % and 95 %
        int between = 0;
        for (int i = 0; i < density.width; ++i) {
            const float value = density.density[static_cast<std::size_t>(density.height / 2) *
                                                    static_cast<std::size_t>(density.width) +
                                                static_cast<std::size_t>(i)];
            between += value > 0.05f && value < 0.95f;
        }
        return between * field.extent_m().x / density.width;
    };
    EXPECT_LT(ramp(mask(wide, field, {{255, 1.0}})), 11);
    EXPECT_NEAR(ramp(mask(wide, field)), 90, 15);
}

TEST_F(Places, LongitudesFrom0To360AreASlope) {
    Tiff dem = raster<std::int16_t>(101, 81, [](double i, double) { return 250 + i; });
    dem.geokeys = kWgs84;
    for (const double west : {286.0, -74.0, 179.99, -180.01}) {
        dem.matrix = affine(5e-4, 0, west, 0, -5e-4, 40);
        const Heightfield field = elevation(dem);
        const std::size_t row =
            static_cast<std::size_t>(field.height / 2) * static_cast<std::size_t>(field.width);
        EXPECT_NEAR(field.metres[row + static_cast<std::size_t>(field.width / 2)], 300, 0.6)
            << west;
        EXPECT_NEAR(field.metres[row + static_cast<std::size_t>(field.width) - 1] -
                        field.metres[row],
                    100, 2)
            << west;
        EXPECT_GE(field.origin->longitude_deg, -180);
        EXPECT_LE(field.origin->longitude_deg, 180);
    }
}

TEST_F(Places, SmallAndVastRasters) {
    const double c = 30 * std::cos(0.3), s = 30 * std::sin(0.3);
    for (const std::uint32_t wide : {2u, 3u})
        for (const std::uint32_t tall : {2u, 3u, 40u}) {
            Tiff dem = raster<float>(wide, tall, [](double, double j) { return j; });
            dem.geokeys = kUtm32;
            dem.matrix = affine(c, s, 735000, s, -c, 5500000);
            const Heightfield field = elevation(dem);
            EXPECT_GE(field.width, 2);
            EXPECT_GE(field.height, 2);
            EXPECT_GT(std::min(field.extent_m().x, field.extent_m().y), 5) << wide << " x " << tall;
        }
    Tiff vast = raster<std::int16_t>(200, 200, [](double i, double) { return i; });
    vast.geokeys = kUtm32;
    for (const double km : {1001.0, 1100.0}) {
        vast.matrix = affine(km * 1000 / 199, 0, 500000 - km * 500, 0, -km * 1000 / 199, 5500000);
        EXPECT_NEAR(elevation(vast).extent_m().y / 1000, km, 0.04 * km);
    }
    vast.matrix = affine(7000, 0, 0, 0, -7000, 5500000);
    expect_holds(error_of([&] { (void)elevation(vast); }, ExitCode::kOverLimit),
                 "expected at most 1200 km a side");
}

TEST_F(Places, CoordinatesOfASiteNeedNoPlaceOnEarth) {
    Tiff site = raster<float>(5, 4, [](double i, double) { return i; });
    site.geokeys = {1, 1, 0,    4, 1024, 0,     1,    32767, 1025, 0,
                    1, 1, 3072, 0, 1,    32767, 3076, 0,     1,    9001};
    site.matrix = affine(2, 0, 1000, 0, -3, 2000);
    spec_.size_m = glm::dvec2(8, 9);
    Heightfield field = elevation(site);
    EXPECT_EQ(field.spacing_m, glm::dvec2(2, 3));
    EXPECT_FALSE(field.origin);
}

TEST_F(Places, UnusualProjectionsAreSilent) {
    testing::internal::CaptureStderr();
    for (const std::uint16_t epsg :
         std::vector<std::uint16_t>{27200, 3413, 3857, 2056, 3035, 32661, 54009})
        for (const double far : {1e5, 3e6, 3e7}) {
            Tiff dem = flat(projected(epsg), affine(20000, 0, far, 0, -20000, far));
            try {
                (void)elevation(dem);
            } catch (const base::Error& error) {
                EXPECT_NE(error.code(), ExitCode::kFailure) << error.what();
            }
        }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

} // namespace
} // namespace sward::assets
