// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blades/cull_pass.h"
#include "blades/physics_pass.h"
#include "blades/sample_cull.h"
#include "gl/program.h"

namespace sward::blades {

/// Draws culled blades by tessellation (J8), in their simulated pose (J4) or bent by W3, and moved
/// to their shell pose in the band; those of a mesh (`surface`) likewise, with no band. Before:
/// frame constants, clipmap, the blades and a culled batch are bound.
class DrawPass {
public:
    explicit DrawPass(bool aov, bool surface = false);
    ~DrawPass();
    DrawPass(const DrawPass&) = delete;
    DrawPass& operator=(const DrawPass&) = delete;
    /// `living`: null where no blade lives.
    void execute(const CullPass& culled, const PhysicsPass* living = nullptr);
    void execute(const SampleCull& culled, const PhysicsPass* living = nullptr);
    [[nodiscard]] const gl::Program& program() const { return program_; }
    void reload() { program_.reload(); }

private:
    void draw(const gl::Buffer& survivors, const gl::Buffer& commands, int count,
              const PhysicsPass* living);
    gl::Program program_;
    std::uint32_t vertex_array_ = 0; // no attributes: core profile wants one bound all the same
};

} // namespace sward::blades
