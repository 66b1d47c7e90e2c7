// SPDX-License-Identifier: Apache-2.0
#include "blades/draw_pass.h"

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::blades {

namespace {

std::vector<std::string> defines_of(bool aov, bool surface) {
    std::vector<std::string> defines;
    if (surface) {
        defines.emplace_back("SURFACE");
    }
    if (aov) {
        defines.emplace_back("AOV");
    }
    return defines;
}

} // namespace

DrawPass::DrawPass(bool aov, bool surface)
    : program_(surface ? "surface blades" : "blades",
               {surface ? "blades/surface_blade.vert" : "blades/blade.vert", "blades/blade.tesc",
                "blades/blade.tese", "blades/blade.frag"},
               defines_of(aov, surface)) {
    glCreateVertexArrays(1, &vertex_array_);
}

DrawPass::~DrawPass() {
    glDeleteVertexArrays(1, &vertex_array_);
}

void DrawPass::execute(const CullPass& culled, const PhysicsPass* living) {
    draw(culled.survivors(), culled.commands(), culled.command_count(), living);
}

void DrawPass::execute(const SampleCull& culled, const PhysicsPass* living) {
    draw(culled.survivors(), culled.commands(), culled.command_count(), living);
}

void DrawPass::draw(const gl::Buffer& survivors, const gl::Buffer& commands, int count,
                    const PhysicsPass* living) {
    program_.use();
    glBindVertexArray(vertex_array_);
    survivors.bind_storage(BIND_SURVIVORS);
    if (living) {
        living->bind_for_drawing();
    }
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.id());
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    glMultiDrawArraysIndirect(GL_PATCHES, nullptr, count, 0);
}

} // namespace sward::blades
