// SPDX-License-Identifier: Apache-2.0
// The far light table: against rays that know nothing of it, its symmetries, its file, and what the
// ground makes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <random>
#include <stdexcept>

#include "base/file.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "grass_fixture.h"
#include "shared/bend.h"
#include "shared/shading.h"
#include "shells/far_appearance.h"
#include "texgen/far/far_table.h"
#include "texgen/patch/canopy.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using grass::FarLight;
using grass::FarSample;

constexpr double kDegree = std::numbers::pi / 180;

glm::vec3 heading(double elevation_deg, double azimuth_deg) {
    const double e = elevation_deg * kDegree, a = azimuth_deg * kDegree;
    return glm::vec3(std::cos(e) * std::cos(a), std::sin(e), std::cos(e) * std::sin(a));
}

shared::Light light_from(const glm::vec3& to_sun) {
    shared::Light light{};
    light.to_sun = to_sun;
    light.sun_extinction = shared::kSunExtinction;
    light.sun = {3.1f, 2.9f, 2.4f};
    light.zenith = {0.2f, 0.4f, 0.8f};
    light.sky_extinction = shared::kSkyExtinction;
    light.horizon = {0.8f, 0.9f, 1.1f};
    return light;
}

/// A view of blades that stand in a wind, by random rays in the world's own directions.
struct View {
    double elevation_deg = 30, eye_azimuth_deg = 0;
    glm::vec2 wind{0};
    float response = 0;
};
struct Seen {
    glm::dvec3 radiance{0}; ///< of the hits
    double coverage = 0;
};

Seen look_at(const Patch& patch, double canopy, const View& view, const shared::Light& above) {
    constexpr int kRays = 60000;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    Seen seen;
    const glm::vec3 to_eye = heading(view.elevation_deg, view.eye_azimuth_deg);
    const glm::vec3 turn = shared::bend_turn(shared::kSwayHeight, 1, view.wind, view.response);
    const shared::Light light = shared::light_in_sway(
        above, shared::canopy_sway(patch.looks.front(), turn, above.to_sun, to_eye));
    for (int v = 0; v < patch.variants(); ++v) {
        const auto rest = patch.variant(v);
        std::vector<shared::BladeRecord> bent(rest.begin(), rest.end());
        for (shared::BladeRecord& blade : bent) {
            glm::vec3 v1(blade.v1), v2(blade.v2);
            shared::pose_blade(
                v1, v2, {blade.shape.y, static_cast<float>(canopy), view.response, 1}, view.wind);
            blade.v1 = {v1, blade.v1.w};
            blade.v2 = {v2, blade.v2.w};
        }
        const BladeField field(bent, patch.looks, patch.side_m, canopy);
        for (int i = 0; i < kRays / patch.variants(); ++i) {
            const glm::dvec3 from(unit(random) * patch.side_m, canopy, unit(random) * patch.side_m);
            const auto hit = field.cast(from, -glm::dvec3(to_eye));
            if (!hit)
                continue;
            const shared::BladeRecord &a = rest[hit->blade], &b = bent[hit->blade];
            const auto along = static_cast<float>(hit->along);
            const auto& look = patch.looks[species_of(a)];
            const shared::GrassPoint point{
                shared::blade_albedo(look, {a.root.z, a.root.w}, along, 1),
                shared::blade_tangent(glm::vec3(b.v1), glm::vec3(b.v2), along),
                shared::blade_curve(glm::vec3(a.v1), glm::vec3(a.v2), along).y /
                    static_cast<float>(canopy),
                light.to_sun.y};
            seen.coverage += 1;
            seen.radiance += shared::shade_grass(look, light, point, to_eye);
        }
    }
    seen.radiance /= seen.coverage;
    seen.coverage /= kRays / patch.variants() * patch.variants();
    return seen;
}

