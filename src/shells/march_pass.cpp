// SPDX-License-Identifier: Apache-2.0
#include "shells/march_pass.h"

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::shells {

void CanopyTargets::require(int width, int height, int samples) {
    const gl::TextureShape& now = depth_.shape();
    if (depth_.id() && now.width == width && now.height == height &&
        sample_depth_.shape().samples == samples) {
        return;
    }
    surface_ = gl::Framebuffer();
    samples_ = gl::Framebuffer();
    depth_ = gl::Texture(GL_DEPTH_COMPONENT32F, {width, height});
    ground_ = gl::Texture(GL_RGBA16F, {width, height});
    air_ = gl::Texture(GL_RGBA16F, {width, height});
    surface_ = gl::Framebuffer({&ground_, &air_}, &depth_);
    if (samples > 0) {
        sample_depth_ = gl::Texture(GL_DEPTH_COMPONENT32F, {width, height, 0, 1, samples});
        samples_ = gl::Framebuffer({}, &sample_depth_);
        find_places(samples);
    }
}

void CanopyTargets::find_places(int samples) {
    samples_.bind(depth_.shape().width, depth_.shape().height);
    for (int i = 0; i < 4; ++i) {
        float at[2] = {0.5f, 0.5f};
        if (samples > 1) {
            glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i * samples / 4), at);
        }
        places_[0][i] = at[0];
        places_[1][i] = at[1];
    }
}

void CanopyTargets::bind_textures(std::uint32_t first) const {
    depth_.bind(first);
    ground_.bind(first + TEX_CANOPY_GROUND - TEX_CANOPY_DEPTH);
    air_.bind(first + TEX_CANOPY_AIR - TEX_CANOPY_DEPTH);
    if (sample_depth_.id()) {
        sample_depth_.bind(TEX_CANOPY_SAMPLES);
    }
}

void SurfaceTargets::require(int width, int height) {
    for (CanopyTargets* targets : {&first, &exit, &second}) {
        targets->require(width, height);
    }
}

void SurfaceTargets::bind_textures() const {
    second.bind_textures(TEX_SECOND_DEPTH);
    exit.ground().bind(TEX_CANOPY_EXIT);
}

namespace {

gl::Program marcher(const char* name, std::vector<std::string> defines) {
    return {name, {"shells/march.vert", "shells/march.frag"}, std::move(defines)};
}

std::vector<std::filesystem::path> canopy_stages(bool surface) {
    return surface ? std::vector<std::filesystem::path>{"shells/surface_canopy.vert",
                                                        "shells/surface_canopy.frag"}
                   : std::vector<std::filesystem::path>{"shells/canopy.vert", "shells/canopy.frag"};
}

void clear_depth(const CanopyTargets& targets) {
    constexpr float kFar[4] = {0, 0, 0, 0};
    targets.bind_for_drawing();
    glClearBufferfv(GL_DEPTH, 0, kFar);
}

} // namespace

std::vector<std::string> MarchPass::Variant::with(std::vector<std::string> defines) const {
    if (fine) {
        defines.emplace_back("FINE_GROUND");
    }
    if (aov) {
        defines.emplace_back("AOV");
    }
    if (surface) {
        defines.emplace_back("SURFACE");
    }
    if (!land) {
        defines.emplace_back("NO_LAND");
    }
    if (count) {
        defines.emplace_back("COUNT");
    }
    return defines;
}

MarchPass::Kinds::Kinds(const Variant& variant)
    : columns(marcher("columns", variant.with({"COLUMNS"}))),
      slabs(marcher("slabs", variant.with({}))),
      crests(marcher("march at crests", variant.with({"CREST"}))) {}

void MarchPass::Kinds::reload() {
    for (gl::Program* program : {&columns, &slabs, &crests}) {
        program->reload();
    }
}

MarchPass::MarchPass(bool aov, bool surface, bool land)
    : canopy_("canopy", canopy_stages(surface)),
      canopy_samples_("canopy's samples", {"shells/canopy.vert"}),
      choose_("march's kinds", {"shells/march.vert", "shells/march_choose.frag"},
              Variant{false, surface, land, false, false}.with({})),
      kinds_({aov, surface, land, false, false}), aov_(aov), surface_(surface), land_(land),
      counts_(2 * sizeof(std::uint32_t)) {
    glCreateVertexArrays(1, &vertex_array_);
    glCreateQueries(GL_SAMPLES_PASSED, static_cast<GLsizei>(queries_.size()), queries_.data());
}

