// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "blades/colliders.h"
#include "blades/simulation.h"
#include "gl/pass.h"
#include "lod/lod.h"
#include "render/atmosphere.h"
#include "render/draw_passes.h"
#include "render/ground.h"
#include "render/lens.h"
#include "render/objects.h"
#include "render/settings.h"
#include "shells/far_appearance.h"
#include "shells/far_textures.h"
#include "shells/march_light.h"
#include "shells/march_textures.h"
#include "terrain/clipmap.h"
#include "terrain/detail.h"
#include "terrain/terrain_pass.h"
#include "tracks/tracks.h"
#include "wind/sources.h"
#include "wind/wind.h"

namespace sward::render {

struct ViewState;

/// What one picture of a frame is drawn with: a still has one, the reference one per jitter.
struct Shot {
    glm::dvec3 anchor{0};
    lod::Bands bands;
    shared::FrameConstants constants{};
    terrain::Detail detail;
};

/// What sward::Field holds: a world, its simulation and its textures, for any number of views.
/// Needs the context that it was made in, or one that shares with it.
struct FieldState {
    explicit FieldState(World inputs);

    /// Pages of living blades in and out, whole steps of the wind and the blades up to the time (s,
    /// from 0): once a frame, for the views that draw it from these eyes (world metres; one or
    /// more). Throws Error(kBadInput) for a time or place that is not finite.
    void simulate(double time_s, std::span<const glm::dvec3> eyes,
                  const SimulationSettings& settings);

    /// Constants of a picture of the field as it now is, whose ground is `clipmap`'s. `jitter` in
    /// pixels.
    [[nodiscard]] Shot make_shot(const terrain::Clipmap& clipmap, const Lens& lens,
                                 const FrameSettings& settings, glm::dvec2 jitter) const;
    /// The blades that live since simulate(); null where none does.
    [[nodiscard]] const blades::LivingBlades* living() const {
        return lives_ ? ground->living() : nullptr;
    }
    [[nodiscard]] DrawPasses& passes(bool aov);
    /// The march's light, brought up to date: by a part a frame, whichever view asks first.
    void follow_light(const shared::Light& light, const shared::WindField& wind);

    [[nodiscard]] glm::dvec3 to_sun() const; ///< unit
    /// The shadow of the land likewise; nothing on a mesh.
    void follow_shadow();

    /// Throw Error(kBadInput); (kUsage) where a scene on a mesh has been placed for good.
    void set_density(double density);
    void check_object(std::size_t object, const glm::dmat4& world_from_object) const;
    /// As at `when_s`. Before: check_object.
    void set_object(std::size_t object, const glm::dmat4& world_from_object, double when_s);

    /// Recompiles programs whose source changed; adds messages of those that failed (the old
    /// program stays).
    void reload(std::vector<std::string>& failures);
    /// Adds what the simulation counted and took.
    void add_stats(FrameStats& stats) const;

    /// The wind's inputs, which the field made.
    [[nodiscard]] wind::Sources& sources() const {
        return static_cast<wind::Sources&>(*wind.inputs());
    }

    World world;
    double response; ///< bend per m/s of the set's mean blade
    terrain::Surface surface;
    std::shared_ptr<terrain::GroundSource> posts; ///< that clipmaps are filled from
    mutable Atmosphere atmosphere;                ///< keeps the last sun's light
    wind::Wind wind;
    shells::MarchTextures march_textures;
    shells::FarTextures far_textures; ///< of the raster schemes, where the world wants them
    shells::FarAppearance far_appearance;
    terrain::BlockMesh block_mesh;
    blades::Colliders colliders;
    std::unique_ptr<Ground> ground;
    std::unique_ptr<tracks::Tracks> tracks; ///< of a scene that has some
    Objects objects;
    mutable gl::PassTimers timers; ///< of simulate(); reading their queries changes nothing
    double time_s = 0;
    const ViewState* counted = nullptr; ///< the view drawn last: the passes' counters are its
    int reloads = 0;                    ///< of the shaders that clipmaps share
    bool light_at_once = false; ///< a change of light is followed whole by the next picture: none
                                ///< then depends on how many were drawn before

private:
    [[nodiscard]] blades::LivingBlades* wake(const SimulationSettings& settings, int eyes);
    [[nodiscard]] double away_from_eyes(glm::dvec3 place) const;

    void light_shot(shared::FrameConstants& out, const glm::dvec3& eye) const;
    void track(double time_s, std::span<const glm::dvec3> eyes);

    bool lives_ = false; ///< the last simulate() wanted it
    std::vector<glm::dvec3> eyes_;
    int rooms_ = 0;                             ///< for so many eyes' living blades
    std::unique_ptr<terrain::Clipmap> clipmap_; ///< the ground that blades meet colliders on
    gl::Buffer frame_buffer_;
    std::unique_ptr<DrawPasses> plain_passes_, aov_passes_;
    shells::MarchLight march_light_;
    bool light_followed_ = false, shadow_followed_ = false; ///< since simulate()
};

/// Whether the reference's blades are culled by its samples, so many a pixel.
[[nodiscard]] inline bool samples_decide(const FrameSettings& settings, int samples) {
    return settings.tiers == Tiers::kReference && settings.cull.samples &&
           samples <= shared::kMostSamples;
}

/// Whether a picture shows blades that may live.
[[nodiscard]] inline bool draws_blades(const FrameSettings& settings) {
    return settings.blades && settings.tiers != Tiers::kShells;
}

} // namespace sward::render
