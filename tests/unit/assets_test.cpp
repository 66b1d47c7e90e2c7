// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <locale>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assets_fixture.h"

namespace sward::assets {
namespace {

using namespace tests;

/// 40 x 30 posts of 10 m by 20 m in UTM zone 32, rising to the east.
Tiff utm_slope() {
    Tiff tiff = raster<float>(40, 30, [](double i, double) { return 100 + i; });
    tiff.geokeys = kUtm32;
    tiff.matrix = affine(10, 0, 500000, 0, -20, 5500000);
    return tiff;
}

class Elevation : public testing::Test {
protected:
    Heightfield load(const std::string& bytes, TerrainSpec spec = {},
                     const std::string& name = "height.tif") {
        put(dir_ / name, bytes);
        spec.elevation = dir_ / name;
        return load_elevation(spec);
    }
    /// The message without the directory.
    std::string error(const std::string& bytes, const TerrainSpec& spec = {},
                      ExitCode code = ExitCode::kBadInput, const std::string& name = "height.tif") {
        const std::string message = error_of([&] { (void)load(bytes, spec, name); }, code);
        const std::string prefix = dir_.path().string() + "/";
        return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
    }
    static TerrainSpec sized(double x, double z) {
        TerrainSpec spec;
        spec.size_m = glm::dvec2(x, z);
        return spec;
    }
    TempDir dir_;
};

TEST_F(Elevation, ProjectedRasterKeepsItsGrid) {
    const Heightfield field = load(utm_slope().bytes());
    EXPECT_EQ(field.width, 40);
    EXPECT_EQ(field.height, 30);
    EXPECT_NEAR(field.spacing_m.x, 10, 0.01) << "the central meridian's scale of 0.9996 is undone";
    EXPECT_NEAR(field.spacing_m.y, 20, 0.02);
    EXPECT_GT(field.spacing_m.x, 10);
    EXPECT_NEAR(field.origin->longitude_deg, 9.0028, 1e-3);
    EXPECT_NEAR(field.origin->latitude_deg, 49.65, 0.05);
    const std::size_t row = static_cast<std::size_t>(field.height / 2) * field.width;
    EXPECT_NEAR(field.metres[row + 1] - field.metres[row], 1, 1e-3);
    EXPECT_NEAR((field.metres[row] + field.metres[row + field.width - 1]) / 2, 119.5, 1e-2)
        << "centred";
}

TEST_F(Elevation, GeographicRasterBecomesMetresNorthUp) {
    // One arc-minute posts around 60 N: a minute of longitude is half a minute of latitude there.
    Tiff tiff = raster<std::int16_t>(31, 21, [](double, double j) { return 1000 - 10 * j; });
    tiff.geokeys = kWgs84;
    tiff.matrix = affine(1 / 60.0, 0, 10, 0, -1 / 60.0, 60.175);
    const Heightfield field = load(tiff.bytes());
    EXPECT_NEAR(field.spacing_m.x, 930.1, 2);
    EXPECT_NEAR(field.spacing_m.y, 1856.9, 2);
    EXPECT_NEAR(field.origin->latitude_deg, 60, 1e-6);
    EXPECT_NEAR(field.origin->longitude_deg, 10 + 15.5 / 60, 1e-6);
    EXPECT_GT(field.metres.front(), field.metres.back())
        << "row 0 is north, where the file is high";
    const auto middle = static_cast<std::size_t>(field.height / 2) * field.width + field.width / 2;
    EXPECT_NEAR(field.metres[middle], 900, 0.1);
    EXPECT_EQ(field.width % 2, 1) << "odd stays odd: posts stand on posts";
}

TEST_F(Elevation, SouthUpAndRotatedRastersAreTurned) {
    Tiff south_up = raster<float>(40, 30, [](double, double j) { return j; });
    south_up.geokeys = kUtm32;
    south_up.matrix = affine(10, 0, 500000, 0, 10, 5500000);
    const Heightfield flipped = load(south_up.bytes());
    EXPECT_GT(flipped.metres.front(), flipped.metres.back());

    // Turned by 30 degrees about its middle, and rising to the true east all the same.
    const double c = 10 * std::cos(M_PI / 6), s = 10 * std::sin(M_PI / 6);
    Tiff turned = raster<float>(
        61, 61, [&](double i, double j) { return 500 + (c * (i - 30) - s * (j - 30)) / 10; });
    turned.geokeys = kUtm32;
    turned.matrix = affine(c, -s, 500000 - 30 * c + 30 * s, -s, -c, 5500000 + 30 * s + 30 * c);
    const Heightfield field = load(turned.bytes());
    EXPECT_NEAR(field.spacing_m.x, 10, 0.01);
    EXPECT_NEAR(field.spacing_m.y, 10, 0.01);
    // The largest square about the middle of a square turned by 30 degrees: 1 / (cos 30 + sin 30).
    EXPECT_NEAR(field.width, 61 * 0.732, 2);
    for (int j = 0; j < field.height; ++j)
        for (int i = 0; i < field.width; ++i)
            ASSERT_NEAR(field.metres[static_cast<std::size_t>(j) * field.width + i],
                        500 + (i - (field.width - 1) / 2.0), 0.05)
                << i << ", " << j;
}

TEST_F(Elevation, FillsVoids) {
    Tiff tiff = utm_slope();
    for (std::size_t post : {0u, 45u, 46u, 85u, 1199u})
        tiff.data.replace(post * 4, 4, little(-9999.0f));
    tiff.nodata = "-9999";
    for (const float h : load(tiff.bytes()).metres)
        ASSERT_TRUE(h > 98 && h < 142) << h;
    Tiff nan = utm_slope();
    nan.data.replace(400, 4, little(NAN));
    nan.nodata = "nan";
    for (const float h : load(nan.bytes()).metres)
        ASSERT_TRUE(h > 98 && h < 142) << h;
    Tiff srtm = raster<std::int16_t>(
        40, 30, [](double i, double j) { return i == 7 && j == 8 ? -32768 : 50; });
    srtm.geokeys = kUtm32;
    srtm.matrix = affine(10, 0, 500000, 0, -20, 5500000);
    for (const float h : load(srtm.bytes()).metres)
        ASSERT_EQ(h, 50);
}

TEST_F(Elevation, RefusesWhatIsNoHeight) {
    Tiff tiff = utm_slope();
    tiff.data.replace(4 * 43, 4, little(INFINITY));
    expect_holds(error(tiff.bytes()), "height at column 3, row 1: found inf m");
    tiff.data.replace(4 * 43, 4, little(1e38f));
    expect_holds(error(tiff.bytes()), "column 3, row 1: found 9.99");
    Tiff empty = raster<float>(40, 30, [](double, double) { return -1; });
    empty.geokeys = kUtm32;
    empty.matrix = affine(10, 0, 500000, 0, -20, 5500000);
    empty.nodata = "-1";
    expect_holds(error(empty.bytes()),
                 "height.tif: no elevation: found voids only, expected heights");
    expect_holds(
        error(raster<float>(1, 1, [](double, double) { return 1; }).bytes(), sized(10, 10)),
        "size: found 1 x 1, expected at least 2 x 2");
    expect_holds(
        error(raster<float>(2, 1, [](double, double) { return 1; }).bytes(), sized(10, 10)),
        "size: found 2 x 1, expected at least 2 x 2");
}

TEST_F(Elevation, ScaleAndUnitComeFromTheFile) {
    const auto item = [](const std::string& scale, const std::string& offset) {
        return "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">" + scale +
               "</Item><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">" + offset +
               "</Item></GDALMetadata>";
    };
    Tiff tiff = utm_slope();
    tiff.metadata = item("2", "-50");
    const Heightfield field = load(tiff.bytes());
    EXPECT_NEAR((field.metres.front() + field.metres.back()) / 2, 2 * 119.5 - 50, 0.1);
    tiff.metadata = item("0", "0");
    expect_holds(error(tiff.bytes()), "scale of the heights: found 0 and offset 0");
    tiff.metadata = "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" "
                    "role=\"unittype\">ft</Item></GDALMetadata>";
    EXPECT_NEAR(load(tiff.bytes()).metres.front(), 100 * 0.3048, 0.5);
    tiff.metadata = "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" "
                    "role=\"unittype\">kelvin</Item></GDALMetadata>";
    expect_holds(error(tiff.bytes()), "unit of the heights: found kelvin, expected metres or feet");
}

TEST_F(Elevation, WithoutCrsNeedsASize) {
    const std::string plain =
        raster<std::int16_t>(3, 2, [](double i, double j) { return 10 * j + i; }).bytes();
    expect_holds(error(plain), "height.tif: terrain.size_m: found neither the key nor a CRS in the "
                               "file, expected the terrain's size");
    const Heightfield field = load(plain, sized(200, 50));
    EXPECT_EQ(field.spacing_m, glm::dvec2(100, 50));
    EXPECT_EQ(field.metres, (std::vector<float>{0, 1, 2, 10, 11, 12}));
    EXPECT_FALSE(field.origin);
    expect_holds(error(utm_slope().bytes(), sized(100, 100)),
                 "terrain.size_m: found the key, expected none");
    TerrainSpec spec = sized(10, 10);
    spec.height_m = glm::dvec2(0, 100);
    expect_holds(error(plain, spec),
                 "terrain.height_m: found the key, expected none: only unsigned integers");
    const std::string bytes =
        raster<std::uint16_t>(2, 2, [](double i, double) { return 65535 * i; }).bytes();
    EXPECT_EQ(load(bytes, spec).metres, (std::vector<float>{0, 100, 0, 100}));
}

TEST_F(Elevation, RefusesBadPlaces) {
    Tiff tiff = utm_slope();
    tiff.matrix = affine(0, 0, 500000, 0, 0, 5500000);
    expect_holds(error(tiff.bytes()), "height.tif: ");
    tiff.matrix = affine(10, 0, NAN, 0, -10, 5500000);
    expect_holds(error(tiff.bytes()), "height.tif: ");
    Tiff globe = raster<float>(36, 18, [](double, double) { return 1; });
    globe.geokeys = kWgs84;
    globe.matrix = affine(10, 0, -180, 0, -10, 90);
    EXPECT_NE(error(globe.bytes(), {}, ExitCode::kOverLimit), "no error");
    Tiff far = raster<float>(36, 18, [](double, double) { return 1; });
    far.geokeys = kWgs84;
    far.matrix = affine(1e7, 0, 1e9, 0, -1e7, 1e9);
    expect_holds(error(far.bytes()), "place on Earth");
}

TEST_F(Elevation, SizesAreCheckedBeforeMemoryIsTaken) {
    Tiff tiff = raster<std::int16_t>(2, 2, [](double, double) { return 1; });
    tiff.width = 1000001;
    tiff.height = 1;
    expect_holds(error(tiff.bytes(), sized(1, 1)), "height.tif: ");
    tiff.height = 2;
    expect_holds(error(tiff.bytes(), sized(1, 1), ExitCode::kOverLimit),
                 "size: found 1000001 x 2, expected at most 16384 a side");
    tiff.width = tiff.height = 16000;
    expect_holds(error(tiff.bytes(), sized(1, 1), ExitCode::kOverLimit),
                 "decoded size: found 1024000000 bytes from");
    fs::path sparse = dir_ / "sparse.tif";
    put(sparse, utm_slope().bytes());
    fs::resize_file(sparse, std::uintmax_t{5} << 30);
    TerrainSpec spec;
    spec.elevation = sparse;
    expect_holds(error_of([&] { (void)load_elevation(spec); }, ExitCode::kOverLimit),
                 "file too large: found 5368709120 bytes");
}

TEST_F(Elevation, EveryTruncationAndFlipIsHandled) {
    const std::string whole =
        raster<std::int16_t>(4, 3, [](double i, double j) { return i + j; }).bytes();
    testing::internal::CaptureStderr();
    const auto try_one = [&](const std::string& bytes, std::size_t n) {
        try {
            (void)load(bytes, sized(30, 20));
        } catch (const base::Error& error) {
            EXPECT_TRUE(error.code() == ExitCode::kBadInput || error.code() == ExitCode::kOverLimit)
                << n << ": " << error.what();
        }
    };
    for (std::size_t n = 0; n < whole.size(); ++n) {
        try_one(whole.substr(0, n), n);
        std::string flipped = whole;
        flipped[n] = static_cast<char>(flipped[n] ^ 0x55);
        try_one(flipped, n);
    }
    const std::string noise = testing::internal::GetCapturedStderr();
    EXPECT_EQ(noise.find("TIFF"), std::string::npos) << noise;
    EXPECT_EQ(noise.find("ERROR"), std::string::npos) << noise;
}

TEST_F(Elevation, FormatsAreChosenByTheirBytes) {
    expect_holds(error("just some text\n"), "height.tif: cannot read elevation: found ");
    expect_holds(error(""), "cannot read elevation: found an empty file");
    expect_holds(error("\xff\xd8\xff\xe0 not really"), "cannot read elevation: found JPEG");
    const std::string vrt =
        "<VRTDataset rasterXSize=\"2\" rasterYSize=\"2\"><VRTRasterBand dataType=\"Float32\" "
        "band=\"1\"><SimpleSource><SourceFilename>/etc/passwd</SourceFilename></SimpleSource>"
        "</VRTRasterBand></VRTDataset>";
    expect_holds(error(vrt, {}, ExitCode::kBadInput, "height.vrt"),
                 "height.vrt: cannot read elevation: found ");
    TerrainSpec spec;
    for (const char* name :
         {"/vsicurl/http://127.0.0.1/a.tif", "/vsimem/a.tif", "/./vsizip/a.zip", "/vsistdin/"}) {
        spec.elevation = name;
        expect_holds(
            error_of([&] { (void)load_elevation(spec); }),
            "terrain.elevation: found a virtual path of GDAL, expected a file on this machine");
    }
    spec.elevation = dir_.path();
    expect_holds(error_of([&] { (void)load_elevation(spec); }, ExitCode::kIo), "found a directory");
    spec.elevation = dir_ / "none.tif";
    expect_holds(error_of([&] { (void)load_elevation(spec); }, ExitCode::kIo), "No such file");
    ASSERT_EQ(::mkfifo((dir_ / "pipe.tif").c_str(), 0600), 0);
    spec.elevation = dir_ / "pipe.tif";
    ::alarm(5);
    expect_holds(error_of([&] { (void)load_elevation(spec); }, ExitCode::kIo), "found a FIFO");
    ::alarm(0);
    EXPECT_EQ(load(utm_slope().bytes(), {}, "a name\nwith \xc3\xbc.png").spacing_m.y > 19, true)
        << "a TIFF under another name";
}

TEST_F(Elevation, OtherFormats) {
    const std::string grid =
        "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n"
        "1.5 2 3\n4 -9999 6\n";
    const Heightfield field = load(grid, sized(20, 10), "hill.asc");
    ASSERT_EQ(field.metres.size(), 6u);
    EXPECT_EQ(field.metres[0], 1.5f);
    EXPECT_FLOAT_EQ(field.metres[4], (1.5f + 2 + 3 + 4 + 6) / 5);

    std::string tile;
    for (int i = 0; i < 1201 * 1201; ++i)
        tile += std::string("\x01\x00", 2);
    EXPECT_EQ(load(tile, {}, "N10E020.HGT").metres[77], 256);
    expect_holds(error(tile, sized(1, 1), ExitCode::kBadInput, "N10E020.hgt"),
                 "terrain.size_m: found the key");

    put(dir_ / "flat.json", R"({"width": 2, "height": 2, "spacing_m": [3, 4]})");
    EXPECT_EQ(load(std::string(16, '\0'), {}, "flat.f32").spacing_m, glm::dvec2(3, 4));
}

TEST_F(Elevation, AsciiGridTakesItsCrsFromAPrjFile) {
    const std::string grid =
        "ncols 3\nnrows 2\nxllcorner 500000\nyllcorner 5500000\ncellsize 10\n1 2 3\n4 5 6\n";
    put(dir_ / "hill.prj",
        "PROJCS[\"UTM 32N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
        "84\",6378137,298.257223563]],"
        "PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_"
        "Mercator\"],"
        "PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",9],PARAMETER[\"scale_"
        "factor\",0.9996],"
        "PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]");
    const Heightfield field = load(grid, {}, "hill.asc");
    EXPECT_EQ(field.width, 3);
    EXPECT_EQ(field.height, 2);
    EXPECT_NEAR(field.metres[4], 5, 0.01);
    fs::remove(dir_ / "hill.prj");
    ASSERT_EQ(::mkfifo((dir_ / "hill.prj").c_str(), 0600), 0);
    ::alarm(5);
    expect_holds(error(grid, {}, ExitCode::kIo, "hill.asc"), "hill.prj: cannot read: found a FIFO");
    ::alarm(0);
}

TEST_F(Elevation, NothingIsWrittenBesideTheFile) {
    put(dir_ / "height.tif.aux.xml", "<PAMDataset><SRS>EPSG:4326</SRS></PAMDataset>");
    (void)load(utm_slope().bytes());
    EXPECT_EQ(std::distance(fs::directory_iterator(dir_.path()), fs::directory_iterator()), 2);
}

TEST_F(Elevation, FloatExrIsMetres) {
    scene::Image image{3, 2, {"Y"}, {1, 2, 3, 4, 5, -6.25f}, {}};
    write_exr(dir_ / "height.exr", image);
    TerrainSpec spec = sized(20, 10);
    spec.elevation = dir_ / "height.exr";
    EXPECT_EQ(load_elevation(spec).metres, image.texels);
    image.texels[4] = NAN;
    write_exr(dir_ / "height.exr", image);
    EXPECT_FLOAT_EQ(load_elevation(spec).metres[4], (1 + 2 + 3 + 4 - 6.25f) / 5) << "a void";
    image.texels[4] = INFINITY;
    write_exr(dir_ / "height.exr", image);
    expect_holds(error_of([&] { (void)load_elevation(spec); }),
                 "height.exr: pixel at column 1, row 1: found inf, expected a finite number");
    image.texels[4] = 1e38f;
    write_exr(dir_ / "height.exr", image);
    expect_holds(error_of([&] { (void)load_elevation(spec); }), "height at column 1, row 1: found");
    spec.height_m = glm::dvec2(0, 1);
    expect_holds(error_of([&] { (void)load_elevation(spec); }), "terrain.height_m: found the key");
}

TEST(Jacksboro, LoadsInMetresAboutItsMiddle) {
    TerrainSpec spec;
    spec.elevation = fs::path(SWARD_SOURCE_DIR) / "terrains/jacksboro/height.tif";
    const Heightfield field = load_elevation(spec);
    EXPECT_NEAR(field.width, 403, 3);
    EXPECT_NEAR(field.height, 344, 3);
    EXPECT_NEAR(field.spacing_m.x, 74.57, 0.05);
    EXPECT_NEAR(field.spacing_m.y, 92.48, 0.05);
    const auto [low, high] = std::minmax_element(field.metres.begin(), field.metres.end());
    EXPECT_NEAR(*low, 236, 6);
    EXPECT_NEAR(*high, 1076, 3);
    EXPECT_EQ(load_elevation(spec).metres, field.metres) << "twice the same";
}

TEST_F(Elevation, SixteenBitPngNeedsItsHeights) {
    const std::string rows("\0\x00\x00\xff\xff\0\x80\x00\x40\x00", 10);
    TerrainSpec spec = sized(5, 7);
    expect_holds(error(png(2, 2, 16, 0, rows), spec),
                 "terrain.height_m: found nothing, expected [metres at 0,");
    spec.height_m = glm::dvec2(100, 300);
    const Heightfield field = load(png(2, 2, 16, 0, rows), spec);
    EXPECT_EQ(field.spacing_m, glm::dvec2(5, 7));
    EXPECT_NEAR(field.metres[0], 100, 1e-3);
    EXPECT_NEAR(field.metres[1], 300, 1e-3);
    EXPECT_NEAR(field.metres[2], 100 + 200 * 32768 / 65535.0, 1e-3);
    spec.size_m.reset();
    expect_holds(error(png(2, 2, 16, 0, rows), spec),
                 "terrain.size_m: found neither the key nor a CRS");
    spec.size_m = glm::dvec2(5, 7);
    expect_holds(error(png(2, 2, 8, 0, std::string("\0ab\0cd", 6)), spec),
                 "bits a channel: found 8 or less, expected 16");
}

class Mask : public testing::Test {
protected:
    scene::DensityMask load(const std::string& bytes, const std::map<int, double>& classes = {}) {
        put(dir_ / "mask.png", bytes);
        return load_mask(dir_ / "mask.png", classes);
    }
    std::string error(const std::string& bytes, ExitCode code = ExitCode::kBadInput) {
        return error_of([&] { (void)load(bytes); }, code);
    }
    TempDir dir_;
};

TEST_F(Mask, ReadsEveryKindOfPng) {
    const scene::DensityMask grey = load(png(3, 1, 8, 0, std::string("\0\0\x33\xff", 4)));
    EXPECT_EQ(grey.width, 3);
    EXPECT_EQ(grey.height, 1);
    EXPECT_NEAR(grey.density[1], 0.2f, 1e-6);
    EXPECT_EQ(grey.density[2], 1);
    EXPECT_NEAR(load(png(1, 1, 16, 0, std::string("\0\x80\0", 3))).density[0], 32768 / 65535.0,
                1e-6);
    EXPECT_NEAR(load(png(1, 1, 8, 2, std::string("\0\x33\xff\xff", 4))).density[0], 0.2, 1e-6)
        << "red of RGB";
    EXPECT_NEAR(load(png(1, 1, 8, 4, std::string("\0\xcc\x80", 3))).density[0], 0.8, 1e-6)
        << "grey with alpha is not multiplied by it";
    EXPECT_NEAR(load(png(1, 1, 8, 3, std::string("\0\0", 2), "\x33zz")).density[0], 0.2, 1e-6)
        << "a palette";
    EXPECT_EQ(load(png(2, 1, 1, 0, std::string("\0\x40", 2))).density, (std::vector<float>{0, 1}))
        << "1 bit";
}

// 8 x 8 grey pixels of 51.
const char* const kJpeg =
    "ffd8ffe000104a46494600010100000100010000ffdb004300100b0c0e0c0a100e0d0e1211101318281a1816"
    "16183123251d283a333d3c3933383740485c4e404457453738506d51575f626768673e4d71797064785c6567"
    "63ffc0000b080008000801011100ffc4001f0000010501010101010100000000000000000102030405060708"
    "090a0bffc400b5100002010303020403050504040000017d0102030004110512213141061351610722711432"
    "8191a1082342b1c11552d1f02433627282090a161718191a25262728292a3435363738393a43444546474849"
    "4a535455565758595a636465666768696a737475767778797a838485868788898a92939495969798999aa2a3"
    "a4a5a6a7a8a9aab2b3b4b5b6b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9ea"
    "f1f2f3f4f5f6f7f8f9faffda0008010100003f00e62bffd9";

std::string from_hex(const std::string& hex) {
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
}

TEST_F(Mask, ReadsJpegAndRefusesHalfOfOne) {
    const std::string whole = from_hex(kJpeg);
    const scene::DensityMask mask = load(whole);
    EXPECT_EQ(mask.width, 8);
    EXPECT_NEAR(mask.density[9], 0.2, 0.01);
    testing::internal::CaptureStderr();
    for (std::size_t n = 0; n < whole.size(); ++n)
        try {
            std::string flipped = whole;
            flipped[n] = static_cast<char>(flipped[n] ^ 0x24);
            (void)load(n % 2 ? flipped : whole.substr(0, n));
        } catch (const base::Error& e) {
            EXPECT_TRUE(e.code() == ExitCode::kBadInput || e.code() == ExitCode::kOverLimit)
                << e.what();
        }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Mask, MapsClassesToDensity) {
    const std::string bytes = png(4, 1, 8, 0, std::string("\0\x0a\x14\x1e\xff", 5));
    EXPECT_EQ(load(bytes, {{10, 1.0}, {20, 0.25}, {255, 0.5}}).density,
              (std::vector<float>{1, 0.25f, 0, 0.5f}));
    EXPECT_EQ(load(png(1, 1, 16, 0, std::string("\0\x03\xe9", 3)), {{1001, 0.75}}).density[0],
              0.75f);
}

TEST_F(Mask, RefusesBrokenAndHugePictures) {
    const std::string whole = png(3, 1, 8, 0, std::string("\0\0\x33\xff", 4));
    expect_holds(error("text"),
                 "mask.png: format: found none of them in its first bytes, expected PNG, TIFF");
    expect_holds(error(""), "expected PNG, TIFF, EXR, JPEG or an ASCII grid");
    expect_holds(error(png(0, 3, 8, 0, "")), "mask.png: cannot decode");
    expect_holds(error(png(1000001, 1, 8, 0, "")), "mask.png: ");
    expect_holds(error(png(30000, 30000, 8, 0, std::string(1000, '\0')), ExitCode::kOverLimit),
                 "size: found 30000 x 30000, expected at most 16384 a side");
    expect_holds(
        error(png(16000, 16000, 8, 0, std::string(1000, '\0')), ExitCode::kOverLimit),
        "decoded size: found 1024000000 bytes from 1068, expected at most 1000 times the file");
    for (std::size_t n = 0; n < whole.size(); ++n) {
        testing::internal::CaptureStderr();
        try {
            std::string flipped = whole;
            flipped[n] = static_cast<char>(flipped[n] ^ 0x10);
            (void)load(flipped);
        } catch (const base::Error& e) {
            EXPECT_TRUE(e.code() == ExitCode::kBadInput || e.code() == ExitCode::kOverLimit)
                << e.what();
        }
        try {
            (void)load(whole.substr(0, n));
        } catch (const base::Error& e) {
            EXPECT_EQ(e.code(), ExitCode::kBadInput) << e.what();
        }
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << n;
    }
}

TEST_F(Mask, ChecksFloatValuesAndChannels) {
    const fs::path path = dir_ / "mask.exr";
    write_exr(path, {2, 1, {"Y"}, {0.25f, 1.0004f}, {}});
    EXPECT_EQ(load_mask(path).density, (std::vector<float>{0.25f, 1.0f}));
    write_exr(path, {2, 1, {"Y"}, {0.25f, -0.5f}, {}});
    expect_holds(error_of([&] { (void)load_mask(path); }),
                 "mask.exr: pixel at column 1, row 0: found -0.5, expected a density from 0 to 1");
    write_exr(path, {2, 1, {"Y"}, {0.25f, INFINITY}, {}});
    expect_holds(error_of([&] { (void)load_mask(path); }), "found inf, expected a finite number");
    write_exr(path, {1, 1, {"a", "b", "c", "d", "e"}, {0, 0, 0, 0, 0}, {}});
    expect_holds(error_of([&] { (void)load_mask(path); }, ExitCode::kOverLimit),
                 "channels: found 5, expected at most 4");
    Tiff bits = raster<float>(2, 1, [](double i, double) { return 0.5 * i; });
    put(dir_ / "mask.tif", bits.bytes());
    EXPECT_EQ(load_mask(dir_ / "mask.tif").density, (std::vector<float>{0, 0.5f}));
    bits.width = bits.height = 16000;
    put(dir_ / "mask.tif", bits.bytes());
    expect_holds(error_of([&] { (void)load_mask(dir_ / "mask.tif"); }, ExitCode::kOverLimit),
                 "decoded size");
    ASSERT_EQ(::mkfifo((dir_ / "pipe.png").c_str(), 0600), 0);
    ::alarm(5);
    expect_holds(error_of([&] { (void)load_mask(dir_ / "pipe.png"); }, ExitCode::kIo),
                 "found a FIFO");
    ::alarm(0);
}

TEST(Picture, PngIsReadBackAndAlwaysTheSame) {
    const TempDir dir;
    scene::Picture picture{64, 48, {}};
    for (int i = 0; i < 64 * 48 * 3; ++i)
        picture.rgb.push_back(static_cast<std::uint8_t>(i * 7));
    write_png(dir / "a.png", picture);
    ::sleep(1); // a time in the file would show
    write_png(dir / "b.dat", picture);
    EXPECT_EQ(get(dir / "a.png"), get(dir / "b.dat"));
    const scene::DensityMask red = load_mask(dir / "a.png");
    ASSERT_EQ(red.width, 64);
    for (std::size_t i = 0; i < red.density.size(); ++i)
        ASSERT_EQ(std::lround(red.density[i] * 255), picture.rgb[3 * i]);
    EXPECT_EQ(get(dir / "a.png").find("tIME"), std::string::npos);
}

TEST(Picture, ExrKeepsChannelsTypesAndMetadata) {
    const TempDir dir;
    scene::Image image{5, 3, {"R", "G", "B", "A", "depth", "tangent.X"}, {}, {{"cell_m", "0.5"}}};
    for (int i = 0; i < 5 * 3 * 6; ++i)
        image.texels.push_back(float(i) / 7);
    image.texels[0] = 1e6f; // past the largest half
    write_exr(dir / "a.exr", image);
    ::sleep(1);
    write_exr(dir / "b.exr", image);
    const std::string bytes = get(dir / "a.exr");
    EXPECT_EQ(bytes, get(dir / "b.exr"));
    // The header's channel list: name, type (1 half, 2 float) as a little-endian word.
    for (const char* colour : {"R", "G", "B", "A"})
        EXPECT_NE(bytes.find(std::string(1, '\0') + colour + std::string("\0\1\0\0\0", 5)),
                  std::string::npos)
            << colour;
    for (const char* data : {"depth", "tangent.X"})
        EXPECT_NE(bytes.find(data + std::string("\0\2\0\0\0", 5)), std::string::npos) << data;
    expect_holds(bytes, "cell_m");

    scene::Image depth{2, 1, {"depth"}, {1e6f, 0.1f}, {}};
    write_exr(dir / "depth.exr", depth);
    TerrainSpec spec;
    spec.size_m = glm::dvec2(1, 1);
    spec.elevation = dir / "depth.exr";
    expect_holds(error_of([&] { (void)load_elevation(spec); }), "size: found 2 x 1");
}

TEST(Picture, FailuresLeaveNothing) {
    const TempDir dir;
    const scene::Picture picture{2, 2, std::vector<std::uint8_t>(12)};
    expect_holds(error_of([&] { write_png(dir / "none/a.png", picture); }, ExitCode::kIo),
                 "expected a directory that exists");
    expect_holds(error_of([&] { write_png("/dev/full", picture); }, ExitCode::kIo),
                 "/dev/full: cannot write");
    expect_holds(error_of([&] { write_png(dir.path(), picture); }, ExitCode::kIo),
                 "found a directory");
    expect_holds(error_of(
                     [&] {
                         write_png(dir / "a.png", {2, 2, {1, 2}});
                     },
                     ExitCode::kFailure),
                 "found 2 bytes for 4 pixels");
    expect_holds(error_of(
                     [&] {
                         write_exr(dir / "a.exr", {2, 2, {"R"}, {1}, {}});
                     },
                     ExitCode::kFailure),
                 "found 1 values for 4 pixels of 1 channels");
    EXPECT_TRUE(fs::is_empty(dir.path()));
}

TEST(LibraryVersions, IsOneLine) {
    const std::string versions = library_versions();
    expect_holds(versions, "OpenImageIO 2.");
    expect_holds(versions, "GDAL 3.");
    EXPECT_EQ(versions.find('\n'), std::string::npos);
}

} // namespace
} // namespace sward::assets
