// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/land.h"
#include "scene/surface_grass.h"
#include "scene/track_spec.h"
#include "scene/wind_spec.h"

namespace sward::scene {

/// A pose as files and options write it: metres and degrees. yaw 0 looks north (-z), positive to
/// the east; pitch positive looks up.
struct Pose {
    glm::dvec3 position{0, 1.7, 0};
    double yaw_deg = 0;
    double pitch_deg = 0;
    bool agl = true;     ///< position.y is above the ground; else above the datum
    double fov_deg = 60; ///< vertical
    /// Latitude and longitude (degrees, WGS 84) that x and z are to be taken from; settle_places
    /// does it.
    std::optional<glm::dvec2> geo;
};

struct PathKey {
    double t_s = 0;
    glm::dvec3 position{0, 0, 0};
    double yaw_deg = 0;
    double pitch_deg = 0;
    std::optional<glm::dvec2> geo{}; ///< as of a Pose
};

/// Keys in rising time; Catmull-Rom in position, shortest turn in yaw; held at both ends.
struct Path {
    std::vector<PathKey> keys;
    bool agl = true;
    double fov_deg = 60;
};
[[nodiscard]] Pose sample_path(const Path& path, double time_s);

struct TerrainSpec {
    std::filesystem::path elevation; ///< resolved against the scene's directory
    std::optional<glm::dvec2> size_m;
    std::optional<glm::dvec2> height_m;
    std::filesystem::path mask; ///< empty: the slope rule
    /// Landcover: what the mask's integer values stand for (values not listed: nothing on soil).
    /// Empty: the mask is the density.
    std::map<int, LandClass> classes;
    double detail_m = 0.5;         ///< amplitude of procedural relief; 0 = none
    std::filesystem::path surface; ///< a mesh instead of elevation; the datum is its own y = 0
    int elevation_band =
        0; ///< of the file's bands, from 1; 0: the first, with a warning where there are more
    int mask_band = 0;
    std::vector<LandFeature> features{}; ///< burnt over the classes in this order
    std::optional<LandClass> outside{};  ///< what goes on beyond the mask; none: no grass
    double classes_mb = 128;             ///< bound of what classes take of the graphics memory

    [[nodiscard]] bool has_mask() const { return !mask.empty() || !features.empty(); }
    /// Is there more to the land than a density?
    [[nodiscard]] bool has_land() const {
        const auto rich = [](const auto& entry) { return !entry.second.plain(); };
        return !features.empty() || outside || std::any_of(classes.begin(), classes.end(), rich);
    }
};

struct GrassSpec {
    std::string set = "meadow.toml"; ///< as written; the app resolves it to a set directory
    double density = 1.0;            ///< scale of the set's blades per square metre, 0..1
};

struct SunSpec {
    double azimuth_deg = 135; ///< clockwise from north, where the sun stands
    double elevation_deg = 35;
};

struct AirSpec {
    double visibility_km = 60; ///< over the lowest ground: where the air leaves 2 % of a dark
                               ///< thing's contrast to the sky
};

enum class ObjectKind { kSphere, kMesh, kVehicle, kRotor };
inline constexpr std::array<const char*, 4> kObjectKindNames = {"sphere", "mesh", "vehicle",
                                                                "rotor"};

struct ObjectSpec {
    ObjectKind kind = ObjectKind::kSphere;
    double radius_m = 0.5;
    std::filesystem::path mesh;
    glm::dvec3 position{0, 0, 0};
    bool agl =
        true; ///< position.y is above the ground; else above the datum. A path says so itself
    double yaw_deg = 0;
    std::string path;                    ///< name of a [path.*], or empty
    glm::dvec3 colour{0.45, 0.42, 0.38}; ///< linear reflectance
    bool collides = true;                ///< grass feels it
    int most_spheres = 256;              ///< that a mesh which grass feels is packed with
    std::optional<glm::dvec2> geo{};     ///< as of a Pose
};

/// Overrides of the tiers' distances; unset means by projected size.
struct LodSpec {
    std::optional<double> handover_start_m, handover_end_m; ///< band from blades to shells
    std::optional<double> far_end_m; ///< where the last shells and slices end
};

struct Scene {
    std::filesystem::path file;
    TerrainSpec terrain;
    GrassSpec grass;
    SurfaceGrassSpec surface_grass; ///< of terrain.surface
    SunSpec sun;
    AirSpec air;
    WindSpec wind;
    std::optional<TrackSpec> tracks; ///< none: nothing stays
    std::vector<ObjectSpec> objects;
    std::map<std::string, Pose> cameras;
    std::map<std::string, Path> paths;
    LodSpec lod;
};

/// Where an object stands at a time, turned by its own yaw; `agl` as its path or itself says.
[[nodiscard]] Pose object_pose(const ObjectSpec& object, const std::map<std::string, Path>& paths,
                               double time_s);

/// Reads a scene file (TOML, docs/scene.md). Throws Error that names file, line, key, found and
/// expected; an unknown key names the nearest known one. Files that the scene names are not opened
/// here.
[[nodiscard]] Scene load_scene(const std::filesystem::path& file);
/// The same from a text; `file` is where it stands or will, for messages and the names in it.
[[nodiscard]] Scene parse_scene(const std::string& text, const std::filesystem::path& file);

/// x, z of a latitude and longitude (degrees) in the terrain's frame.
using PlaceOnEarth = std::function<glm::dvec2(double latitude_deg, double longitude_deg)>;
/// Gives every camera, path and object whose place is a latitude and longitude its x and z.
/// `on_earth` is null where the terrain has no place on Earth; then Error(kBadInput) where one is
/// needed.
void settle_places(Scene& scene, const PlaceOnEarth& on_earth);
/// The same for one pose; `what` names it in the error, which is of the command line (kUsage) where
/// it is an option.
void settle_place(Pose& pose, const PlaceOnEarth& on_earth, const std::string& what);

/// "x,y,z,yaw,pitch" (y above the ground) or "abs:x,y,z,yaw,pitch" (y above the datum), in the C
/// locale whatever the environment says; with "geo:" in front of the numbers,
/// LAT,LON,HEIGHT,YAW,PITCH (Pose::geo). Throws Error(kUsage) naming `option`. Ranges as in scene
/// files.
[[nodiscard]] Pose parse_pose(const std::string& text, const std::string& option);
/// The same form, for --camera: parse_pose(format_pose(p)) == p to a millimetre and a thousandth of
/// a degree.
[[nodiscard]] std::string format_pose(const Pose& pose);

} // namespace sward::scene