std::size_t index_of(const std::vector<float>& axis, float value) {
    const auto at = std::ranges::find(axis, value);
    if (at == axis.end())
        throw std::out_of_range("no such node");
    return static_cast<std::size_t>(at - axis.begin());
}

glm::dvec3 radiance_of(const FarSample& s, const shared::Light& light) {
    return s.sun * light.sun + s.sky * shared::even_sky(light);
}

double worst_ratio(const glm::dvec3& found, const glm::dvec3& truth) {
    double worst = 0;
    for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(found[c] / truth[c] - 1));
    return worst;
}

TEST(FarLight, IsWhatIndependentRaysSeeInAWindFromAnywhere) {
    const grass::GrassSet& set = small_set();
    const FarLight& table = set.far_light;
    const Patch patch = small_patch();
    struct Case {
        float lean, lean_azimuth, elevation, sun_elevation;
        int sun_azimuth;
    };
    double bend_matters = 0;
    for (const Case& c :
         {Case{0, 90, 30, 30, 3}, Case{0.3f, 45, 45, 45, 6}, Case{0.6f, 135, 20, 20, 13},
          Case{0.9f, 90, 60, 60, 9}, Case{0.3f, 180, 10, 12, 0}, Case{0.6f, 0, 90, 30, 4}}) {
        const double eye = 70; // nothing in the world lies along an axis
        const double sun_step = 360.0 / table.sun_azimuths;
        const shared::Light light =
            light_from(heading(c.sun_elevation, eye + c.sun_azimuth * sun_step));
        const float speed = 5;
        const glm::vec3 toward = speed * heading(0, eye + c.lean_azimuth);
        const View view{c.elevation,
                        eye,
                        {toward.x, toward.z},
                        std::sqrt(std::pow(1 - c.lean, -1.5f) - 1) / speed};
        const Seen seen = look_at(patch, set.canopy_m, view, light);
        const auto sample = [&](std::size_t lean) {
            return table.samples[table.at(
                table.image(lean, index_of(table.lean_azimuths_deg, c.lean_azimuth),
                            index_of(table.elevations_deg, c.elevation)),
                index_of(table.sun_elevations_deg, c.sun_elevation),
                static_cast<std::size_t>(c.sun_azimuth))];
        };
        const FarSample found = sample(index_of(table.leans, c.lean));
        EXPECT_LT(worst_ratio(radiance_of(found, light), seen.radiance), 0.04)
            << c.lean << " " << c.elevation;
        EXPECT_NEAR(found.coverage, seen.coverage, 0.02) << c.lean << " " << c.elevation;
        bend_matters =
            std::max(bend_matters, worst_ratio(radiance_of(sample(0), light), seen.radiance));
    }
    EXPECT_GT(bend_matters, 0.05); // a table at rest would not do
}

TEST(FarLight, IsEvenWhereTheCanopyIs) {
    const FarLight& t = small_set().far_light;
    const auto count = static_cast<std::size_t>(t.sun_azimuths);
    double odd = 0;
    for (std::size_t lean = 0; lean < t.leans.size(); ++lean)
        for (std::size_t azimuth = 0; azimuth < t.lean_azimuths_deg.size(); ++azimuth)
            for (std::size_t e = 0; e < t.elevations_deg.size(); ++e)
                for (std::size_t s = 0; s < t.sun_elevations_deg.size(); ++s)
                    for (std::size_t a = 1; a < count; ++a) {
                        const std::size_t image = t.image(lean, azimuth, e);
                        const glm::vec3 one = t.samples[t.at(image, s, a)].sun,
                                        other = t.samples[t.at(image, s, count - a)].sun;
                        if (lean == 0) {
                            ASSERT_EQ(one, t.samples[t.at(t.image(0, 0, e), s, a)].sun);
                        }
                        if (lean == 0 || azimuth == 0 ||
                            azimuth + 1 == t.lean_azimuths_deg.size()) {
                            ASSERT_LT(glm::distance(one, other), 1e-6f);
                            continue;
                        }
                        odd = std::max<double>(odd, glm::distance(one, other) /
                                                        (glm::length(one) + 1e-3f));
                    }
    EXPECT_GT(odd, 0.1); // across the wind the sun's side matters
}

