// SPDX-License-Identifier: Apache-2.0
#include "shells/far_pass.h"

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::shells {

namespace {

constexpr int kColumns = shared::kBlockCells; // of a slice's strip
constexpr int kRows =
    3; // of level 0's strips: enough for their bend; each costs 9 vertices a slice

std::vector<std::string> defines(FarPass::Family family, bool aov, bool block_shapes) {
    std::vector<std::string> out;
    if (family == FarPass::Family::kSlices) {
        out.emplace_back("SLICES");
    }
    if (aov) {
        out.emplace_back("AOV");
    }
    if (block_shapes) {
        out.emplace_back("BLOCK_SHAPES");
    }
    return out;
}

gl::Buffer strip_indices() {
    std::vector<std::uint16_t> indices;
    for (int row = 0; row < kRows; ++row) {
        for (int column = 0; column < kColumns; ++column) {
            const int at = row * (kColumns + 1) + column;
            for (const int corner :
                 {at, at + 1, at + kColumns + 1, at + 1, at + kColumns + 2, at + kColumns + 1}) {
                indices.push_back(static_cast<std::uint16_t>(corner));
            }
        }
    }
    return gl::Buffer::of(std::span<const std::uint16_t>(indices));
}

} // namespace

FarPass::FarPass(Family family, bool aov, bool block_shapes)
    : family_(family),
      program_(family == Family::kShells ? "shells" : "slices",
               {"shells/far.vert", "shells/far.frag"}, defines(family, aov, block_shapes)),
      strip_(strip_indices()), shares_(sizeof(shared::FarShares)) {
    glCreateVertexArrays(1, &strip_array_);
    glVertexArrayElementBuffer(strip_array_, strip_.id());
    glCreateQueries(GL_SAMPLES_PASSED, 1, &query_);
}

FarPass::~FarPass() {
    glDeleteVertexArrays(1, &strip_array_);
    glDeleteQueries(1, &query_);
}

void FarPass::draw_level(std::size_t k, const Inputs& inputs) const {
    const auto instances = static_cast<GLsizei>(inputs.instances[k].size());
    const FarTextures::Level& level = inputs.textures.levels()[k];
    instances_[k].bind_storage(BIND_FAR_INSTANCES);
    if (inputs.textures.block_shapes()) {
        (family_ == Family::kShells ? level.layers_shape : level.slices_shape).bind(TEX_FAR_SHAPES);
    }
    if (family_ == Family::kShells) {
        level.layers.bind(TEX_FAR_IMAGES);
        inputs.mesh.draw(instances);
    } else {
        level.slices.bind(TEX_FAR_IMAGES);
        glBindVertexArray(strip_array_);
        const int rows = k == 0 ? kRows : 1; // further off, a slice is some pixels tall
        program_.set("rows", static_cast<float>(rows));
        glDrawElementsInstanced(GL_TRIANGLES, 6 * kColumns * rows, GL_UNSIGNED_SHORT, nullptr,
                                instances);
    }
}

void FarPass::execute(const Inputs& inputs) {
    program_.use();
    shares_.upload(&inputs.shares, sizeof(inputs.shares));
    shares_.bind_uniform(BIND_FAR_SHARES);
    glBeginQuery(GL_SAMPLES_PASSED, query_);
    for (std::size_t k = 0; k < inputs.textures.levels().size(); ++k) {
        const std::size_t bytes = inputs.instances[k].size() * sizeof(shared::FarInstance);
        if (bytes > 0) {
            instances_[k].reserve(bytes);
            instances_[k].upload(inputs.instances[k].data(), bytes);
            draw_level(k, inputs);
        }
    }
    glEndQuery(GL_SAMPLES_PASSED);
}

std::uint64_t FarPass::samples_passed() const {
    GLuint64 passed = 0;
    glGetQueryObjectui64v(query_, GL_QUERY_RESULT, &passed);
    return passed;
}

} // namespace sward::shells
