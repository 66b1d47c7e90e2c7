// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "blades/simulation.h"
#include "render/settings.h"
#include "shared/bindings.h"
#include "shared/frame.h"
#include "terrain/clipmap.h"

namespace sward::render {

using CullCounts = std::array<std::uint32_t, CULL_COUNTS>; ///< by CULL_*

class GroundPicture;
struct PictureContext;

/// What a field's grass stands on, with the blades near an eye: elevation (elevation_ground.h) or a
/// mesh (mesh_ground.h). One for all views; what a picture draws of it is a GroundPicture. The
/// field, which makes it, is the only place that asks which of the two a scene has.
class Ground {
public:
    Ground() = default;
    virtual ~Ground() = default;
    Ground(const Ground&) = delete;
    Ground& operator=(const Ground&) = delete;

    /// For one frame of a view; both outlive it.
    [[nodiscard]] virtual std::unique_ptr<GroundPicture> picture(PictureContext& context) = 0;
    /// Sets what the frame constants hold of it. `far_field`: the march is drawn.
    virtual void describe(shared::FrameConstants& frame, glm::dvec2 anchor,
                          bool far_field) const = 0;
    /// The land's shadow: brings it up to date, and binds it.
    virtual void follow_sun(glm::dvec3 /*to_sun*/, bool /*at_once*/) {}
    virtual void bind_shadow() const {}

    /// There is a far field.
    [[nodiscard]] virtual bool has_far() const = 0;
    /// That lies on charts of a mesh: its shaders are the SURFACE variants.
    [[nodiscard]] virtual bool on_charts() const = 0;
    /// It has a far field and no blades.
    [[nodiscard]] virtual bool far_alone() const = 0;
    /// Density cannot change any more.
    [[nodiscard]] virtual bool placed_for_good() const = 0;
    [[nodiscard]] virtual double blade_width_m() const = 0; ///< of a mean one

    /// Its blades could live.
    [[nodiscard]] virtual bool has_blades() const = 0;
    /// Null until make_living(), which makes them anew.
    [[nodiscard]] virtual blades::LivingBlades* living() = 0;
    virtual void make_living(const blades::LivingBlades::Settings& settings) = 0;
    /// Binds the ground that blades meet colliders on, as it is drawn at `eye` (x, z).
    virtual void bind_under_blades(terrain::Clipmap& /*clipmap*/, glm::dvec2 /*eye*/) const {}

    /// Adds what it took.
    virtual void add_stats(FrameStats& /*stats*/) const {}
    /// Of the picture drawn last. `sampled`: samples_decide(). Waits for the GPU.
    [[nodiscard]] virtual CullCounts cull_counts(bool sampled) const = 0;
    /// Recompiles what has changed; adds messages of what failed (the old program stays).
    virtual void reload(std::vector<std::string>& failures) = 0;
};

/// Of the set's mean blade.
[[nodiscard]] double mean_blade_width_m(const grass::GrassSet& set);

} // namespace sward::render
