// SPDX-License-Identifier: Apache-2.0
#include "blades/cull_pass.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::blades {

namespace {
/// DrawArraysIndirectCommand, then a running total of survivors; 32 bytes as in cull_compact.comp.
struct Command {
    std::uint32_t vertices, instances, first, base;
    std::uint32_t total, pad0, pad1, pad2;
};
static_assert(sizeof(Command) == 32);
} // namespace

CullPass::CullPass()
    : cull_("cull blades", {"blades/cull.comp"}), compact_("compact blades", {"blades/cull_compact.comp"}),
      segments_(kBatch * CULL_GROUP * sizeof(glm::uvec2)), counts_(kBatch * sizeof(std::uint32_t)),
      visible_(kBatch * CULL_GROUP * sizeof(glm::uvec2)), command_(sizeof(Command)) {}

void CullPass::upload(const TileList& list) {
    items_count_ = list.items.size();
    tiles_.reserve(list.tiles.size() * sizeof(shared::BladeTile));
    tiles_.upload(list.tiles.data(), list.tiles.size() * sizeof(shared::BladeTile));
    items_.reserve(list.items.size() * sizeof(glm::uvec2));
    items_.upload(list.items.data(), list.items.size() * sizeof(glm::uvec2));
    const Command empty{0, 1, 0, 0, 0, 0, 0, 0};
    command_.upload(&empty, sizeof(empty));
}

void CullPass::execute(std::size_t batch) {
    const std::size_t first = batch * kBatch;
    const auto groups = static_cast<GLuint>(std::min(kBatch, items_count_ - first));
    tiles_.bind_storage(BIND_BLADE_TILES);
    items_.bind_storage(BIND_CULL_ITEMS);
    segments_.bind_storage(BIND_SEGMENTS);
    counts_.bind_storage(BIND_SEGMENT_COUNTS);
    visible_.bind_storage(BIND_VISIBLE);
    command_.bind_storage(BIND_DRAW_COMMAND);
    cull_.use();
    cull_.set("first_item", static_cast<int>(first));
    glDispatchCompute(groups, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    compact_.use();
    glDispatchCompute(groups, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

std::uint64_t CullPass::drawn() const {
    Command command{};
    command_.read(&command, sizeof(command));
    return command.total;
}

void CullPass::reload() {
    cull_.reload();
    compact_.reload();
}

} // namespace sward::blades