TEST(FarLight, AtRestItsCoverageAndHeightAreTheRows) {
    const grass::GrassSet& set = small_set();
    const FarLight& light = set.far_light;
    for (std::size_t e = 0; e < set.far.size(); ++e) {
        const FarSample& sample = light.samples[light.at(light.image(0, 2, e), 3, 5)];
        EXPECT_EQ(sample.coverage, set.far[e].coverage);
        EXPECT_EQ(sample.height, set.far[e].height);
        EXPECT_EQ(light.elevations_deg[e], set.far[e].elevation_deg);
    }
}

TEST(FarLight, SkylightDoesNotAskWhereTheSunStands) {
    shared::Light sky = light_from({0, 1, 0});
    sky.sun = {0, 0, 0};
    const auto& look = small_set().species.front().look;
    const shared::GrassPoint point{{0.1f, 0.2f, 0.05f}, heading(60, 20), 0.4f, 0.5f};
    const glm::vec3 one = shared::shade_grass(look, sky, point, heading(40, 100));
    sky.to_sun = heading(15, 200);
    EXPECT_EQ(one,
              shared::shade_grass(look, sky, point,
                                  heading(40, 100))); // else the table needs a sky for each sun
}

TEST(FarLight, IsTheSameAtAnyNumberOfThreads) {
    Preset preset = small_meadow();
    preset.density_per_m2 = 80;
    preset.variants = 2;
    const Patch patch = generate_patch(preset, 1);
    const double top = canopy_height(patch);
    const FarTable one = far_table(blade_canopy(patch, top), 4096, 1),
                   three = far_table(blade_canopy(patch, top), 4096, 3);
    ASSERT_EQ(one.light.samples.size(), three.light.samples.size());
    EXPECT_EQ(0, std::memcmp(one.light.samples.data(), three.light.samples.data(),
                             one.light.samples.size() * sizeof(FarSample)));
    for (std::size_t e = 0; e < one.rows.size(); ++e)
        EXPECT_EQ(one.rows[e].height, three.rows[e].height);
}

TEST(FarLight, RoundTripsThroughItsFileAndRefusesNonsense) {
    const FarLight& light = small_set().far_light;
    const grass::TextureArray array = grass::encode_far_light(light);
    const auto decoded = [&](const grass::TextureArray& texture, FarLight axes) {
        axes.samples.clear();
        grass::decode_far_light(grass::decode_ktx2(grass::encode_ktx2(texture, 3), "far.ktx2"),
                                "far.ktx2", axes);
        return axes.samples;
    };
    const std::vector<FarSample> back = decoded(array, light);
    ASSERT_EQ(back.size(), light.samples.size());
    EXPECT_EQ(0, std::memcmp(back.data(), light.samples.data(), back.size() * sizeof(FarSample)));

    for (const float bad : {1.5f, -0.1f}) {
        grass::TextureArray broken = array;
        std::memcpy(broken.mips[0].data() + 12, &bad, sizeof bad); // a coverage
        const auto [code, text] = error_of([&] { (void)decoded(broken, light); });
        EXPECT_EQ(code, base::ExitCode::kBadInput);
        EXPECT_NE(text.find("coverage"), std::string::npos) << text;
    }
    FarLight fewer = light;
    fewer.sun_elevations_deg.pop_back();
    EXPECT_EQ(error_of([&] { (void)decoded(array, fewer); }).first, base::ExitCode::kBadInput);
    fewer = light;
    fewer.leans.pop_back();
    EXPECT_EQ(error_of([&] { (void)decoded(array, fewer); }).first, base::ExitCode::kBadInput);
}

