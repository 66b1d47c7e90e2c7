// SPDX-License-Identifier: Apache-2.0
#include "blades/draw_pass.h"

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::blades {

DrawPass::DrawPass(bool aov)
    : program_("blades", {"blades/blade.vert", "blades/blade.tesc", "blades/blade.tese", "blades/blade.frag"},
               aov ? std::vector<std::string>{"AOV"} : std::vector<std::string>{}) {
    glCreateVertexArrays(1, &vertex_array_);
}

DrawPass::~DrawPass() { glDeleteVertexArrays(1, &vertex_array_); }

void DrawPass::execute(const CullPass& culled) {
    program_.use();
    glBindVertexArray(vertex_array_);
    culled.visible().bind_storage(BIND_VISIBLE);
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, culled.command().id());
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    glDrawArraysIndirect(GL_PATCHES, nullptr);
}

} // namespace sward::blades