MarchPass::~MarchPass() {
    glDeleteVertexArrays(1, &vertex_array_);
    glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

glm::uvec2 MarchPass::pixels() const {
    glm::uvec2 passed(0);
    for (int i = 0; i < 2; ++i) {
        glGetQueryObjectuiv(queries_[static_cast<std::size_t>(i)], GL_QUERY_RESULT, &passed[i]);
    }
    return passed;
}

glm::uvec2 MarchPass::work() const {
    const std::vector<std::uint32_t> counts = counts_.read_all<std::uint32_t>(2);
    return {counts[0], counts[1]};
}

void MarchPass::draw_canopy(const CanopyTargets& targets, int blocks,
                            const terrain::BlockMesh& mesh) {
    targets.bind_for_drawing();
    constexpr float kFar[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_DEPTH, 0, kFar);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    canopy_.use();
    mesh.draw(blocks);
    targets.bind_samples_for_drawing();
    glClearBufferfv(GL_DEPTH, 0, kFar);
    canopy_samples_.use();
    mesh.draw(blocks);
    glDisable(GL_CULL_FACE);
}

void MarchPass::draw_surface(const SurfaceTargets& targets, const SurfaceCanopy& mesh,
                             glm::vec3 origin, float apart_m) {
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    canopy_.use();
    canopy_.set("surface_origin", glm::vec4(origin, 0));
    canopy_.set("lift", 1.0f);
    const auto enter = [&](const CanopyTargets& into, float behind) {
        clear_depth(into);
        canopy_.set("behind", behind);
        mesh.draw();
    };
    // Through the top or a wall, from within, or to the ground: what is nearest. First and second
    // share a target.
    const auto leave = [&](const CanopyTargets& from, bool second) {
        from.depth().bind(TEX_CANOPY_DEPTH);
        clear_depth(targets.exit);
        if (second) {
            from.bind_textures(TEX_SECOND_DEPTH);
            glColorMask(GL_FALSE, GL_FALSE, GL_TRUE, GL_TRUE);
        }
        canopy_.set("behind", second ? -2.0f : -1.0f);
        glCullFace(GL_FRONT);
        mesh.draw();
        glCullFace(GL_BACK);
        canopy_.set("lift", 0.0f);
        mesh.draw();
        canopy_.set("lift", 1.0f);
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    };
    targets.exit.bind_for_drawing();
    constexpr float kUnknown[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 0, kUnknown);
    enter(targets.first, 0);
    leave(targets.first, false);
    targets.first.depth().bind(TEX_CANOPY_DEPTH);
    targets.exit.ground().bind(TEX_CANOPY_EXIT);
    enter(targets.second, apart_m);
    leave(targets.second, true);
    glDisable(GL_CULL_FACE);
}

void MarchPass::triangle(const gl::Program& program, const Inputs& inputs, float plane) const {
    program.use();
    program.set("samples", inputs.samples);
    program.set("sample_x", inputs.canopy.places()[0]);
    program.set("sample_y", inputs.canopy.places()[1]);
    program.set("eye_height", inputs.eye_height_m);
    program.set("plane", plane);
    program.set("surface_origin", glm::vec4(inputs.origin, 0));
    glBindVertexArray(vertex_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void MarchPass::choose(const Inputs& inputs) {
    inputs.textures.bind();
    inputs.canopy.bind_textures(TEX_CANOPY_DEPTH);
    if (inputs.surface) {
        inputs.surface->bind_textures();
    }
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE,
                GL_FALSE); // what a shader does not write is undefined
    if (inputs.fine && !fine_choose_) {
        fine_choose_ = std::make_unique<gl::Program>(
            "march's kinds, fine ground",
            std::vector<std::filesystem::path>{"shells/march.vert", "shells/march_choose.frag"},
            Variant{false, false, land_, false, true}.with({}));
    }
    triangle(inputs.fine ? *fine_choose_ : choose_, inputs, 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthFunc(GL_GREATER);
}

void MarchPass::draw_kind(int kind, const gl::Program& plain, const gl::Program& crest,
                          const Inputs& inputs) const {
    inputs.textures.bind_kind(kind);
    for (const gl::Program* program : {&plain, &crest}) {
        program->use();
        program->set("kind", kind);
        triangle(*program, inputs, shared::kind_depth(kind, program == &crest));
    }
}

const MarchPass::Kinds& MarchPass::kinds_for(const Inputs& inputs) {
    const std::size_t which = (inputs.count ? 1U : 0U) + (inputs.fine ? 2U : 0U);
    if (which == 0) {
        return kinds_;
    }
    std::unique_ptr<Kinds>& other = others_[which - 1];
    if (!other) {
        other = std::make_unique<Kinds>(Variant{aov_, surface_, land_, inputs.count, inputs.fine});
    }
    return *other;
}

void MarchPass::execute(const Inputs& inputs) {
    if (inputs.count) {
        counts_.clear_to_zero();
        counts_.bind_storage(BIND_MARCH_COUNTS);
    }
    const Kinds& kinds = kinds_for(inputs);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_EQUAL);
    glDepthMask(GL_FALSE);
    glBeginQuery(GL_SAMPLES_PASSED, queries_[0]);
    for (int kind = 0; kind < shared::kMarchSets; ++kind) {
        draw_kind(kind, kinds.slabs, kinds.crests, inputs);
    }
    glEndQuery(GL_SAMPLES_PASSED);
    glBeginQuery(GL_SAMPLES_PASSED, queries_[1]);
    draw_kind(shared::kMarchColumns, kinds.columns, kinds.crests, inputs);
    glEndQuery(GL_SAMPLES_PASSED);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_GREATER);
    glDisable(GL_DEPTH_TEST);
}

void MarchPass::reload() {
    canopy_.reload();
    canopy_samples_.reload();
    choose_.reload();
    kinds_.reload();
    if (fine_choose_) {
        fine_choose_->reload();
    }
    for (const auto& other : others_) {
        if (other) {
            other->reload();
        }
    }
}

} // namespace sward::shells