TEST(FarLight, ASetCarriesItAndIsRefusedWithoutIt) {
    const fs::path directory = fs::path(testing::TempDir()) / "far_light_set";
    fs::remove_all(directory);
    write_set(small_set(), small_meadow(), directory,
              {.threads = 2, .volume = false, .preview = false});
    const grass::GrassSet read = grass::read_grass_set(directory);
    const FarLight &written = small_set().far_light, &found = read.far_light;
    EXPECT_EQ(found.leans, written.leans);
    EXPECT_EQ(found.lean_azimuths_deg, written.lean_azimuths_deg);
    EXPECT_EQ(found.sun_elevations_deg, written.sun_elevations_deg);
    EXPECT_EQ(found.sun_azimuths, written.sun_azimuths);
    ASSERT_EQ(found.samples.size(), written.samples.size());
    EXPECT_EQ(0, std::memcmp(found.samples.data(), written.samples.data(),
                             found.samples.size() * sizeof(FarSample)));
    EXPECT_TRUE(fs::exists(directory / grass::kFarLightPicture));

    const std::string json = base::read_text(directory / grass::kSetJson, 1 << 20);
    const auto refused = [&](const std::string& from, const std::string& to) {
        std::string text = json;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        base::write_file_atomic(directory / grass::kSetJson, text);
        return error_of([&] { (void)grass::read_grass_set(directory); });
    };
    EXPECT_NE(refused("\"far_light\"", "\"far_lite\"").second.find("far_light"), std::string::npos);
    EXPECT_NE(refused("\"sun_azimuths\": 16", "\"sun_azimuths\": 8").second.find("far.ktx2"),
              std::string::npos);
    EXPECT_NE(refused("\"sun_azimuths\": 16", "\"sun_azimuths\": 1e9").second.find("sun_azimuths"),
              std::string::npos);
    EXPECT_NE(refused("-5.0,", "-91,").second.find("sun_elevations_deg"), std::string::npos);
    fs::remove(directory / grass::kFarLightFile);
    base::write_file_atomic(directory / grass::kSetJson, json);
    EXPECT_NE(error_of([&] { (void)grass::read_grass_set(directory); }).second.find("far.ktx2"),
              std::string::npos);
    fs::remove_all(directory);
}

// ---- what the ground wears

struct Texel {
    glm::vec4 sun, sky;
};

Texel texel_at(const std::vector<glm::vec4>& table, int row, int column) {
    using Far = shells::FarAppearance;
    const auto at = static_cast<std::size_t>(row * Far::kAzimuths + column);
    return {table[at], table[at + table.size() / 2]};
}

// Between the table's nodes, with its own noise: 2 % in the mean; 5 % at the worst, a view from 9
// degrees in a weak wind.
TEST(FarAppearance, IsDirectLightOnBladesWithinThreePercentInTheMean) {
    using Far = shells::FarAppearance;
    const grass::GrassSet& set = small_set();
    const Patch patch = small_patch();
    double largest = 0, sum = 0;
    int count = 0;
    for (const auto& [wind, sun_elevation] : {std::pair{glm::vec2(2.5f, -3.0f), 37.0},
                                              {glm::vec2(-7, 4), 52.0},
                                              {glm::vec2(0), 16.0}}) {
        const double sun_azimuth = 115;
        const shared::Light light = light_from(heading(sun_elevation, sun_azimuth));
        const std::vector<glm::vec4> table =
            shells::canopy_table(set.far_light, light, {wind, 0, 0.1f});
        ASSERT_EQ(table.size(), 2u * Far::kAzimuths * Far::kElevations);
        for (const auto& [row, column] : {std::pair{5, 3}, {9, 20}, {14, 11}, {19, 30}}) {
            const double elevation = std::asin(row / (Far::kElevations - 1.0)) / kDegree;
            const View view{elevation, sun_azimuth - 360.0 * column / Far::kAzimuths, wind, 0.1f};
            const Seen seen = look_at(patch, set.canopy_m, view, light);
            const Texel texel = texel_at(table, row, column);
            const double error =
                worst_ratio(glm::dvec3(texel.sun) + glm::dvec3(texel.sky), seen.radiance);
            largest = std::max(largest, error);
            sum += error;
            ++count;
            EXPECT_LT(error, 0.06) << "wind " << wind.x << " row " << row << " column " << column;
            EXPECT_NEAR(texel.sun.a, seen.coverage, 0.03)
                << "wind " << wind.x << " row " << row << " column " << column;
        }
    }
    EXPECT_LT(sum / count, 0.03);
    RecordProperty("largest_error", std::to_string(largest));
    RecordProperty("mean_error", std::to_string(sum / count));
}

