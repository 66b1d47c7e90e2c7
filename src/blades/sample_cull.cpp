// SPDX-License-Identifier: Apache-2.0
#include "blades/sample_cull.h"

#include <algorithm>
#include <cassert>

#include <epoxy/gl.h>

namespace sward::blades {

namespace {

constexpr std::size_t kMostGroups = 65535; // that GL promises a dispatch
static_assert(SampleCull::kBatch % (GATHER_ITEMS * GATHER_GROUP) == 0);

} // namespace

SampleCull::SampleCull()
    : choose_("choose blades", {"blades/choose.comp"}),
      gather_("gather blades", {"blades/gather.comp"}), sift_("sift blades", {"blades/sift.comp"}),
      survivors_(kBatch * CULL_GROUP * sizeof(glm::uvec2)),
      commands_(kBatch * sizeof(shared::DrawCommand)), total_(CULL_COUNTS * sizeof(std::uint32_t)),
      round_(sizeof(shared::SampleRound)) {}

void SampleCull::upload(const TileList& list, std::span<const glm::vec2> samples,
                        std::span<const glm::vec2> jitters, bool keep_total) {
    assert(samples.size() <= shared::kMostSamples && jitters.size() <= kRound);
    items_count_ = list.items.size();
    tiles_.reserve(list.tiles.size() * sizeof(shared::BladeTile));
    tiles_.upload(list.tiles.data(), list.tiles.size() * sizeof(shared::BladeTile));
    items_.reserve(items_count_ * sizeof(glm::uvec2));
    items_.upload(list.items.data(), items_count_ * sizeof(glm::uvec2));
    masks_.reserve((piecewise() ? kBatch : items_count_) * CULL_GROUP * sizeof(std::uint16_t));
    shared::SampleRound round{};
    round.counts = {static_cast<int>(jitters.size()), static_cast<int>(samples.size()), 0, 0};
    for (std::size_t i = 0; i < jitters.size() * samples.size();
         ++i) { // what moves the picture one way moves its samples over the first one the other
        round.places[i] =
            glm::vec4(samples[i % samples.size()] + jitters[i / samples.size()], 0, 0);
    }
    round_.upload(&round, sizeof(round));
    if (!keep_total) {
        total_.clear_to_zero();
    }
}

void SampleCull::choose(const PhysicsPass* living) {
    first_mask_ = 0;
    for (std::size_t first = 0; !piecewise() && first < items_count_; first += kMostGroups) {
        choose_items(first, std::min(first + kMostGroups, items_count_), living);
    }
}

void SampleCull::choose_items(std::size_t first, std::size_t end, const PhysicsPass* living) {
    if (living) {
        living->bind_for_drawing();
    }
    tiles_.bind_storage(BIND_BLADE_TILES);
    items_.bind_storage(BIND_CHOICE_ITEMS);
    masks_.bind_storage(BIND_CHOICE_MASKS);
    total_.bind_storage(BIND_CHOICE_TOTAL);
    round_.bind_uniform(BIND_SAMPLES);
    choose_.use();
    choose_.set("first_item", static_cast<int>(first));
    choose_.set("first_mask", static_cast<int>(first_mask_));
    glDispatchCompute(static_cast<GLuint>(end - first), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void SampleCull::gather(std::size_t batch, int picture, const PhysicsPass* living) {
    const std::size_t first = batch * kBatch, end = std::min(first + kBatch, items_count_);
    if (piecewise()) {
        first_mask_ = first;
        choose_items(first, end, living);
    }
    tiles_.bind_storage(BIND_BLADE_TILES);
    items_.bind_storage(BIND_CULL_ITEMS);
    masks_.bind_storage(BIND_GATHER_MASKS);
    survivors_.bind_storage(BIND_SURVIVORS);
    commands_.bind_storage(BIND_DRAW_COMMANDS);
    gather_.use();
    gather_.set("first_item", static_cast<int>(first));
    gather_.set("end_item", static_cast<int>(end));
    gather_.set("first_mask", static_cast<int>(first_mask_));
    gather_.set("picture", picture);
    constexpr std::size_t kGroupItems = GATHER_ITEMS * GATHER_GROUP;
    command_count_ = static_cast<int>(end - first);
    glDispatchCompute(static_cast<GLuint>((end - first + kGroupItems - 1) / kGroupItems), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void SampleCull::sift(const gl::Texture& depth, const PhysicsPass* living) {
    if (living) {
        living->bind_for_drawing();
    }
    tiles_.bind_storage(BIND_BLADE_TILES);
    survivors_.bind_storage(BIND_SURVIVORS);
    commands_.bind_storage(BIND_DRAW_COMMANDS);
    total_.bind_storage(BIND_CHOICE_TOTAL);
    round_.bind_uniform(BIND_SAMPLES);
    depth.bind(TEX_RESOLVE_DEPTH);
    sift_.use();
    glDispatchCompute(static_cast<GLuint>(command_count_), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

std::array<std::uint32_t, CULL_COUNTS> SampleCull::counts() const {
    std::array<std::uint32_t, CULL_COUNTS> counts{};
    total_.read(counts.data(), sizeof(counts));
    return counts;
}

void SampleCull::reload() {
    choose_.reload();
    gather_.reload();
    sift_.reload();
}

} // namespace sward::blades
