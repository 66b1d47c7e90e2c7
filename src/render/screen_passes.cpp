// SPDX-License-Identifier: Apache-2.0
#include "render/screen_passes.h"

#include <epoxy/gl.h>

namespace sward::render {

namespace {
std::vector<std::string> variant(bool aov) { return aov ? std::vector<std::string>{"AOV"} : std::vector<std::string>{}; }
} // namespace

ScreenPasses::ScreenPasses(bool aov)
    : sky_("sky", {"render/screen.vert", "render/sky.frag"}, variant(aov)),
      resolve_("resolve", {"render/screen.vert", "render/resolve.frag"}, variant(aov)),
      tone_map_("tone map", {"render/screen.vert", "render/tone_map.frag"}) {
    glCreateVertexArrays(1, &vertex_array_);
}

ScreenPasses::~ScreenPasses() { glDeleteVertexArrays(1, &vertex_array_); }

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
        glBlendFunc(GL_ONE, GL_ONE);
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

void ScreenPasses::reload() {
    sky_.reload();
    resolve_.reload();
    tone_map_.reload();
}

} // namespace sward::render
