// SPDX-License-Identifier: Apache-2.0
#include "render/screen_passes.h"

#include <epoxy/gl.h>

#include "base/error.h"
#include "shared/bindings.h"

namespace sward::render {

namespace {
std::vector<std::string> variant(bool aov) {
    return aov ? std::vector<std::string>{"AOV"} : std::vector<std::string>{};
}
} // namespace

ScreenPasses::ScreenPasses(bool aov)
    : aov_(aov), sky_("sky", {"render/screen.vert", "render/sky.frag"}, variant(aov)),
      resolve_("resolve", {"render/screen.vert", "render/resolve.frag"}, variant(aov)),
      tone_map_("tone map", {"render/screen.vert", "render/tone_map.frag"}) {
    glCreateVertexArrays(1, &vertex_array_);
}

ScreenPasses::~ScreenPasses() {
    glDeleteVertexArrays(1, &vertex_array_);
    glDeleteFramebuffers(1, &host_framebuffer_);
}

void ScreenPasses::triangle() const {
    glBindVertexArray(vertex_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ScreenPasses::sky() {
    glDepthFunc(GL_GEQUAL); // the triangle lies at infinity, where nothing was drawn
    sky_.use();
    triangle();
    glDepthFunc(GL_GREATER);
}

void ScreenPasses::resolve(const Targets& targets, float weight, bool first) {
    glDisable(GL_DEPTH_TEST);
    targets.bind_resolved();
    targets.bind_scene_textures();
    if (!first) { // colour and coverage add up; the rest stays the first frame's
        glEnablei(GL_BLEND, 0);
        glBlendFunci(0, GL_ONE, GL_ONE);
        for (GLuint target = 1; target < 4; ++target) {
            glColorMaski(target, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        }
    }
    resolve_.use();
    resolve_.set("samples", targets.samples());
    resolve_.set("weight", weight);
    triangle();
    glDisablei(GL_BLEND, 0);
    for (GLuint target = 1; target < 4; ++target) {
        glColorMaski(target, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
}

void ScreenPasses::tone_map(const Targets& targets, float exposure) {
    glDisable(GL_DEPTH_TEST);
    targets.bind_display();
    targets.bind_resolved_color();
    tone_map_.use();
    tone_map_.set("exposure", exposure);
    triangle();
}

void ScreenPasses::take_scene(std::uint32_t colour, std::uint32_t depth, glm::dvec2 host_depth) {
    if (!take_scene_) {
        take_scene_ = std::make_unique<gl::Program>(
            "host scene",
            std::vector<std::filesystem::path>{"render/screen.vert", "render/host_scene.frag"},
            variant(aov_));
    }
    glBindTextureUnit(TEX_RESOLVE_COLOR, colour);
    glBindTextureUnit(TEX_RESOLVE_DEPTH, depth);
    take_scene_->use();
    take_scene_->set("host_depth", glm::vec4(host_depth, colour != 0 ? 1 : 0, 0));
    triangle();
}

void ScreenPasses::hand_out(const Targets& targets, std::uint32_t colour, std::uint32_t depth,
                            glm::dvec2 host_depth) {
    if (!hand_out_) {
        hand_out_ = std::make_unique<gl::Program>(
            "hand out",
            std::vector<std::filesystem::path>{"render/screen.vert", "render/hand_out.frag"});
        glCreateFramebuffers(1, &host_framebuffer_);
    }
    glNamedFramebufferTexture(host_framebuffer_, GL_COLOR_ATTACHMENT0, colour, 0);
    glNamedFramebufferTexture(host_framebuffer_, GL_DEPTH_ATTACHMENT, depth, 0);
    glNamedFramebufferDrawBuffer(host_framebuffer_, colour != 0 ? GL_COLOR_ATTACHMENT0 : GL_NONE);
    if (glCheckNamedFramebufferStatus(host_framebuffer_, GL_FRAMEBUFFER) !=
        GL_FRAMEBUFFER_COMPLETE) {
        throw base::Error(base::ExitCode::kBadInput,
                          "target: found textures that cannot be drawn to together, expected "
                          "single-sampled 2D ones of one size: "
                          "colour RGBA16F or RGBA32F, depth DEPTH_COMPONENT24 or 32F");
    }
    glBindFramebuffer(GL_FRAMEBUFFER, host_framebuffer_);
    glViewportIndexedf(0, 0, 0, static_cast<float>(targets.width()),
                       static_cast<float>(targets.height()));
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    targets.bind_resolved_textures();
    hand_out_->use();
    hand_out_->set("host_depth", glm::vec4(host_depth, 0, 0));
    triangle();
    glDepthFunc(GL_GREATER);
    glDisable(GL_DEPTH_TEST);
    glNamedFramebufferTexture(host_framebuffer_, GL_COLOR_ATTACHMENT0, 0,
                              0); // the host may delete them
    glNamedFramebufferTexture(host_framebuffer_, GL_DEPTH_ATTACHMENT, 0, 0);
}

void ScreenPasses::reload() {
    for (gl::Program* program : {take_scene_.get(), hand_out_.get()}) {
        if (program) {
            program->reload();
        }
    }
    sky_.reload();
    resolve_.reload();
    tone_map_.reload();
}

} // namespace sward::render
