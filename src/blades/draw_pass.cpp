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

void DrawPass::execute(const CullPass& culled, const PhysicsPass* living) {
    program_.use();
    glBindVertexArray(vertex_array_);
    culled.survivors().bind_storage(BIND_SURVIVORS);
    if (living) {
        living->bind_for_drawing();
    }
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, culled.commands().id());
    glPatchParameteri(GL_PATCH_VERTICES, 1);
    glMultiDrawArraysIndirect(GL_PATCHES, nullptr, culled.command_count(), 0);
}

} // namespace sward::blades
