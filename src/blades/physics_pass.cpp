// SPDX-License-Identifier: Apache-2.0
#include "blades/physics_pass.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <string>

#include <epoxy/gl.h>

#include "shared/bindings.h"
#include "shared/blade_pages.h"
#include "shared/tile_lie.h"

namespace sward::blades {

namespace {

/// PhysicsBlock of shaders/blades/physics.glsl.
struct Block {
    shared::BladeStep rules;
    shared::WindField wind;
};
static_assert(sizeof(Block) == sizeof(shared::BladeStep) + sizeof(shared::WindField));

/// Dispatch of shaders/blades/wake.comp.
struct Dispatch {
    struct Groups {
        std::uint32_t x = 0, y = 1, z = 1, unused = 0;
    };
    std::array<Groups, shared::kPatchLists> lists;
    std::array<std::uint32_t, shared::kPatchLists> stepped = {};
};
static_assert(sizeof(Dispatch) == 20 * shared::kPatchLists);

std::vector<gl::Program> step_programs(StepPrograms programs, std::vector<std::string> defines) {
    const auto build = [&](const char* what, const char* define) {
        std::vector<std::string> all = defines;
        all.emplace_back(define);
        return gl::Program(what, {"blades/physics.comp"}, std::move(all));
    };
    std::vector<gl::Program> out;
    if (programs == StepPrograms::kOne) {
        out.push_back(build("step any blades", "PHYSICS_ALL"));
        return out;
    }
    out.push_back(build("step free blades", "PHYSICS_FREE")); // in the order of the lists
    out.push_back(build("step blades that colliders meet", "PHYSICS_COLLIDING"));
    out.push_back(build("begin blades", "PHYSICS_NEW"));
    return out;
}

std::vector<shared::BladeRecord> in_order(const grass::GrassSet& set, const MortonOrder& order) {
    std::vector<shared::BladeRecord> out;
    out.reserve(order.blades.size());
    for (const std::uint32_t blade : order.blades) {
        out.push_back(set.blades[blade]);
    }
    return out;
}

} // namespace

PhysicsPass::PhysicsPass(const grass::GrassSet& set, const Pages& pages, StepPrograms programs)
    : patches_a_page_(pages.order().patches_a_page),
      patch_count_(patches_a_page_ * static_cast<int>(pages.slots().size())),
      marked_(pages.slots().size(), false), variant_begin_(set.variant_begin),
      wake_("wake blades", {"blades/wake.comp"}), steps_(step_programs(programs, {})),
      records_(gl::Buffer::of(std::span<const shared::BladeRecord>(in_order(set, pages.order())))),
      places_(gl::Buffer::of(std::span<const std::uint32_t>(pages.order().places))),
      pages_(pages.slots().size() * sizeof(shared::BladePage)),
      states_(static_cast<std::size_t>(patch_count_) * CULL_GROUP * sizeof(glm::vec4)),
      patches_(static_cast<std::size_t>(patch_count_) * sizeof(shared::PatchState)),
      awake_(static_cast<std::size_t>(patch_count_) * shared::kPatchLists *
             sizeof(shared::AwakePatch)),
      dispatch_(sizeof(Dispatch)), block_(sizeof(Block)) {
    states_.clear_to_zero();
    patches_.clear_to_zero();
    make_textures();
    begin_count();
}

PhysicsPass::PhysicsPass(std::vector<const gl::Buffer*> records, std::size_t slots,
                         StepPrograms programs)
    : patches_a_page_(1), patch_count_(static_cast<int>(slots)), marked_(slots, false),
      records_of_mesh_(std::move(records)),
      wake_("wake surface blades", {"blades/wake.comp"}, {"SURFACE"}),
      steps_(step_programs(programs, {"SURFACE"})), pages_(slots * sizeof(shared::BladePage)),
      states_(slots * CULL_GROUP * sizeof(glm::vec4)), patches_(slots * sizeof(shared::PatchState)),
      awake_(slots * shared::kPatchLists * sizeof(shared::AwakePatch)), dispatch_(sizeof(Dispatch)),
      block_(sizeof(Block)) {
    states_.clear_to_zero();
    patches_.clear_to_zero();
    make_textures();
    begin_count();
}

PhysicsPass::~PhysicsPass() {
    glDeleteTextures(static_cast<GLsizei>(record_textures_.size()), record_textures_.data());
}

void PhysicsPass::make_textures() {
    const std::vector<const gl::Buffer*> own = {&records_};
    for (const gl::Buffer* records : records_of_mesh_.empty() ? own : records_of_mesh_) {
        GLuint texture = 0;
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture);
        glTextureBuffer(texture, GL_RGBA32F, records->id());
        record_textures_.push_back(texture);
    }
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
            placed[slot] = {{corner.x, 0, corner.y},
                            static_cast<float>(side_m),
                            static_cast<int>(variant_begin_[variant]),
                            static_cast<int>(variant_begin_[variant + 1] - variant_begin_[variant]),
                            0,
                            shared::tile_lie(page.tile)};
        }
    }
    place(std::move(placed), pages.fresh());
}

