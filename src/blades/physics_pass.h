// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blades/colliders.h"
#include "blades/pages.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "shared/bindings.h"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"
#include "shared/wind.h"

namespace sward::blades {

/// Which programs step the patches: one a list of the awake ones, or for all lists one that does by
/// branches whatever comes. The bits are the same; the second is there for the bench to compare
/// with.
enum class StepPrograms { kThree, kOne };

/// The states of living blades on the GPU and one fixed step of them (J4 to J6): a pass finds the
/// patches that are awake and sorts them into three lists, those that no collider meets, those that
/// one may meet, and new ones; then each list's program steps them, by an indirect dispatch.
/// Patches at rest cost a test each. 16 bytes a blade and 200 a patch; the blades' records are the
/// set's own, once, or those that a mesh is drawn from.
class PhysicsPass {
public:
    PhysicsPass(const grass::GrassSet& set, const Pages& pages,
                StepPrograms programs = StepPrograms::kThree);
    /// Of a mesh, a slot a cluster. `records`: buffers of SurfaceBlade that outlive this; a page
    /// says which.
    PhysicsPass(std::vector<const gl::Buffer*> records, std::size_t slots,
                StepPrograms programs = StepPrograms::kThree);
    ~PhysicsPass();
    PhysicsPass(const PhysicsPass&) = delete;
    PhysicsPass& operator=(const PhysicsPass&) = delete;

    /// Brings the slots' places for an anchor (world metres) to the GPU, and marks new and free
    /// patches. After every Pages::update.
    void place(const Pages& pages, double side_m, glm::dvec3 anchor);
    /// The same from pages as the GPU takes them, one a slot; `fresh`: slots whose blades begin
    /// anew.
    void place(std::vector<shared::BladePage> pages, std::span<const int> fresh);
    /// One step, of the patches that are awake or that something touches. Before: frame constants,
    /// clipmap and wind are bound.
    void step(const shared::BladeStep& rules, const shared::WindField& wind,
              const SphereLists& spheres);
    /// What the drawing of blades reads.
    void bind_for_drawing() const;

    [[nodiscard]] int blades_a_page() const { return patches_a_page_ * CULL_GROUP; }
    /// Patches that steps worked on since the count began. Waits for the GPU.
    [[nodiscard]] std::uint64_t stepped_patches() const;
    /// Patches of one of the lists (shared::kListFree and so on) in the last step, of the last
    /// buffer of records. Waits for the GPU.
    [[nodiscard]] std::vector<std::uint32_t> listed(std::uint32_t list) const;
    void begin_count();
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] const gl::Buffer& states() const { return states_; }
    [[nodiscard]] const gl::Buffer& patches() const { return patches_; }
    void reload();

private:
    void make_textures();
    void mark(std::size_t first, std::size_t last); ///< sets up the patches of slots
    void step_records(const gl::Buffer& records, int number);
    int patches_a_page_, patch_count_;
    std::vector<shared::BladePage> placed_;
    std::vector<bool> marked_;                       ///< slots whose patches are not free
    std::vector<const gl::Buffer*> records_of_mesh_; ///< empty: records_
    std::vector<std::uint32_t> variant_begin_;
    gl::Program wake_;
    std::vector<gl::Program> steps_;             ///< one a list, or one for all
    std::vector<std::uint32_t> record_textures_; ///< of records_ or each of a mesh's
    gl::Buffer records_, places_, pages_, states_, patches_, awake_, dispatch_, lists_, spheres_,
        block_;
};

} // namespace sward::blades
