// SPDX-License-Identifier: Apache-2.0
#include "blades/physics_pass.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "shared/bindings.h"
#include "shared/blade_pages.h"

namespace sward::blades {

namespace {

/// PhysicsBlock of shaders/blades/physics.glsl.
struct Block {
    shared::BladeStep rules;
    shared::WindField wind;
};
static_assert(sizeof(Block) == 64 + 112);

/// Dispatch of shaders/blades/wake.comp.
struct Dispatch {
    std::uint32_t groups = 0, groups_y = 1, groups_z = 1, all_groups = 0;
};

std::vector<shared::BladeRecord> in_order(const grass::GrassSet& set, const MortonOrder& order) {
    std::vector<shared::BladeRecord> out;
    out.reserve(order.blades.size());
    for (const std::uint32_t blade : order.blades) {
        out.push_back(set.blades[blade]);
    }
    return out;
}

} // namespace

PhysicsPass::PhysicsPass(const grass::GrassSet& set, const Pages& pages)
    : patches_a_page_(pages.order().patches_a_page), patch_count_(patches_a_page_ * static_cast<int>(pages.slots().size())),
      marked_(pages.slots().size(), false), variant_begin_(set.variant_begin), wake_("wake blades", {"blades/wake.comp"}),
      step_("step blades", {"blades/physics.comp"}),
      records_(gl::Buffer::of(std::span<const shared::BladeRecord>(in_order(set, pages.order())))),
      places_(gl::Buffer::of(std::span<const std::uint32_t>(pages.order().places))), pages_(pages.slots().size() * sizeof(shared::BladePage)),
      states_(static_cast<std::size_t>(patch_count_) * CULL_GROUP * sizeof(glm::vec4)),
      patches_(static_cast<std::size_t>(patch_count_) * sizeof(shared::PatchState)),
      awake_(static_cast<std::size_t>(patch_count_) * sizeof(std::uint32_t)), dispatch_(sizeof(Dispatch)), block_(sizeof(Block)) {
    states_.clear_to_zero();
    patches_.clear_to_zero();
    begin_count();
}

PhysicsPass::PhysicsPass(std::vector<const gl::Buffer*> records, std::size_t slots)
    : patches_a_page_(1), patch_count_(static_cast<int>(slots)), marked_(slots, false), records_of_mesh_(std::move(records)),
      wake_("wake surface blades", {"blades/wake.comp"}, {"SURFACE"}), step_("step surface blades", {"blades/physics.comp"}, {"SURFACE"}),
      pages_(slots * sizeof(shared::BladePage)), states_(slots * CULL_GROUP * sizeof(glm::vec4)), patches_(slots * sizeof(shared::PatchState)),
      awake_(slots * sizeof(std::uint32_t)), dispatch_(sizeof(Dispatch)), block_(sizeof(Block)) {
    states_.clear_to_zero();
    patches_.clear_to_zero();
    begin_count();
}

void PhysicsPass::begin_count() {
    const Dispatch none;
    dispatch_.upload(&none, sizeof(none));
}

void PhysicsPass::place(const Pages& pages, double side_m, glm::dvec3 anchor) {
    std::vector<shared::BladePage> placed(pages.slots().size());
    for (std::size_t slot = 0; slot < placed.size(); ++slot) {
        const Pages::Page& page = pages.slots()[slot];
        if (page.used) {
            const auto variant = static_cast<std::size_t>(page.variant);
            const glm::vec2 corner(glm::dvec2(page.tile) * side_m - glm::dvec2(anchor.x, anchor.z));
            placed[slot] = {glm::vec4(corner, 0, 0), {static_cast<int>(variant_begin_[variant]),
                                                     static_cast<int>(variant_begin_[variant + 1] - variant_begin_[variant]), 0, 0}};
        }
    }
    place(std::move(placed), pages.fresh());
}

void PhysicsPass::place(std::vector<shared::BladePage> placed, std::span<const int> fresh) {
    const auto same = [](const shared::BladePage& a, const shared::BladePage& b) { return a.place == b.place && a.run == b.run; };
    if (!std::equal(placed.begin(), placed.end(), placed_.begin(), placed_.end(), same)) {
        placed_ = std::move(placed);
        pages_.upload(placed_.data(), placed_.size() * sizeof(shared::BladePage));
    }
    std::vector<bool> write(marked_.size(), false);
    for (const int slot : fresh) {
        write[static_cast<std::size_t>(slot)] = true;
    }
    for (std::size_t slot = 0; slot < marked_.size(); ++slot) {
        write[slot] = write[slot] || marked_[slot] != (placed_[slot].run.y > 0);
    }
    for (std::size_t first = 0, last = 0; first < write.size(); first = last + 1) { // neighbours at once: there may be many
        for (last = first; last < write.size() && write[last]; ++last) {
        }
        if (last > first) {
            mark(first, last);
        }
    }
}

void PhysicsPass::mark(std::size_t first, std::size_t last) {
    const auto stride = static_cast<std::size_t>(patches_a_page_);
    std::vector<shared::PatchState> states((last - first) * stride, {{0, 0}, shared::kPatchFree, 0});
    for (std::size_t slot = first; slot < last; ++slot) {
        const auto filled = static_cast<std::size_t>((placed_[slot].run.y + CULL_GROUP - 1) / CULL_GROUP);
        for (std::size_t n = 0; n < filled; ++n) {
            states[(slot - first) * stride + n].status = shared::kPatchNew;
        }
        marked_[slot] = filled > 0;
    }
    patches_.upload(states.data(), states.size() * sizeof(shared::PatchState), first * stride * sizeof(shared::PatchState));
}

void PhysicsPass::step(const shared::BladeStep& rules, const shared::WindField& wind, const SphereLists& spheres) {
    if (patch_count_ == 0) {
        return;
    }
    const Block block{rules, wind};
    block_.upload(&block, sizeof(block));
    lists_.reserve(spheres.lists.size() * sizeof(std::uint32_t));
    lists_.upload(spheres.lists.data(), spheres.lists.size() * sizeof(std::uint32_t));
    spheres_.reserve(std::max<std::size_t>(spheres.spheres.size(), 1) * sizeof(StepSphere));
    spheres_.upload(spheres.spheres.data(), spheres.spheres.size() * sizeof(StepSphere));
    block_.bind_uniform(BIND_PHYSICS);
    pages_.bind_storage(BIND_PHYSICS_PAGES);
    states_.bind_storage(BIND_PHYSICS_STATES);
    patches_.bind_storage(BIND_PHYSICS_PATCHES);
    awake_.bind_storage(BIND_PHYSICS_AWAKE);
    dispatch_.bind_storage(BIND_PHYSICS_DISPATCH);
    lists_.bind_storage(BIND_PHYSICS_LISTS);
    spheres_.bind_storage(BIND_PHYSICS_SPHERES);
    if (records_of_mesh_.empty()) {
        step_records(records_, 0);
    }
    for (std::size_t n = 0; n < records_of_mesh_.size(); ++n) {
        step_records(*records_of_mesh_[n], static_cast<int>(n));
    }
}

void PhysicsPass::step_records(const gl::Buffer& records, int number) {
    const std::uint32_t none = 0;
    dispatch_.upload(&none, sizeof(none)); // the groups; what follows them stays
    records.bind_storage(BIND_PHYSICS_BLADES);
    wake_.use();
    wake_.set("patch_count", patch_count_);
    wake_.set("patches_a_page", patches_a_page_);
    wake_.set("buffer_number", number);
    glDispatchCompute(static_cast<GLuint>((patch_count_ + WAKE_GROUP - 1) / WAKE_GROUP), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    step_.use();
    step_.set("patches_a_page", patches_a_page_);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, dispatch_.id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void PhysicsPass::bind_for_drawing() const {
    states_.bind_storage(BIND_BLADE_STATES);
    if (records_of_mesh_.empty()) {
        places_.bind_storage(BIND_BLADE_PLACES);
    }
}

std::uint64_t PhysicsPass::stepped_patches() const {
    Dispatch dispatch;
    dispatch_.read(&dispatch, sizeof(dispatch));
    return dispatch.all_groups;
}

std::size_t PhysicsPass::bytes() const {
    std::size_t sum = 0;
    for (const gl::Buffer* buffer : {&records_, &places_, &pages_, &states_, &patches_, &awake_, &dispatch_, &lists_, &spheres_, &block_}) {
        sum += buffer->bytes();
    }
    return sum;
}

void PhysicsPass::reload() {
    wake_.reload();
    step_.reload();
}

} // namespace sward::blades
