// SPDX-License-Identifier: Apache-2.0
// Kinds of elevation and masks that users bring: how they say "no value", how they spell units, and
// grids, raw posts and windows.
#include <chrono>

#include "assets_fixture.h"

namespace sward::assets {
namespace {

using namespace tests;

class Kinds : public testing::Test {
protected:
    Heightfield load(const std::string& bytes, TerrainSpec spec = {},
                     const std::string& name = "height.tif") {
        put(dir_ / name, bytes);
        spec.elevation = dir_ / name;
        return load_elevation(spec);
    }
    std::string error(const std::string& bytes, const TerrainSpec& spec = {},
                      const std::string& name = "height.tif", ExitCode code = ExitCode::kBadInput) {
        return error_of([&] { (void)load(bytes, spec, name); }, code);
    }
    scene::DensityMask mask(const std::string& bytes, const std::map<int, double>& classes = {}) {
        put(dir_ / "mask", bytes);
        return load_mask(dir_ / "mask", classes);
    }
    static TerrainSpec sized(double x, double z) {
        TerrainSpec spec;
        spec.size_m = glm::dvec2(x, z);
        return spec;
    }
    TempDir dir_;
};

/// A slope of 9 x 7 posts whose middle 3 x 3 hold -5000.
Tiff holed() {
    return raster<std::int16_t>(9, 7, [](double i, double j) {
        return i >= 3 && i < 6 && j >= 2 && j < 5 ? -5000 : 100 + i;
    });
}

std::string valid_around() {
    std::string valid;
    for (int j = 0; j < 7; ++j)
        for (int i = 0; i < 9; ++i)
            valid += i >= 3 && i < 6 && j >= 2 && j < 5 ? '\0' : '\xff';
    return valid;
}

TEST_F(Kinds, ValidityIsTheMaskInsideTheFile) {
    Tiff masked = holed();
    masked.inner_mask = valid_around();
    for (const float h : load(masked.bytes(), sized(80, 60)).metres)
        EXPECT_GE(h, 100);
    Tiff alpha = holed();
    alpha.samples = 2;
    alpha.alpha = true;
    const std::string valid = valid_around(), heights = alpha.data;
    alpha.data.clear();
    for (std::size_t i = 0; i < valid.size(); ++i)
        alpha.data +=
            heights.substr(2 * i, 2) + little(static_cast<std::int16_t>(valid[i] ? 32767 : 0));
    testing::internal::CaptureStderr();
    for (const float h : load(alpha.bytes(), sized(80, 60)).metres)
        EXPECT_GE(h, 100);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "an alpha is no second height";
    Tiff both = masked;
    both.nodata = "100"; // the first column
    for (const float h : load(both.bytes(), sized(80, 60)).metres)
        EXPECT_GE(h, 101);
    Tiff density = raster<std::uint8_t>(9, 7, [](double, double) { return 255; });
    density.inner_mask = valid_around();
    const scene::DensityMask holes = mask(density.bytes());
    EXPECT_EQ(holes.density[2 * 9 + 3], 0);
    EXPECT_EQ(holes.density[0], 1);
}

TEST_F(Kinds, VoidsThatNothingDeclares) {
    for (const double code : {-32768.0, -32767.0, -32000.0, -9999.0}) {
        Tiff whole = raster<std::int16_t>(
            6, 5, [&](double i, double j) { return i == 2 && j == 2 ? code : 40 + i; });
        EXPECT_NEAR(load(whole.bytes(), sized(5, 4)).metres[14], 42, 1) << code;
        Tiff real = raster<float>(
            6, 5, [&](double i, double j) { return i == 2 && j == 2 ? code : 40 + i; });
        EXPECT_NEAR(load(real.bytes(), sized(5, 4)).metres[14], 42, 1) << code;
    }
    for (const float code : {NAN, -3.4028235e38f, 3.4028235e38f, -99999.0f, -2147483648.0f}) {
        Tiff real = raster<float>(
            6, 5, [&](double i, double j) { return i == 2 && j == 2 ? code : 40 + i; });
        EXPECT_NEAR(load(real.bytes(), sized(5, 4)).metres[14], 42, 1) << code;
    }
    Tiff trench =
        raster<float>(6, 5, [&](double i, double j) { return i == 2 && j == 2 ? -9999 : 40 + i; });
    trench.nodata = "-1";
    EXPECT_EQ(load(trench.bytes(), sized(5, 4)).metres[14], -9999)
        << "another number stands for voids";
    expect_holds(
        error(raster<float>(2, 2, [](double, double) { return NAN; }).bytes(), sized(5, 4)),
        "no elevation: found voids only");
}

TEST_F(Kinds, MasksWithoutAValueAreBare) {
    Tiff tiff = raster<std::uint8_t>(3, 1, [](double i, double) { return i == 1 ? 255 : 204; });
    tiff.nodata = "255";
    EXPECT_EQ(mask(tiff.bytes()).density[1], 0);
    EXPECT_NEAR(mask(tiff.bytes()).density[0], 0.8, 1e-6);
    EXPECT_EQ(mask(tiff.bytes(), {{255, 1.0}, {204, 0.5}}).density,
              (std::vector<float>{0.5f, 0, 0.5f}))
        << "classes too";
    EXPECT_NEAR(mask(tiff.bytes(), {{204, 0.5}}).class_shares.at(-1), 1 / 3.0, 1e-9);
    Tiff real = raster<float>(2, 1, [](double i, double) { return i > 0 ? NAN : 0.5f; });
    EXPECT_EQ(mask(real.bytes()).density, (std::vector<float>{0.5f, 0}));
}

template<class T>
std::vector<float> classes_of(Kinds&,
                              const std::function<scene::DensityMask(const std::string&)>& read) {
    Tiff tiff = raster<T>(3, 1, [](double i, double) { return i == 0 ? 30 : i == 1 ? 40 : 100; });
    return read(tiff.bytes()).density;
}

TEST_F(Kinds, ClassesComeInAnyWholeType) {
    const auto read = [&](const std::string& bytes) {
        return mask(bytes, {{30, 1.0}, {100, 0.25}});
    };
    const std::vector<float> expected = {1, 0, 0.25f};
    EXPECT_EQ(classes_of<std::uint8_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::int8_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::int64_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::uint64_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::int16_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::uint16_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::int32_t>(*this, read), expected);
    EXPECT_EQ(classes_of<std::uint32_t>(*this, read), expected);
    EXPECT_EQ(classes_of<float>(*this, read), expected);
    EXPECT_EQ(classes_of<double>(*this, read), expected);
    Tiff signed_void = raster<std::int16_t>(2, 1, [](double i, double) { return i > 0 ? -1 : 30; });
    expect_holds(error_of([&] { (void)read(signed_void.bytes()); }),
                 "column 1, row 0: found -1, expected a landcover class");
    signed_void.nodata = "-1";
    EXPECT_EQ(read(signed_void.bytes()).density, (std::vector<float>{1, 0}));
    expect_holds(error_of([&] {
                     (void)mask(
                         raster<std::int16_t>(2, 1, [](double, double) { return 1; }).bytes());
                 }),
                 "type of the pixels: found Int16");
}

/// What a file of a type makes of its value for "none", beside a class 7 and a void that nothing
/// declares.
template<class T>
void expect_nodata(
    const std::function<scene::DensityMask(const std::string&, const std::map<int, double>&)>& read,
    double value, const std::string& nodata) {
    SCOPED_TRACE(nodata);
    Tiff tiff = raster<T>(2, 1, [&](double i, double) { return i > 0 ? value : 7; });
    tiff.nodata = nodata;
    const scene::DensityMask mask = read(tiff.bytes(), {{7, 0.5}});
    EXPECT_EQ(mask.density, (std::vector<float>{0.5f, 0}));
    EXPECT_EQ(mask.class_shares, (std::map<int, double>{{-1, 0.5}, {7, 0.5}}));
}

TEST_F(Kinds, EveryTypeHasItsNumberForNone) {
    const auto read = [&](const std::string& bytes, const std::map<int, double>& classes) {
        return mask(bytes, classes);
    };
    expect_nodata<std::int8_t>(read, -128, "-128");
    expect_nodata<std::int8_t>(read, -1, "-1");
    expect_nodata<std::uint8_t>(read, 255, "255");
    expect_nodata<std::int16_t>(read, -32768, "-32768");
    expect_nodata<std::uint16_t>(read, 65535, "65535");
    expect_nodata<std::int32_t>(read, -2147483648.0, "-2147483648");
    expect_nodata<std::uint32_t>(read, 4294967295.0, "4294967295");
    expect_nodata<std::int64_t>(read, -9223372036854775808.0, "-9223372036854775808");
    expect_nodata<float>(read, -3.4028234663852886e38, "-3.40282e+38");
    expect_nodata<float>(read, NAN, "nan");
    expect_nodata<double>(read, -1.7976931348623157e308, "-1.7976931348623157e+308");
}

TEST_F(Kinds, BytesMayBeSigned) {
    const auto values = [](double i, double) { return i == 0 ? -10 : 7; };
    const std::string bytes = raster<std::int8_t>(2, 2, values).bytes();
    expect_holds(error_of([&] {
                     (void)mask(bytes, {{246, 1.0}});
                 }),
                 "column 0, row 0: found -10, expected a landcover class");
    expect_holds(error_of([&] { (void)mask(bytes); }), "type of the pixels: found Int8");
    EXPECT_EQ(load(bytes, sized(1, 1)).metres, (std::vector<float>{-10, 7, -10, 7}));
    TerrainSpec scaled = sized(1, 1);
    scaled.height_m = glm::dvec2(0, 100);
    expect_holds(error(bytes, scaled), "terrain.height_m: found the key, expected none");
}

TEST_F(Kinds, ColoursThatAreTransparentAreNoValue) {
    const std::string bytes = [] {
        std::string whole =
            png(3, 1, 8, 3, std::string("\0\0\1\2", 4), std::string("\xff\0\0\x80\0\0\x33\0\0", 9));
        const std::string kind("tRNS"),
            alpha("\xff\0\0", 3); // two of them: no single number for "none"
        const std::uint32_t sum = crc(kind + alpha);
        const std::string chunk =
            std::string("\0\0\0\3", 4) + kind + alpha +
            std::string{char(sum >> 24), char(sum >> 16), char(sum >> 8), char(sum)};
        return whole.insert(whole.find("IDAT") - 4, chunk);
    }();
    EXPECT_EQ(mask(bytes).density, (std::vector<float>{1, 0, 0}));
    EXPECT_EQ(mask(bytes, {{0, 0.25}, {1, 1.0}, {2, 1.0}}).density,
              (std::vector<float>{0.25f, 0, 0}));
}

TEST_F(Kinds, ExrOfWholeNumbersAndWithAlpha) {
    const auto exr = [&](const char* type, const std::vector<std::string>& names,
                         const std::string& pixels) { // one row, unpacked
        std::string header = std::string("\x76\x2f\x31\x01\2\0\0\0", 8), channels;
        for (const std::string& name : names)
            channels += name + '\0' + little(std::int32_t{std::string(type) == "uint" ? 0 : 2}) +
                        std::string(4, '\0') + little(1) + little(1);
        const auto columns = static_cast<std::int32_t>(pixels.size() / 4 / names.size());
        const std::string window = little(0) + little(0) + little(columns - 1) + little(0);
        const auto add = [&](const std::string& name, const std::string& kind,
                             const std::string& value) {
            header +=
                name + '\0' + kind + '\0' + little(static_cast<std::int32_t>(value.size())) + value;
        };
        add("channels", "chlist", channels + '\0');
        add("compression", "compression", std::string(1, '\0'));
        add("dataWindow", "box2i", window);
        add("displayWindow", "box2i", window);
        add("lineOrder", "lineOrder", std::string(1, '\0'));
        add("pixelAspectRatio", "float", little(1.0f));
        add("screenWindowCenter", "v2f", little(0.0f) + little(0.0f));
        add("screenWindowWidth", "float", little(1.0f));
        header += '\0';
        return header + little(static_cast<std::uint64_t>(header.size() + 8)) + little(0) +
               little(static_cast<std::int32_t>(pixels.size())) + pixels;
    };
    const std::string classes = exr("uint", {"Y"}, little(30u) + little(7u) + little(0u));
    EXPECT_EQ(mask(classes, {{30, 1.0}, {7, 0.5}}).density, (std::vector<float>{1, 0.5f, 0}));
    expect_holds(error_of([&] { (void)mask(classes); }),
                 "column 0, row 0: found 30, expected a density from 0 to 1");
    const std::string holes = exr("float", {"A", "Y"},
                                  little(1.0f) + little(0.0f) + little(0.5f) + little(0.5f) +
                                      little(0.5f) + little(0.25f));
    testing::internal::CaptureStderr();
    EXPECT_EQ(mask(holes).density, (std::vector<float>{0.5f, 0, 0.25f}));
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "an alpha is no second mask";
}

TEST_F(Kinds, BandsAreChosen) {
    Tiff tiff;
    tiff.width = 2, tiff.height = 2, tiff.bits = 8, tiff.format = 1, tiff.samples = 3;
    for (int i = 0; i < 4; ++i)
        tiff.data += std::string("\x00\xff\x33", 3);
    put(dir_ / "mask", tiff.bytes());
    TerrainSpec spec;
    spec.mask = dir_ / "mask";
    spec.mask_band = 2;
    EXPECT_EQ(load_mask(spec, {}).density[0], 1);
    spec.mask_band = 3;
    EXPECT_NEAR(load_mask(spec, {}).density[0], 0.2, 1e-6);
    spec.mask_band = 4;
    expect_holds(error_of([&] { (void)load_mask(spec, {}); }), "bands: found 3, expected a band 4");
    TerrainSpec height = sized(1, 1);
    height.elevation_band = 3;
    height.height_m = glm::dvec2(0, 255);
    EXPECT_NEAR(load(tiff.bytes(), height).metres[0], 51, 1e-4);
}

TEST_F(Kinds, UnitsAsDriversSpellThem) {
    const auto metres = [&](const std::string& unit) {
        Tiff tiff = raster<float>(2, 2, [](double, double) { return 1000; });
        tiff.metadata = "<GDALMetadata><Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">" +
                        unit + "</Item></GDALMetadata>";
        return load(tiff.bytes(), sized(1, 1)).metres[0];
    };
    for (const char* unit : {"m", "M", "Meter", "Metre", "METERS", "metres", " meters ", "unknown"})
        EXPECT_EQ(metres(unit), 1000) << unit;
    for (const char* unit :
         {"ft", "Feet", "FOOT", "foot", "International Foot", "international feet"})
        EXPECT_NEAR(metres(unit), 304.8, 1e-3) << unit;
    for (const char* unit : {"ftUS", "US survey foot", "us-ft", "US_survey_foot", "Foot_US",
                             "sFeet", "US Survey Feet", "foot (US survey)"})
        EXPECT_NEAR(metres(unit), 1000 * 1200.0 / 3937, 1e-3) << unit;
    EXPECT_NEAR(metres("cm"), 10, 1e-4);
    EXPECT_NEAR(metres("Decimeters"), 100, 1e-4);
    EXPECT_THROW((void)metres("km"), base::Error) << "a thousand kilometres up";
}

const char* const kGrid = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n";

TEST_F(Kinds, AsciiGridsAreReadToTheLastWord) {
    const auto read = [&](const std::string& text) {
        return load(text, sized(20, 10), "a.asc").metres;
    };
    const auto refuse = [&](const std::string& text, const std::string& piece) {
        expect_holds(error(text, sized(20, 10), "a.asc"), piece);
    };
    const std::string grid = kGrid;
    EXPECT_NEAR(read(grid + "1 2 3\n4 -9999 6\n")[4], 3.2, 1e-5) << "Esri's default for voids";
    EXPECT_NEAR(read(grid + "NODATA_value -1\n1 2 3\n4 -1 6\n")[4], 3.2, 1e-5);
    EXPECT_EQ(read(grid + "NODATA_value -1\n1 2 3\n4 -9999 6\n")[4], -9999)
        << "another number stands for voids";
    EXPECT_NEAR(read(grid + "nodata_value nan\n1 2 3\n4 nan 6\n")[4], 3.2, 1e-5);
    EXPECT_NEAR(read(grid + "NODATA_value -3.402823e+38\n1 2 3\n4 -3.4028235e38 6\n")[4], 3.2,
                1e-5);
    EXPECT_EQ(read(grid + "1 2\r\n3 4\r\n5e0 +6"), (std::vector<float>{1, 2, 3, 4, 5, 6}))
        << "lines may break anywhere";
    refuse(grid + "1 2 3\n4 x 6\n",
           "a.asc:7: height at column 1, row 1: found x, expected a number");
    refuse(grid + "1 2 3\n4 5,5 6\n", "a.asc:7: height at column 1, row 1: found 5,5");
    refuse(grid + "NODATA_value -9999\n1 nan 3\n4 5 6\n",
           "a.asc:7: height at column 1, row 0: found nan");
    refuse(grid + "1 2 3\n4 5\n", "a.asc:8: heights: found 5, expected 6 for 3 x 2 posts");
    refuse(grid + "1 2 3\n4 5 6\n7\n", "a.asc:8: heights: found more than 6: 7");
    refuse(grid + "1 2 3\n4 1e400 6\n", "a.asc:7: ");
    refuse("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 30,5\n1 2 3\n4 5 6\n",
           "a.asc:5: cellsize: found 30,5, expected a number");
}

TEST_F(Kinds, RawPostsOfGameEngines) {
    std::string posts;
    for (const int value : {0, 65535, 32768, 257, 1, 2, 3, 4, 65534})
        posts += little(static_cast<std::uint16_t>(value));
    TerrainSpec spec = sized(10, 20);
    spec.height_m = glm::dvec2(100, 755.35);
    for (const char* name : {"a.r16", "a.raw", "a.R16"}) {
        const Heightfield field = load(posts, spec, name);
        EXPECT_EQ(field.width, 3);
        EXPECT_EQ(field.height, 3);
        EXPECT_EQ(field.spacing_m, glm::dvec2(5, 10));
        EXPECT_NEAR(field.metres[0], 100, 1e-4);
        EXPECT_NEAR(field.metres[1], 755.35, 1e-3);
        EXPECT_NEAR(field.metres[3], 102.57, 1e-3) << "little-endian";
    }
    expect_holds(error(posts.substr(2), spec, "a.r16"),
                 "size of the file: found 16 bytes, expected a square of 16-bit posts");
    expect_holds(error(posts, sized(10, 20), "a.r16"), "terrain.height_m: found nothing");
    expect_holds(error(posts, {}, "b.raw"),
                 "terrain.size_m: found nothing, expected the key for 16-bit posts, or a header");
}

TEST_F(Kinds, TilesOfTheFarNorth) {
    std::string tile;
    tile.reserve(std::size_t{1801} * 3601 * 2);
    for (int j = 0; j < 3601; ++j)
        for (int i = 0; i < 1801; ++i)
            tile += static_cast<char>(j / 256), tile += static_cast<char>(j % 256);
    const Heightfield field = load(tile, {}, "N61E010.hgt");
    EXPECT_EQ(field.width, 1801);
    EXPECT_EQ(field.height, 3601);
    EXPECT_NEAR(field.extent_m().x, 111320 * std::cos(61.5 * M_PI / 180), 300);
    EXPECT_NEAR(field.extent_m().y, 111420, 100);
    EXPECT_EQ(field.metres[1801 * 100], 100);
    expect_holds(error(tile.substr(0, 100), {}, "N61E010.hgt"),
                 "not an .hgt tile: found 100 bytes");
}

/// Replaces the box of an EXR's window: `which` is dataWindow or displayWindow.
std::string with_window(std::string exr, const std::string& which,
                        std::array<std::int32_t, 4> box) {
    const std::string name = which + std::string("\0box2i\0", 7);
    const std::size_t at = exr.find(name) + name.size() + 4;
    for (std::size_t i = 0; i < 4; ++i)
        exr.replace(at + 4 * i, 4, little(box[i]));
    return exr;
}

TEST_F(Kinds, ExrDataStandsWhereItsWindowsSay) {
    write_exr(dir_ / "a.exr", {2, 2, {"Y"}, {0.25f, 0.5f, 0.75f, 1}, {}});
    const std::string exr = get(dir_ / "a.exr");
    const scene::DensityMask small = mask(with_window(exr, "displayWindow", {-1, -2, 2, 1}));
    ASSERT_EQ(small.width, 4);
    ASSERT_EQ(small.height, 4);
    EXPECT_EQ(small.density,
              (std::vector<float>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0.25f, 0.5f, 0, 0, 0.75f, 1, 0}));
    const scene::DensityMask cut = mask(with_window(exr, "displayWindow", {1, 0, 2, 1}));
    EXPECT_EQ(cut.density, (std::vector<float>{0.5f, 0, 1, 0}));
    const Heightfield field =
        load(with_window(exr, "displayWindow", {-1, -2, 2, 1}), sized(3, 3), "b.exr");
    EXPECT_EQ(field.width, 4);
    EXPECT_EQ(field.metres[9], 0.25f);
    EXPECT_EQ(field.metres[15], 0.75f) << "filled from its neighbours";
    EXPECT_EQ(error(with_window(exr, "displayWindow", {0, 0, 99999, 1}), sized(3, 3), "b.exr",
                    ExitCode::kOverLimit)
                  .find("no error"),
              std::string::npos);
}

TEST_F(Kinds, AttributesAndChunksThatLie) {
    write_exr(dir_ / "a.exr", {2, 2, {"Y"}, {0.25f, 0.5f, 0.75f, 1}, {}});
    const std::string exr = get(dir_ / "a.exr");
    for (const std::int32_t rows : {0, 2147483647, INT32_MIN}) {
        const std::string attribute =
            std::string("tiff:RowsPerStrip\0int\0", 22) + little(std::int32_t{4}) + little(rows);
        std::string bad =
            exr; // its attribute table begins behind magic and version; offsets of the chunks move
        bad.insert(8, attribute);
        put(dir_ / "b.exr", bad);
        expect_holds(error_of([&] { (void)load_mask(dir_ / "b.exr"); }),
                     "b.exr: attribute tiff:RowsPerStrip: found " + std::to_string(rows));
    }
    for (const char* kind : {"tEXt", "zTXt", "iTXt", "pCAL", "sCAL", "sPLT"}) {
        std::string bomb = png(1, 1, 8, 0, std::string("\0\x33", 2));
        bomb.insert(33, std::string("\x7f\xff\xff\xff", 4) + kind);
        const auto before = std::chrono::steady_clock::now();
        expect_holds(error_of([&] { (void)mask(bomb); }),
                     std::string("chunk ") + kind + ": found 2147483647 bytes");
        EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(1));
    }
}

} // namespace
} // namespace sward::assets
