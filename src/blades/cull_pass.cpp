// SPDX-License-Identifier: Apache-2.0
#include "blades/cull_pass.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::blades {

CullPass::CullPass(std::vector<std::string> defines)
    : program_("cull blades", {"blades/cull.comp"}, std::move(defines)),
      survivors_(kBatch * CULL_GROUP * sizeof(glm::uvec2)),
      commands_(kBatch * sizeof(shared::DrawCommand)), total_(CULL_COUNTS * sizeof(std::uint32_t)) {
}

void CullPass::upload(const TileList& list, bool keep_total) {
    items_count_ = list.items.size();
    tiles_.reserve(list.tiles.size() * sizeof(shared::BladeTile));
    tiles_.upload(list.tiles.data(), list.tiles.size() * sizeof(shared::BladeTile));
    items_.reserve(list.items.size() * sizeof(glm::uvec2));
    items_.upload(list.items.data(), list.items.size() * sizeof(glm::uvec2));
    if (!keep_total) {
        total_.clear_to_zero();
    }
}

void CullPass::execute(std::size_t batch, const CullTests& tests) {
    const std::size_t first = batch * kBatch;
    command_count_ = static_cast<int>(std::min(kBatch, items_count_ - first));
    tiles_.bind_storage(BIND_BLADE_TILES);
    items_.bind_storage(BIND_CULL_ITEMS);
    survivors_.bind_storage(BIND_SURVIVORS);
    commands_.bind_storage(BIND_DRAW_COMMANDS);
    total_.bind_storage(BIND_CULL_TOTAL);
    program_.use();
    program_.set("first_item", static_cast<int>(first));
    program_.set("tests", (tests.frustum ? 1 << CULL_FRUSTUM : 0) |
                              (tests.orientation ? 1 << CULL_ORIENTATION : 0) |
                              (tests.occlusion ? 1 << CULL_OCCLUSION : 0));
    glDispatchCompute(static_cast<GLuint>(command_count_), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

std::uint64_t CullPass::bytes() const {
    return tiles_.bytes() + items_.bytes() + survivors_.bytes() + commands_.bytes() +
           total_.bytes();
}

std::array<std::uint32_t, CULL_COUNTS> CullPass::counts() const {
    std::array<std::uint32_t, CULL_COUNTS> counts{};
    total_.read(counts.data(), sizeof(counts));
    return counts;
}

} // namespace sward::blades
