// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "sward/blower.h"
#include "sward/error.h"

namespace sward {

/// Heights on a grid of posts, row by row from the north-west. Post (i, j) stands at x = (i -
/// (width - 1) / 2) * spacing_m.x, z = (j - (height - 1) / 2) * spacing_m.y.
struct Elevation {
    int width = 0, height = 0;  ///< posts, at least 2 each way
    glm::dvec2 spacing_m{1, 1}; ///< above 0
    std::vector<float> metres;  ///< width * height, above the datum, finite
};

/// How much grass stands where, over the elevation's posts from the first to the last; row 0 is the
/// north.
struct Density {
    int width = 0, height = 0;
    std::vector<float> share; ///< width * height, 0 to 1
};

/// Triangles, metres, y up. Counter-clockwise is outside.
struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; ///< one a position, of length 1
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What a field is made of: a scene file, and in the place of the files that it names what the host
/// has read already. By itself Sward's core reads elevation from .hgt, .raw and .r16, and baked
/// grass sets; no pictures and no meshes.
struct FieldSource {
    std::filesystem::path scene;        ///< a scene file (docs/scene.md)
    std::filesystem::path grass_set;    ///< a set's directory, as texgen writes it; empty: the
                                        ///< scene's, where that names a directory
    std::optional<Elevation> elevation; ///< the ground, else the scene's file
    std::optional<Density> density;     ///< in the place of the scene's mask
    std::map<std::string, Mesh>
        meshes; ///< of obstacles, objects and terrain.surface, under the scene's names for them
    std::map<std::string, std::vector<glm::vec4>>
        spheres; ///< those meshes that grass feels as balls: x, y, z, radius (m)
    /// Where Sward's shaders are, of the whole process; empty: beside the program
    /// (../share/sward/shaders), else where Sward was built. The installed package sets it. The
    /// environment's SWARD_SHADERS goes before.
#ifdef SWARD_INSTALLED_SHADERS
    std::filesystem::path shaders = SWARD_INSTALLED_SHADERS;
#else
    std::filesystem::path shaders;
#endif
};

struct Sun {
    double azimuth_deg = 135;  ///< where it stands, clockwise from north; any
    double elevation_deg = 35; ///< -90 to 90
};

/// The wind as a weather report has it.
struct MeanWind {
    double speed_mps = 4;       ///< 0 to 60
    double direction_deg = 270; ///< where it comes from; any
    double gust = 0.4;          ///< 0 steady to 1 violent
};

/// A stroke of moving air, from its root to its tip (m, world x and z). Arrows with a parent go on
/// from that one's tip.
struct Arrow {
    std::string id, parent; ///< the parent's id; empty: none
    glm::dvec2 root{0}, tip{0};
    double strength_mps = 0; ///< that the air is brought to
    double radius_m = 1;     ///< above 0
    double start_s = 0, end_s = std::numeric_limits<double>::infinity();
};

/// Something round that pushes blades aside.
struct Ball {
    glm::dvec3 centre{0}; ///< world space (m)
    double radius_m = 0;  ///< above 0
};

/// Where one of the scene's objects stands: its own frame (x right, y up, z back) to the world.
struct Body {
    std::size_t object = 0; ///< by its place among the scene's [[object]], from 0
    glm::dmat4 world_from_body{1};
};

/// What has passed through the grass of a place, in a scene with [tracks] (docs/tracks.md): of the
/// cell that holds it.
struct Passed {
    /// Bend that springs back, along world x (east) and z (south): its length is the share of a
    /// right angle that a stem's tip is turned by, 0 to 1.
    glm::dvec2 bend{0};
    /// Stems that lie: along which way (east, south); the length is their share, 0 to 1.
    glm::dvec2 pressed{0};
};

/// What a simulated frame may cost. The defaults keep it exact.
struct SimulationLimits {
    bool living_blades =
        true; ///< blades near the eyes have a state; else all bend with the wind alone
    double living_radius_m = 8; ///< around an eye, 0 or more; memory and time grow with its square
    std::size_t most_living_bytes =
        64ull << 20;          ///< 16 a blade; when they are spent the farthest blades go without
    int most_blade_steps = 0; ///< of 1/60 s, 0: any number; earlier ones are left out
    int most_wind_steps = 0;  ///< of the local window, 0: any number; the window then lags behind
};

namespace render {
struct FieldInside;
struct Access;
} // namespace render

/// A land with its grass, its wind and what moves in it: simulated once a frame, drawn by any
/// number of views. Made of a scene; needs an OpenGL 4.5 core context, current on the calling
/// thread, in prepare() and everything after it, and at its end. No thread is started. Every call
/// leaves the context's state as it was (docs/embedding.md names what it cannot hold). Throws
/// Error.
class Field {
public:
    /// Takes note of what it will be made of. Throws nothing; reads nothing.
    explicit Field(FieldSource source);
    ~Field();
    Field(Field&&) noexcept;
    Field& operator=(Field&&) noexcept;

