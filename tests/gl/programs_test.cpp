// SPDX-License-Identifier: Apache-2.0
// Shaders: every variant builds, what the driver reflects is what the shared headers say, errors
// name file and line.
#include <cstddef>
#include <map>
#include <set>

#include "base/error.h"
#include "gl/fixture.h"
#include "render/draw_passes.h"
#include "terrain/terrain_pass.h"

namespace sward::tests {
namespace {

namespace fs = std::filesystem;

struct Variant {
    std::vector<fs::path> stages;
    std::vector<std::string> defines;
};

std::vector<Variant> variants() {
    std::vector<Variant> all = {
        {{"terrain/clipmap_height.comp"}, {}},
        {{"terrain/clipmap_surface.comp"}, {}},
        {{"terrain/block_samples.comp"}, {}},
        {{"terrain/block_samples.comp"}, {"FINE_GROUND"}},
        {{"terrain/terrain.vert", "terrain/terrain.frag"}, {"FINE_GROUND", "AOV"}},
        {{"shells/march.vert", "shells/march_choose.frag"}, {"FINE_GROUND"}},
        {{"shells/march.vert", "shells/march.frag"}, {"FINE_GROUND", "CREST"}},
        {{"blades/cull.comp"}, {}},
        {{"blades/choose.comp"}, {}},
        {{"blades/gather.comp"}, {}},
        {{"blades/sift.comp"}, {}},
        {{"blades/depth_pyramid.comp"}, {}},
        {{"blades/depth_pyramid.comp"}, {"FIRST"}},
        {{"blades/depth_pyramid.comp"}, {"FIRST", "MULTISAMPLED"}},
        {{"blades/wake.comp"}, {}},
        {{"blades/physics.comp"}, {"PHYSICS_FREE"}},
        {{"blades/physics.comp"}, {"PHYSICS_COLLIDING"}},
        {{"blades/physics.comp"}, {"PHYSICS_NEW"}},
        {{"blades/physics.comp"}, {"PHYSICS_ALL"}},
        {{"blades/physics.comp"}, {"SURFACE", "PHYSICS_FREE"}},
        {{"blades/physics.comp"}, {"SURFACE", "PHYSICS_COLLIDING"}},
        {{"blades/physics.comp"}, {"SURFACE", "PHYSICS_NEW"}},
        {{"blades/physics.comp"}, {"SURFACE", "PHYSICS_ALL"}},
        {{"blades/wake.comp"}, {"SURFACE"}},
        {{"tracks/change.comp"}, {}},
        {{"tracks/advance.comp"}, {}},
        {{"tracks/advance.comp"}, {"PRESS_ONLY"}},
        {{"tracks/rebase.comp"}, {}},
        {{"tracks/show.comp"}, {}},
        {{"render/screen.vert", "render/tone_map.frag"}, {}},
        {{"render/screen.vert", "render/hand_out.frag"}, {}}};
    const std::vector<std::vector<fs::path>> with_aov = {
        {"terrain/terrain.vert", "terrain/terrain.frag"},
        {"blades/blade.vert", "blades/blade.tesc", "blades/blade.tese", "blades/blade.frag"},
        {"shells/far.vert", "shells/far.frag"},
        {"render/mesh.vert", "render/mesh.frag"},
        {"render/screen.vert", "render/sky.frag"},
        {"render/screen.vert", "render/host_scene.frag"},
        {"render/screen.vert", "render/resolve.frag"}};
    for (const auto& stages : with_aov) {
        all.push_back({stages, {}});
        all.push_back({stages, {"AOV"}});
    }
    const std::vector<fs::path> surface = {"blades/surface_blade.vert", "blades/blade.tesc",
                                           "blades/blade.tese", "blades/blade.frag"};
    all.push_back({surface, {"SURFACE"}});
    all.push_back({surface, {"SURFACE", "AOV"}});
    all.push_back({{"blades/cull.comp"}, {"SURFACE"}});
    // What a grid is, open or periodic, decides about the passes that run over both.
    for (const char* pass :
         {"advect", "divergence", "poisson_begin", "poisson_direction", "poisson_dots",
          "poisson_guess", "poisson_relax", "poisson_restrict", "poisson_solve", "poisson_update",
          "poisson_weights", "project", "publish", "vorticity"}) {
        all.push_back({{std::string("wind/") + pass + ".comp"}, {}});
        all.push_back({{std::string("wind/") + pass + ".comp"}, {"PERIODIC"}});
    }
    all.push_back({{"wind/advect.comp"}, {"CONFINEMENT"}});
    all.push_back({{"wind/advect.comp"}, {"PERIODIC", "CONFINEMENT"}});
    all.push_back({{"wind/poisson_relax.comp"}, {"CORRECT"}});
    all.push_back({{"wind/poisson_relax.comp"}, {"PERIODIC", "CORRECT"}});
    for (const char* pass :
         {"enter", "poisson_scalars", "solids", "forces", "published_advect", "published_confine",
          "published_divergence", "published_jacobi", "published_project"}) {
        all.push_back({{std::string("wind/") + pass + ".comp"}, {}});
    }
    all.push_back({{"shells/canopy.vert", "shells/canopy.frag"}, {}});
    all.push_back({{"shells/canopy.vert"}, {}});
    all.push_back({{"shells/march.vert", "shells/march_choose.frag"}, {}});
    all.push_back({{"shells/surface_canopy.vert", "shells/surface_canopy.frag"}, {}});
    all.push_back({{"shells/march.vert", "shells/march_choose.frag"}, {"SURFACE"}});
    for (const char* kind : {"COLUMNS", "SLABS"}) {
        for (const char* rays : {"CREST", "PLAIN"}) {
            all.push_back({{"shells/march.vert", "shells/march.frag"}, {kind, rays}});
            all.push_back(
                {{"shells/march.vert", "shells/march.frag"}, {kind, rays, "AOV", "NO_LAND"}});
            all.push_back({{"shells/march.vert", "shells/march.frag"}, {kind, rays, "SURFACE"}});
            all.push_back(
                {{"shells/march.vert", "shells/march.frag"}, {kind, rays, "SURFACE", "AOV"}});
        }
    }
    all.push_back({{"wind/forces.comp"}, {"INFLOW"}});
    all.push_back({{"wind/ambient_totals.comp"}, {"PERIODIC"}});
    all.push_back({{"wind/ambient_force.comp"}, {"PERIODIC"}});
    all.push_back({{"shells/far.vert", "shells/far.frag"}, {"SLICES"}});
    all.push_back({{"shells/far.vert", "shells/far.frag"}, {"SLICES", "AOV"}});
    all.push_back({{"shells/far.vert", "shells/far.frag"}, {"BLOCK_SHAPES"}});
    all.push_back({{"shells/far.vert", "shells/far.frag"}, {"SLICES", "AOV", "BLOCK_SHAPES"}});
    return all;
}

gl::Program build(const Variant& variant) {
    return {variant.stages.back().string(), variant.stages, variant.defines};
}

std::string resource_name(GLuint program, GLenum interface, GLuint index) {
    char name[256];
    glGetProgramResourceName(program, interface, index, sizeof(name), nullptr, name);
    return name;
}

GLint resource_value(GLuint program, GLenum interface, GLuint index, GLenum what) {
    GLint value = -1;
    glGetProgramResourceiv(program, interface, index, 1, &what, 1, nullptr, &value);
    return value;
}

GLint resource_count(GLuint program, GLenum interface) {
    GLint count = 0;
    glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
    return count;
}

class Programs : public GlTest {};

TEST_F(Programs, PassesBuildInBothVariants) {
    for (const bool aov : {false, true})
        for (const bool block_shapes : {false, true})
            const render::DrawPasses passes(aov, block_shapes, block_shapes, !block_shapes);
    const blades::CullPass cull;
    const terrain::BlockSamples samples;
}

TEST_F(Programs, TheVariantsHoldEveryEntryPoint) {
    std::set<fs::path> known;
    for (const Variant& variant : variants()) {
        known.insert(variant.stages.begin(), variant.stages.end());
    }
    const fs::path root = fs::path(SWARD_SOURCE_DIR) / "shaders";
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        const std::string extension = entry.path().extension().string();
        const bool hidden = entry.path().filename().string().starts_with('.');
        if (entry.is_regular_file() && !hidden && extension != ".h" && extension != ".glsl") {
            EXPECT_TRUE(known.count(fs::relative(entry.path(), root)))
                << entry.path() << ": add it to the variants above";
        }
    }
}

TEST_F(Programs, BlocksAreBoundByTheirNames) {
    const std::map<std::string, GLint> uniform_blocks = {
        {"FrameBlock", BIND_FRAME},        {"SurfaceBlock", BIND_SURFACE},
        {"WindGridBlock", BIND_WIND_GRID}, {"WindFieldBlock", BIND_WIND_FIELD},
        {"PhysicsBlock", BIND_PHYSICS},    {"SampleBlock", BIND_SAMPLES},
        {"MarchBlock", BIND_MARCH},        {"SharesBlock", BIND_FAR_SHARES}};
    // The wind's passes run before all others and share their binding points among themselves.
    const std::map<std::string, GLint> storage_blocks = {
        {"WindU", BIND_WIND_U},
        {"WindV", BIND_WIND_V},
        {"WindSolid", BIND_WIND_SOLID},
        {"WindSolidVelocity", BIND_WIND_SOLID_VELOCITY},
        {"WindUNext", BIND_WIND_U_NEXT},
        {"WindVNext", BIND_WIND_V_NEXT},
        {"WindUCarried", BIND_WIND_U_CARRIED},
        {"WindVCarried", BIND_WIND_V_CARRIED},
        {"WindVEntering", BIND_WIND_V_ENTERING},
        {"WindLastPressure", BIND_WIND_LAST_PRESSURE},
        {"WindPressure", BIND_WIND_PRESSURE},
        {"WindNextPressure", BIND_WIND_NEXT_PRESSURE},
        {"WindEarlierPressure", BIND_WIND_EARLIER_PRESSURE},
        {"WindPhi", BIND_WIND_PHI},
        {"WindRhs", BIND_WIND_RHS},
        {"WindWeights", BIND_WIND_WEIGHTS},
        {"WindVorticity", BIND_WIND_VORTICITY},
        {"WindCells", BIND_WIND_CELLS},
        {"WindInflow", BIND_WIND_DRAWN_INFLOW},
        {"WindDirection", BIND_WIND_DIRECTION},
        {"WindNextDirection", BIND_WIND_NEXT_DIRECTION},
        {"WindProduct", BIND_WIND_PRODUCT},
        {"WindPartials", BIND_WIND_PARTIALS},
        {"WindScalars", BIND_WIND_SCALARS},
        {"WindTarget", BIND_WIND_TARGET},
        {"WindTotals", BIND_WIND_TOTALS},
        {"U", BIND_WIND_U},
        {"V", BIND_WIND_V},
        {"Solid", BIND_WIND_SOLID},
        {"SolidVelocity", BIND_WIND_SOLID_VELOCITY},
        {"Solids", BIND_WIND_SOLIDS},
        {"Forces", BIND_WIND_FORCES},
        {"WindTiles", BIND_WIND_TILES},
        {"TileItems", BIND_WIND_TILE_ITEMS},
        {"Footprints", BIND_WIND_FOOTPRINTS},
        {"Inflow", BIND_WIND_INFLOW},

        {"TrackBends", BIND_TRACK_BENDS},
        {"TrackChanges", BIND_TRACK_CHANGES},
        {"TrackTable", BIND_TRACK_TABLE},
        {"TrackWork", BIND_TRACK_WORK},
        {"TrackPrints", BIND_TRACK_PRINTS},
        {"TrackShown", BIND_TRACK_SHOWN},
        {"TrackMaps", BIND_TRACK_MAPS},

        {"Records", BIND_PHYSICS_BLADES},
        {"Pages", BIND_PHYSICS_PAGES},
        {"States", BIND_PHYSICS_STATES},
        {"Patches", BIND_PHYSICS_PATCHES},
        {"Awake", BIND_PHYSICS_AWAKE},
        {"Dispatch", BIND_PHYSICS_DISPATCH},
        {"Lists", BIND_PHYSICS_LISTS},
        {"Spheres", BIND_PHYSICS_SPHERES},
        {"Places", BIND_BLADE_PLACES},
        {"Slots", BIND_BLADE_PLACES},

        {"Blades", BIND_BLADES},
        {"SurfaceBlades", BIND_BLADES},
        {"Tiles", BIND_BLADE_TILES},
        {"Items", BIND_CULL_ITEMS},
        {"Survivors", BIND_SURVIVORS},
        {"Commands", BIND_DRAW_COMMANDS},
        {"Totals", BIND_CULL_TOTAL},
        {"ChoiceItems", BIND_CHOICE_ITEMS},
        {"ChoiceMasks", BIND_CHOICE_MASKS},
        {"ChoiceTotals", BIND_CHOICE_TOTAL},
        {"GatherMasks", BIND_GATHER_MASKS},
        {"Blocks", BIND_TERRAIN_BLOCKS},
        {"Instances", BIND_FAR_INSTANCES},
        {"Samples", BIND_BLOCK_SAMPLES}};
    std::set<std::string> seen;
    for (const Variant& variant : variants()) {
        const gl::Program program = build(variant);
        for (const auto& [interface, names] : {std::pair{GLenum{GL_UNIFORM_BLOCK}, uniform_blocks},
                                               {GLenum{GL_SHADER_STORAGE_BLOCK}, storage_blocks}}) {
            for (GLint i = 0; i < resource_count(program.id(), interface); ++i) {
                const auto at = static_cast<GLuint>(i);
                const std::string name = resource_name(program.id(), interface, at);
                ASSERT_TRUE(names.count(name)) << name << " in " << program.name();
                EXPECT_EQ(resource_value(program.id(), interface, at, GL_BUFFER_BINDING),
                          names.at(name))
                    << name;
                seen.insert(name);
            }
        }
    }
    EXPECT_EQ(seen.size(),
              uniform_blocks.size() + storage_blocks.size()); // no name of the table is out of date
}

TEST_F(Programs, SamplersReadTheUnitsOfTheirNames) {
    const std::map<std::string, GLint> units = {{"clip_height", TEX_CLIP_HEIGHT},
                                                {"clip_surface", TEX_CLIP_SURFACE},
                                                {"heights", TEX_CLIP_HEIGHT},
                                                {"far_images", TEX_FAR_IMAGES},
                                                {"record_texels", TEX_PHYSICS_BLADES},
                                                {"far_shapes", TEX_FAR_SHAPES},
                                                {"densities", TEX_MARCH_DENSITY},
                                                {"fibres", TEX_MARCH_FIBRES},
                                                {"correction", TEX_MARCH_CORRECTION},
                                                {"canopy_depth", TEX_CANOPY_DEPTH},
                                                {"canopy_samples", TEX_CANOPY_SAMPLES},
                                                {"canopy_ground", TEX_CANOPY_GROUND},
                                                {"canopy_air", TEX_CANOPY_AIR},
                                                {"canopy_exits", TEX_CANOPY_EXIT},
                                                {"second_depth", TEX_SECOND_DEPTH},
                                                {"second_ground", TEX_SECOND_GROUND},
                                                {"second_air", TEX_SECOND_AIR},
                                                {"far_appearance", TEX_FAR_APPEARANCE},
                                                {"light_factors", TEX_MARCH_LIGHT},
                                                {"elevation", TEX_ELEVATION},
                                                {"mask", TEX_MASK},
                                                {"land_cover", TEX_LAND_COVER},
                                                {"land_ground", TEX_LAND_GROUND},
                                                {"land_shadow", TEX_LAND_SHADOW},
                                                {"depth_pyramid", TEX_DEPTH_PYRAMID},
                                                {"levels", TEX_DEPTH_PYRAMID},
                                                {"depth", TEX_RESOLVE_DEPTH},
                                                {"track_bends", TEX_TRACK_BENDS},
                                                {"track_shown", TEX_TRACK_SHOWN},
                                                {"track_table", TEX_TRACK_TABLE},
                                                {"wind_ambient", TEX_WIND_AMBIENT},
                                                {"wind_local", TEX_WIND_LOCAL},
                                                {"scene_color", TEX_RESOLVE_COLOR},
                                                {"scene_data", TEX_RESOLVE_DATA},
                                                {"scene_tangent", TEX_RESOLVE_TANGENT},
                                                {"scene_normal", TEX_RESOLVE_NORMAL},
                                                {"scene_depth", TEX_RESOLVE_DEPTH},
                                                {"host_color", TEX_RESOLVE_COLOR},
                                                {"host_scene_depth", TEX_RESOLVE_DEPTH},
                                                {"resolved_color", TEX_RESOLVE_COLOR},
                                                {"resolved_data", TEX_RESOLVE_DATA}};
    const std::set<GLint> samplers = {
        GL_SAMPLER_2D,     GL_SAMPLER_2D_ARRAY,   GL_SAMPLER_2D_MULTISAMPLE,
        GL_SAMPLER_BUFFER, GL_INT_SAMPLER_BUFFER, GL_UNSIGNED_INT_SAMPLER_BUFFER};
    std::set<std::string> seen;
    for (const Variant& variant : variants()) {
        const gl::Program program = build(variant);
        for (GLint i = 0; i < resource_count(program.id(), GL_UNIFORM); ++i) {
            const auto index = static_cast<GLuint>(i);
            const std::string name = resource_name(program.id(), GL_UNIFORM, index);
            if (!samplers.count(resource_value(program.id(), GL_UNIFORM, index, GL_TYPE))) {
                continue;
            }
            ASSERT_TRUE(units.count(name)) << name << " in " << program.name();
            GLint unit = -1;
            glGetUniformiv(program.id(),
                           resource_value(program.id(), GL_UNIFORM, index, GL_LOCATION), &unit);
            EXPECT_EQ(unit, units.at(name)) << name << " in " << program.name();
            seen.insert(name);
        }
    }
    EXPECT_EQ(seen.size(), units.size());
}

TEST_F(Programs, WorkgroupsAndOutputsAreTheHeadersOnes) {
    const std::map<std::string, glm::ivec3> groups = {
        {"terrain/clipmap_height.comp", {CLIP_GROUP, CLIP_GROUP, 1}},
        {"terrain/clipmap_surface.comp", {CLIP_GROUP, CLIP_GROUP, 1}},
        {"terrain/block_samples.comp", {SAMPLE_GROUP, 1, 1}},
        {"blades/depth_pyramid.comp", {PYRAMID_GROUP, PYRAMID_GROUP, 1}},
        {"blades/cull.comp", {CULL_GROUP, 1, 1}},
        {"blades/choose.comp", {CULL_GROUP, 1, 1}},
        {"blades/gather.comp", {GATHER_GROUP, 1, 1}},
        {"blades/sift.comp", {CULL_GROUP, 1, 1}},
        {"blades/wake.comp", {WAKE_GROUP, 1, 1}},
        {"tracks/change.comp", {TRACK_GROUP, TRACK_GROUP, 1}},
        {"tracks/advance.comp", {TRACK_GROUP, TRACK_GROUP, 1}},
        {"tracks/rebase.comp", {TRACK_GROUP, TRACK_GROUP, 1}},
        {"tracks/show.comp", {TRACK_GROUP, TRACK_GROUP, 1}},
        {"blades/physics.comp", {CULL_GROUP, 1, 1}}};
    for (const Variant& variant : variants()) {
        const gl::Program program = build(variant);
        if (variant.stages[0].extension() == ".comp") {
            glm::ivec3 size(0);
            glGetProgramiv(program.id(), GL_COMPUTE_WORK_GROUP_SIZE, &size.x);
            const std::string& name = program.name();
            if (name.starts_with(
                    "wind/")) { // one thread a cell, a tile's cell, or a share of one level
                const bool tile = name == "wind/forces.comp" || name == "wind/solids.comp";
                const bool alone = name == "wind/poisson_solve.comp" ||
                                   name == "wind/poisson_scalars.comp" ||
                                   name == "wind/ambient_totals.comp";
                EXPECT_EQ(size, tile    ? glm::ivec3(WIND_TILE, WIND_TILE, 1)
                                : alone ? glm::ivec3(WIND_SOLVE_GROUP, 1, 1)
                                        : glm::ivec3(WIND_GROUP_X, WIND_GROUP_Y, 1))
                    << name;
                continue;
            }
            EXPECT_EQ(size, groups.at(program.name())) << program.name();
            continue;
        }
        if (program.name().find("canopy.") != std::string::npos ||
            program.name() == "shells/march_choose.frag") {
            continue; // what they draw is for the march, not a picture
        }
        EXPECT_EQ(glGetFragDataLocation(program.id(), "out_color"), OUT_COLOR) << program.name();
        const bool aov = !variant.defines.empty() && variant.defines.back() == "AOV";
        for (const auto& [name, location] : {std::pair{"out_data", OUT_DATA},
                                             {"out_tangent", OUT_TANGENT},
                                             {"out_normal", OUT_NORMAL}}) {
            const GLint found = glGetFragDataLocation(program.id(), name);
            EXPECT_TRUE(found == location || found == -1) << name << " in " << program.name();
            EXPECT_TRUE(!aov || found == location) << name << " in " << program.name();
        }
    }
}

TEST_F(Programs, RecordsHaveTheStrideThatCppHas) {
    const std::map<std::string, std::size_t> strides = {
        {"blades[0].root", sizeof(shared::BladeRecord)},
        {"tiles[0].corner", sizeof(shared::BladeTile)},
        {"items[0]", sizeof(glm::uvec2)},
        {"survivors[0]", sizeof(glm::uvec2)},
        {"commands[0].vertices", sizeof(shared::DrawCommand)},
        {"blocks[0].corner", sizeof(shared::TerrainBlock)},
        {"instances[0].place_m", sizeof(shared::FarInstance)},
        {"samples[0].height_m", sizeof(shared::BlockSample)}};
    std::set<std::string> seen;
    for (const Variant& variant : variants()) {
        const gl::Program program = build(variant);
        for (const auto& [name, bytes] : strides) {
            const GLuint index =
                glGetProgramResourceIndex(program.id(), GL_BUFFER_VARIABLE, name.c_str());
            if (index != GL_INVALID_INDEX) {
                seen.insert(name);
                const GLenum what = name.find('.') == std::string::npos ? GL_ARRAY_STRIDE
                                                                        : GL_TOP_LEVEL_ARRAY_STRIDE;
                EXPECT_EQ(static_cast<std::size_t>(
                              resource_value(program.id(), GL_BUFFER_VARIABLE, index, what)),
                          bytes)
                    << name;
            }
        }
    }
    EXPECT_EQ(seen.size(), strides.size());
}

// ---- errors and reload

template<class Act> std::string error_of(const Act& act) {
    try {
        act();
    } catch (const base::Error& error) {
        EXPECT_EQ(error.code(), base::ExitCode::kNoGpu) << error.what();
        return error.what();
    }
    return "no error";
}

class ShaderErrors : public GlTest {
protected:
    void TearDown() override {
        forgive_messages(); // drivers may report what we broke
        GlTest::TearDown();
    }
    static gl::Program tone_map() {
        return {"tone map", {"render/screen.vert", "render/tone_map.frag"}};
    }
    static void expect_contains(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks " << part;
        EXPECT_EQ(text.find('\n'), std::string::npos) << "more than one line: " << text;
    }
    ShaderCopy shaders_;
};

TEST_F(ShaderErrors, NameFileAndLineOfTheSource) {
    const int line = shaders_.append("render/tone_map.frag", "float wrong = nowhere;\n");
    expect_contains(error_of([] { tone_map(); }), "render/tone_map.frag:" + std::to_string(line));
}

TEST_F(ShaderErrors, NameTheIncludedFile) {
    shaders_.write("shared/tone.h", "#define SHARED_TONE\n\nvec3 tone_map(vec3 c) { return c; "
                                    "}\nvec3 srgb_encode(vec3 c) { return c * oops; }\n");
    expect_contains(error_of([] { tone_map(); }), "shared/tone.h:4");
}

TEST_F(ShaderErrors, LinesAfterAnIncludeAreCountedOn) {
    const int line = shaders_.append("blades/cull.comp", "\n\nint wrong() { return 1.5; }\n");
    expect_contains(error_of([] { gl::Program("cull", {"blades/cull.comp"}); }),
                    "blades/cull.comp:" + std::to_string(line + 2));
}

TEST_F(ShaderErrors, NameTheLineOfAMissingInclude) {
    shaders_.write(
        "render/tone_map.frag",
        "// one\n#include \"shared/tone.h\"\n  #  include \"lib/none.glsl\"\nvoid main() {}\n");
    const std::string error = error_of([] { tone_map(); });
    expect_contains(error, "render/tone_map.frag:3");
    expect_contains(error, "none.glsl");
}

TEST_F(ShaderErrors, AUniformThatNoSourceDeclaresIsNamed) {
    shaders_.write("uniforms.comp", "layout(local_size_x = 1) in;\n// uniform float "
                                    "remark;\nuniform float weights[2], left_out;\n#ifdef NEVER\n"
                                    "uniform int variant_only;\n#endif\nlayout(std430, binding = "
                                    "0) buffer Out { float result; };\n"
                                    "void main() { float local = weights[0]; result = local; }\n");
    const gl::Program program("weigher", {"uniforms.comp"});
    EXPECT_EQ(error_of([&] { program.set("left_out", 1.0f); }), "no error");
    EXPECT_EQ(error_of([&] { program.set("variant_only", 1); }), "no error");
    EXPECT_EQ(error_of([&] { program.set("weights[0]", 0.5f); }), "no error");
    for (const char* wrong : {"remark", "local", "wieghts"}) {
        const std::string error = error_of([&] { program.set(wrong, 1.0f); });
        expect_contains(error, "weigher");
        expect_contains(error, wrong);
    }
    float weight = 0;
    glGetUniformfv(program.id(), glGetUniformLocation(program.id(), "weights[0]"), &weight);
    EXPECT_EQ(weight, 0.5f);
}

TEST_F(ShaderErrors, MissingFileAndUnknownStage) {
    expect_contains(error_of([] { gl::Program("none", {"render/none.comp"}); }),
                    "render/none.comp");
    shaders_.write("render/odd.txt", "void main() {}\n");
    expect_contains(error_of([] { gl::Program("odd", {"render/odd.txt"}); }), "render/odd.txt");
}

TEST_F(ShaderErrors, LinkFailuresNameTheProgramsFirstStage) {
    shaders_.write("render/tone_map.frag", "in vec4 never_written;\nlayout(location = 0) out vec4 "
                                           "c;\nvoid main() { c = never_written; }\n");
    expect_contains(error_of([] { tone_map(); }), "render/screen.vert");
}

TEST_F(ShaderErrors, IncludesInCyclesEnd) {
    shaders_.write("lib/one.glsl", "#include \"lib/two.glsl\"\n");
    shaders_.write("lib/two.glsl", "#include \"lib/one.glsl\"\nfloat two() { return 2.0; }\n");
    shaders_.write(
        "cycle.comp",
        "#include \"lib/one.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() { two(); }\n");
    EXPECT_EQ(error_of([] { gl::Program("cycle", {"cycle.comp"}); }), "no error");
}

TEST_F(ShaderErrors, ReloadKeepsTheOldProgramUntilTheNewOneBuilds) {
    gl::Program program = tone_map();
    const GLuint old = program.id();
    shaders_.append("render/tone_map.frag", "broken\n");
    expect_contains(error_of([&] { program.reload(); }), "render/tone_map.frag");
    EXPECT_EQ(program.id(), old);
    EXPECT_TRUE(glIsProgram(old));
    program.use();
    shaders_.restore("render/tone_map.frag");
    program.reload();
    GLint linked = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
    EXPECT_TRUE(linked);
}

} // namespace
} // namespace sward::tests