TEST(FarAppearance, IsLinearInTheColoursOfSunAndSky) {
    const FarLight& table = small_set().far_light;
    shared::Light light = light_from(heading(33, 50));
    const glm::vec4 wind(3, 1, 0.4f, 0.1f);
    const std::vector<glm::vec4> one = shells::canopy_table(table, light, wind);
    light.sun *= glm::vec3(2, 0, 0.5f);
    light.zenith *= 3;
    light.horizon *= 3;
    const std::vector<glm::vec4> other = shells::canopy_table(table, light, wind);
    for (std::size_t i = 0; i < one.size(); ++i) {
        const glm::vec4 factor =
            i < one.size() / 2 ? glm::vec4(2, 0, 0.5f, 1) : glm::vec4(3, 3, 3, 1);
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(other[i][c], factor[c] * one[i][c], 1e-5f * one[i][c]) << i;
    }
}

TEST(FarAppearance, IsDarkWithoutASunAndUsableForEveryWind) {
    const FarLight& table = small_set().far_light;
    for (const float speed : {0.0f, 1.0f, 8.0f, 200.0f})
        for (const double elevation : {-30.0, -4.0, 0.5, 25.0, 90.0}) {
            const auto texels = shells::canopy_table(table, light_from(heading(elevation, 10)),
                                                     {speed, -speed, 0, 0.1f});
            for (std::size_t i = 0; i < texels.size(); ++i)
                for (int c = 0; c < 4; ++c) {
                    ASSERT_TRUE(std::isfinite(texels[i][c]) && texels[i][c] >= 0)
                        << speed << " " << elevation;
                    if (elevation == -30 && i < texels.size() / 2 && c < 3) {
                        ASSERT_EQ(texels[i][c], 0);
                    }
                }
        }
}

// ---- workers

TEST(Parallel, EveryTaskRunsOnceByOneWorkerAtATime) {
    for (const int threads : {1, 2, 5}) {
        std::vector<std::atomic<int>> done(300);
        std::vector<std::atomic<int>> busy(static_cast<std::size_t>(threads));
        std::atomic<bool> clash = false;
        parallel_for(done.size(), threads, [&](std::size_t task, int worker) {
            ASSERT_TRUE(worker >= 0 && worker < threads);
            clash = clash || busy[static_cast<std::size_t>(worker)]++ != 0;
            parallel_for(3, 2, [&](std::size_t, int) { ++done[task]; }); // within one another
            --busy[static_cast<std::size_t>(worker)];
        });
        for (const auto& count : done)
            EXPECT_EQ(count, 3);
        EXPECT_FALSE(clash);
    }
    parallel_for(0, 4, [](std::size_t, int) { FAIL(); });
}

TEST(Parallel, TheFirstErrorEndsItAndKeepsItsKind) {
    std::atomic<int> begun = 0;
    const auto [code, text] = error_of([&] {
        parallel_for(100000, 2, [&](std::size_t task, int) {
            ++begun;
            if (task == 10)
                throw base::Error(base::ExitCode::kIo, "full");
        });
    });
    EXPECT_EQ(code, base::ExitCode::kIo);
    EXPECT_EQ(text, "full");
    EXPECT_LT(begun, 100000);
}

} // namespace
} // namespace sward::texgen