void PhysicsPass::place(std::vector<shared::BladePage> placed, std::span<const int> fresh) {
    const auto same = [](const shared::BladePage& a, const shared::BladePage& b) {
        return std::memcmp(&a, &b, sizeof(a)) == 0;
    };
    if (!std::equal(placed.begin(), placed.end(), placed_.begin(), placed_.end(), same)) {
        placed_ = std::move(placed);
        pages_.upload(placed_.data(), placed_.size() * sizeof(shared::BladePage));
    }
    std::vector<bool> write(marked_.size(), false);
    for (const int slot : fresh) {
        write[static_cast<std::size_t>(slot)] = true;
    }
    for (std::size_t slot = 0; slot < marked_.size(); ++slot) {
        write[slot] = write[slot] || marked_[slot] != (placed_[slot].blades > 0);
    }
    for (std::size_t first = 0, last = 0; first < write.size();
         first = last + 1) { // neighbours at once: there may be many
        for (last = first; last < write.size() && write[last]; ++last) {
        }
        if (last > first) {
            mark(first, last);
        }
    }
}

void PhysicsPass::mark(std::size_t first, std::size_t last) {
    const auto stride = static_cast<std::size_t>(patches_a_page_);
    std::vector<shared::PatchState> states((last - first) * stride,
                                           {{0, 0}, shared::kPatchFree, 0});
    for (std::size_t slot = first; slot < last; ++slot) {
        const auto filled =
            static_cast<std::size_t>((placed_[slot].blades + CULL_GROUP - 1) / CULL_GROUP);
        for (std::size_t n = 0; n < filled; ++n) {
            states[(slot - first) * stride + n].status = shared::kPatchNew;
        }
        marked_[slot] = filled > 0;
    }
    patches_.upload(states.data(), states.size() * sizeof(shared::PatchState),
                    first * stride * sizeof(shared::PatchState));
}

void PhysicsPass::step(const shared::BladeStep& rules, const shared::WindField& wind,
                       const SphereLists& spheres) {
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
    const decltype(Dispatch::lists) none;
    dispatch_.upload(none.data(), sizeof(none)); // what follows the lists stays
    records.bind_storage(BIND_PHYSICS_BLADES);
    glBindTextureUnit(TEX_PHYSICS_BLADES, record_textures_[static_cast<std::size_t>(number)]);
    wake_.use();
    wake_.set("patch_count", patch_count_);
    wake_.set("patches_a_page", patches_a_page_);
    wake_.set("buffer_number", number);
    glDispatchCompute(static_cast<GLuint>((patch_count_ + WAKE_GROUP - 1) / WAKE_GROUP), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, dispatch_.id());
    for (std::uint32_t list = 0; list < shared::kPatchLists; ++list) {
        const gl::Program& step = steps_[steps_.size() > 1 ? list : 0];
        step.use();
        step.set("patches_a_page", patches_a_page_);
        step.set("list_begin", static_cast<int>(list) * patch_count_);
        glDispatchComputeIndirect(static_cast<GLintptr>(list * sizeof(Dispatch::Groups)));
    }
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
    return std::accumulate(dispatch.stepped.begin(), dispatch.stepped.end(), std::uint64_t{0});
}

std::vector<std::uint32_t> PhysicsPass::listed(std::uint32_t list) const {
    Dispatch dispatch;
    dispatch_.read(&dispatch, sizeof(dispatch));
    std::vector<shared::AwakePatch> entries(dispatch.lists[list].x);
    awake_.read(entries.data(), entries.size() * sizeof(shared::AwakePatch),
                list * static_cast<std::size_t>(patch_count_) * sizeof(shared::AwakePatch));
    std::vector<std::uint32_t> out;
    for (const shared::AwakePatch& entry : entries) {
        out.push_back(entry.number);
    }
    return out;
}

std::size_t PhysicsPass::bytes() const {
    std::size_t sum = 0;
    for (const gl::Buffer* buffer : {&records_, &places_, &pages_, &states_, &patches_, &awake_,
                                     &dispatch_, &lists_, &spheres_, &block_}) {
        sum += buffer->bytes();
    }
    return sum;
}

void PhysicsPass::reload() {
    wake_.reload();
    for (gl::Program& step : steps_) {
        step.reload();
    }
}

} // namespace sward::blades
