// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <glm/glm.hpp>

#include "gl/buffer.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "shells/march_textures.h"
#include "shells/surface_canopy.h"
#include "terrain/terrain_pass.h"

namespace sward::shells {

/// Where rays enter the canopy: its upper surface's depth, and the ground and the air there.
class CanopyTargets {
public:
    /// `samples` a pixel of the scene has, for depth of its own; 0: none is kept.
    void require(int width, int height, int samples = 0);
    void bind_for_drawing() const { surface_.bind(depth_.shape().width, depth_.shape().height); }
    void bind_samples_for_drawing() const {
        samples_.bind(depth_.shape().width, depth_.shape().height);
    }
    /// At units from TEX_CANOPY_DEPTH or TEX_SECOND_DEPTH on.
    void bind_textures(std::uint32_t first) const;
    [[nodiscard]] const gl::Texture& depth() const { return depth_; }
    /// Where the scene's samples lie in a pixel, 0..1: x of four, then y. Fewer count more than
    /// once.
    [[nodiscard]] const std::array<glm::vec4, 2>& places() const { return places_; }
    [[nodiscard]] const gl::Texture& ground() const { return ground_; }

private:
    void find_places(int samples);
    gl::Texture depth_, ground_, air_;
    gl::Texture sample_depth_;
    gl::Framebuffer surface_, samples_;
    std::array<glm::vec4, 2> places_{glm::vec4(0.5f), glm::vec4(0.5f)};
};

/// The same of a mesh's canopy, which a ray may leave and meet again: where it enters first and
/// next. `exit` holds in place of the ground, for either, how long the way is from there to the
/// ground or out again, and how high over the ground it ends (m); 0: it was not found.
struct SurfaceTargets {
    CanopyTargets first, exit, second;
    void require(int width, int height);
    void bind_textures() const;
};

/// Draws the far field: one ray a pixel, marched through the canopy (docs/far-field.md). First each
/// pixel's kind of march is chosen, as a depth; then each kind is drawn over its own pixels.
class MarchPass {
public:
    /// `surface`: over a mesh.
    MarchPass(bool aov, bool surface, bool land);
    ~MarchPass();
    MarchPass(const MarchPass&) = delete;
    MarchPass& operator=(const MarchPass&) = delete;

    /// The canopy's upper surface over the visible blocks. Before: frame constants and block
    /// samples are bound. After: another framebuffer is.
    void draw_canopy(const CanopyTargets& targets, int blocks, const terrain::BlockMesh& mesh);

    /// A mesh's, its space's origin at `origin` (anchor-relative); `apart_m`: its parts are at
    /// least so far apart along a ray.
    void draw_surface(const SurfaceTargets& targets, const SurfaceCanopy& mesh, glm::vec3 origin,
                      float apart_m);

    struct Inputs {
        const MarchTextures& textures;
        const CanopyTargets& canopy;
        const SurfaceTargets* surface = nullptr; ///< over a mesh; `canopy` is its first
        glm::vec3 origin{0};                     ///< of the mesh's space, anchor-relative
        int samples = 1;                         ///< a pixel of the scene has
        float eye_height_m = 0;                  ///< over the ground
        bool fine = false;  ///< ground finer than the clipmap: Clipmap::bind_posts came before
        bool count = false; ///< steps and reads, at the cost of two atomic additions a pixel
    };
    /// Chooses the kinds, into the depth of the framebuffer that is bound. Before: frame constants
    /// and clipmap are bound.
    void choose(const Inputs& inputs);
    /// Resolves the scene, seen through the far field, where there is any. Before: choose(), and
    /// the scene's textures and the resolved targets are bound.
    void execute(const Inputs& inputs);
    /// Pixels of the last execute() that were marched through slabs (x) and columns (y); waits for
    /// the GPU.
    [[nodiscard]] glm::uvec2 pixels() const;
    /// Steps of the last execute() that counted, and texels that it and the choice read; waits for
    /// the GPU.
    [[nodiscard]] glm::uvec2 work() const;
    void reload();

private:
    /// Of the march's programs. `fine`: ground finer than the clipmap.
    struct Variant {
        bool aov, surface, land, count, fine;
        [[nodiscard]] std::vector<std::string> with(std::vector<std::string> defines) const;
    };
    struct Kinds {
        explicit Kinds(const Variant& variant);
        gl::Program columns, slabs; ///< of rays that end in the canopy
        gl::Program crests; ///< of those that may leave it and come to another, whatever their kind
        void reload();
    };
    void draw_kind(int kind, const gl::Program& plain, const gl::Program& crest,
                   const Inputs& inputs) const;
    void triangle(const gl::Program& program, const Inputs& inputs, float plane) const;
    [[nodiscard]] const Kinds& kinds_for(const Inputs& inputs);
    gl::Program canopy_, canopy_samples_, choose_;
    std::unique_ptr<gl::Program> fine_choose_; ///< with FINE_GROUND, made when first asked for
    Kinds kinds_;
    std::array<std::unique_ptr<Kinds>, 3> others_; ///< counting, fine, both: likewise
    bool aov_, surface_, land_;
    gl::Buffer counts_;
    std::uint32_t vertex_array_ = 0;
    std::array<std::uint32_t, 2> queries_{}; ///< samples passed: slabs, columns
};

} // namespace sward::shells
