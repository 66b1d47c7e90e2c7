// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/scene.h"
#include "scene/toml_reader.h"

namespace sward::scene {

/// One function a section of the scene file; each refuses the keys it does not know. docs/scene.md
/// is their table.
void read_terrain(TableReader table, TerrainSpec& terrain);
/// The keys of [terrain] that say what its classes stand for, and what is burnt over them. In
/// land_section.cpp.
void read_land(TableReader& table, TerrainSpec& terrain);
void read_grass(TableReader table, GrassSpec& grass);
/// [surface_grass]: grass on terrain.surface. In surface_section.cpp.
/// `of_set`: what a set that it names, and its density, are noted in.
void read_surface_grass(TableReader table, SurfaceGrassSpec& grass, GrassSpec& of_set);
/// A linear reflectance [r, g, b], each 0 to 1.
void read_colour(TableReader& table, const char* key, glm::dvec3& colour);
void read_sun(TableReader table, SunSpec& sun);
void read_air(TableReader table, AirSpec& air);
/// `paths` are the scene's: a source or obstacle that follows one must name one that exists.
void read_wind(TableReader table, const std::map<std::string, Path>& paths, WindSpec& wind);
/// [tracks]; in track_section.cpp. Paths as read_wind's.
void read_tracks(TableReader table, const std::map<std::string, Path>& paths, TrackSpec& tracks);
void read_lod(TableReader table, LodSpec& lod);
[[nodiscard]] Pose read_camera(TableReader table);
[[nodiscard]] Path read_path(TableReader table);
/// Refuses the name of a path that is not among `paths`; empty is none.
void check_path(const TableReader& table, const std::string& path,
                const std::map<std::string, Path>& paths);
/// `paths` are the scene's: an object that follows one must name one that exists.
[[nodiscard]] ObjectSpec read_object(TableReader table, const std::map<std::string, Path>& paths);

} // namespace sward::scene
