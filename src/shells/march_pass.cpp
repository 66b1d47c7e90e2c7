// SPDX-License-Identifier: Apache-2.0
#include "shells/march_pass.h"

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::shells {

void CanopyTargets::require(int width, int height) {
    if (depth_.id() && depth_.shape().width == width && depth_.shape().height == height) {
        return;
    }
    surface_ = gl::Framebuffer();
    depth_ = gl::Texture(GL_DEPTH_COMPONENT32F, {width, height});
    ground_ = gl::Texture(GL_RGBA16F, {width, height});
    air_ = gl::Texture(GL_RGBA16F, {width, height});
    surface_ = gl::Framebuffer({&ground_, &air_}, &depth_);
}

void CanopyTargets::bind_textures() const {
    depth_.bind(TEX_CANOPY_DEPTH);
    ground_.bind(TEX_CANOPY_GROUND);
    air_.bind(TEX_CANOPY_AIR);
}

MarchPass::MarchPass(bool aov)
    : canopy_("canopy", {"shells/canopy.vert", "shells/canopy.frag"}),
      march_("far field", {"render/screen.vert", "shells/march.frag"}, aov ? std::vector<std::string>{"AOV"} : std::vector<std::string>{}) {
    glCreateVertexArrays(1, &vertex_array_);
}

MarchPass::~MarchPass() { glDeleteVertexArrays(1, &vertex_array_); }

void MarchPass::draw_canopy(const CanopyTargets& targets, int blocks, const terrain::BlockMesh& mesh) {
    targets.bind_for_drawing();
    constexpr float kFar[4] = {0, 0, 0, 0};
    glClearBufferfv(GL_DEPTH, 0, kFar);
    glEnable(GL_CULL_FACE);
    canopy_.use();
    mesh.draw(blocks);
    glDisable(GL_CULL_FACE);
}

void MarchPass::execute(const Inputs& inputs) {
    inputs.textures.bind();
    inputs.canopy.bind_textures();
    glDisable(GL_DEPTH_TEST);
    march_.use();
    march_.set("samples", inputs.samples);
    march_.set("eye_height", inputs.eye_height_m);
    glBindVertexArray(vertex_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void MarchPass::reload() {
    canopy_.reload();
    march_.reload();
}

} // namespace sward::shells