    /// Does the next step of loading and says what share is left, 0 to 1; 0: ready, and nothing is
    /// done. Steps take from milliseconds to seconds; a host spreads them over frames, or over a
    /// thread with a context that shares with its own. Whatever needs a field that is ready does
    /// the steps that are left. Throws Error of any kind; the next call tries the step again.
    double prepare();

    /// Brings wind, blades and what touches them to a time (s, 0 or more) in whole steps: once a
    /// frame, whatever the number of views, before they draw. `eyes`: where they look from (eye_of;
    /// world space), one or more: blades live around all of them, the wind's local window stands
    /// around the first. The same eyes and times give the same bits. Going back begins anew. Throws
    /// Error(kBadInput) for a number that is not finite or no eye.
    void simulate(double time_s, std::span<const glm::dvec3> eyes,
                  const SimulationLimits& limits = {});

    /// The sun from the next picture on. The far field's light and the shadow of the hills follow
    /// within some frames, by a part each.
    void set_sun(const Sun& sun);
    /// The mean wind from the present time on: its speed at once, its gusts within seconds, none of
    /// which stops a frame. Some time later what blows is what would blow had the scene begun so.
    void set_wind(const MeanWind& wind);
    /// These arrows in the place of the scene's from the next step on. Throws Error(kBadInput)
    /// where a parent is missing or chains do not end.
    void set_arrows(std::span<const Arrow> arrows);
    /// Balls that the host drives, as at `time_s`, the time of the next simulate(). Those of the
    /// same number in the call before came from there.
    void set_colliders(std::span<const Ball> balls, double time_s);
    /// What moves the air beside the scene's own sources, from the next step on, as at `time_s`:
    /// before and after that each is on the straight line of its velocity. In the place of those of
    /// the call before; none: nothing. While there is one the wind's local window is simulated, a
    /// small one (wind.moving_cells) where nothing else is local.
    /// Throws Error(kBadInput) for a number that is not finite or out of its range.
    void set_blowers(std::span<const Blower> blowers, double time_s);
    /// Share of the set's blades that stand, 0 to 1, from the next picture on. Throws Error(kUsage)
    /// in a scene on a mesh.
    void set_density(double share);
    /// Where objects of the scene stand from now on, as at `time_s`; those that are not named stay.
    /// Grass that feels them feels their way from the call before.
    void set_objects(std::span<const Body> bodies, double time_s);

    /// Height of the ground that is drawn (m above the datum) at world x, z; past the rim its
    /// height goes on. 0 in a scene on a mesh.
    [[nodiscard]] double ground_height(double x, double z) const;
    /// Wind (m/s; east, south) at world x, z and a time near that of simulate(), as far as it has
    /// come back from the GPU: a frame or two late. Never waits.
    [[nodiscard]] glm::dvec2 wind_at(double x, double z, double time_s) const;
    /// What has passed at world x, z, as of the last simulate(); zeros where nothing has. Where the
    /// scene keeps no page, only what lies. Waits for the GPU: for a few places a frame. Throws
    /// Error(kUsage) for a scene without [tracks], Error(kBadInput) for a number that is not
    /// finite.
    [[nodiscard]] Passed tracks_at(double x, double z) const;

private:
    friend struct render::Access;
    std::shared_ptr<render::FieldInside> inside_;
};

} // namespace sward
