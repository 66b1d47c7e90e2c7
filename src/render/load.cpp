// SPDX-License-Identifier: Apache-2.0
#include "render/load.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gl/context.h"
#include "gl/shader_source.h"
#include "scene/core_elevation.h"

namespace sward::render {

namespace fs = std::filesystem;
using base::ExitCode;

namespace {

base::Error unfit(const char* what, const std::string& found, const char* expected) {
    return {ExitCode::kBadInput, fmt::format("{}: found {}, expected {}", what, found, expected)};
}

scene::Mesh mesh_of(const std::string& name, const Mesh& mesh) {
    if (mesh.positions.empty() || mesh.normals.size() != mesh.positions.size()) {
        throw unfit(
            ("mesh " + base::printable(name)).c_str(),
            fmt::format("{} positions, {} normals", mesh.positions.size(), mesh.normals.size()),
            "as many of both, one or more");
    }
    for (const glm::vec3& at : mesh.positions) {
        if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <=
              scene::kMostCoordinate_m)) {
            throw unfit(("mesh " + base::printable(name)).c_str(),
                        fmt::format("a corner at {}, {}, {}", at.x, at.y, at.z), "1e6 m at most");
        }
    }
    for (const auto& corners : mesh.triangles) {
        if (std::max({corners[0], corners[1], corners[2]}) >= mesh.positions.size()) {
            throw unfit(("mesh " + base::printable(name)).c_str(),
                        "a triangle with a corner that is none", "numbers of its positions");
        }
    }
    return {mesh.positions, mesh.normals, {}, mesh.triangles};
}

void read_scene(FieldInside& field, World& world) {
    world.scene = scene::load_scene(field.source.scene);
    const fs::path folder = world.scene.file.parent_path();
    for (const auto& [name, mesh] : field.source.meshes) {
        world.meshes.emplace(folder / name, mesh_of(name, mesh));
    }
    for (const auto& [name, balls] : field.source.spheres) {
        world.spheres.emplace(folder / name, scene::SphereSet{balls});
    }
    if (!world.scene.terrain.surface.empty()) {
        const auto surface = world.meshes.find(world.scene.terrain.surface);
        if (surface == world.meshes.end()) {
            throw base::input_error(ExitCode::kBadInput, world.scene.file, 0, "terrain.surface",
                                    "a mesh that the host has not given", "one of its meshes");
        }
        world.surface = surface->second;
    }
}

void read_ground(FieldInside& field, World& world) {
    if (!world.surface.triangles.empty()) {
        scene::settle_places(world.scene, {});
        return;
    }
    if (const auto& given = field.source.elevation) {
        const auto posts = static_cast<std::size_t>(std::max(given->width, 0)) *
                           static_cast<std::size_t>(std::max(given->height, 0));
        if (given->width < 2 || given->height < 2 || !(given->spacing_m.x > 0) ||
            !(given->spacing_m.y > 0) || given->metres.size() != posts ||
            !std::all_of(given->metres.begin(), given->metres.end(),
                         [](float m) { return std::isfinite(m); })) {
            throw unfit("elevation",
                        fmt::format("{} x {} posts, {} heights", given->width, given->height,
                                    given->metres.size()),
                        "at least 2 x 2, a finite height for each, spacing above 0");
        }
        world.elevation = {given->width, given->height, given->spacing_m, given->metres, {}};
    } else {
        world.elevation = scene::read_core_elevation(world.scene.terrain);
    }
    scene::PlaceOnEarth on_earth;
    if (world.elevation.origin && world.elevation.origin->crs.empty()) {
        on_earth = [frame = *world.elevation.origin](double latitude, double longitude) {
            return scene::linear_place(frame, latitude, longitude);
        };
    }
    scene::settle_places(world.scene, on_earth);
    if (const auto& given = field.source.density) {
        const auto texels = static_cast<std::size_t>(std::max(given->width, 0)) *
                            static_cast<std::size_t>(std::max(given->height, 0));
        if (texels == 0 || given->share.size() != texels ||
            !std::all_of(given->share.begin(), given->share.end(),
                         [](float s) { return s >= 0 && s <= 1; })) {
            throw unfit("density",
                        fmt::format("{} x {} texels, {} shares", given->width, given->height,
                                    given->share.size()),
                        "a share of 0 to 1 for each");
        }
        world.mask.width = given->width;
        world.mask.height = given->height;
        world.mask.density = given->share;
    } else if (!world.scene.terrain.mask.empty()) {
        throw base::input_error(ExitCode::kBadInput, world.scene.file, 0, "terrain.mask",
                                "a picture", "none, or the host's density");
    }
}

void read_grass(FieldInside& field, World& world) {
    const std::string& named =
        world.scene.terrain.surface.empty() ? world.scene.grass.set : world.scene.surface_grass.set;
    if (field.source.grass_set.empty() && !world.scene.terrain.surface.empty() && named.empty()) {
        return; // described by the scene
    }
    fs::path set = field.source.grass_set;
    std::error_code ignored;
    if (set.empty() && fs::is_directory(world.scene.file.parent_path() / named, ignored)) {
        set = world.scene.file.parent_path() / named;
    }
    if (set.empty()) {
        throw base::input_error(ExitCode::kBadInput, world.scene.file, 0, "grass.set", named,
                                "the directory of a baked set (texgen makes one of a preset)");
    }
    world.grass = grass::read_grass_set(set);
}

} // namespace

double load_step(FieldInside& field) {
    switch (field.done) {
    case 0: {
        if (!field.source.shaders.empty()) {
            gl::set_shader_directory(field.source.shaders);
        }
        World world;
        read_scene(field, world);
        field.world = std::move(world);
        break;
    }
    case 1:
        read_ground(field, *field.world);
        break;
    case 2:
        read_grass(field, *field.world);
        break;
    case 3:
        gl::require_gl45();
        try {
            field.state = std::make_shared<FieldState>(std::move(*field.world));
        } catch (...) {
            field.done = 0; // what was read is gone
            throw;
        }
        field.world.reset();
        field.source = {};
        break;
    case 4:
        static_cast<void>(field.state->passes(false));
        break;
    default:
        return 0;
    }
    ++field.done;
    return static_cast<double>(kLoadSteps - field.done) / kLoadSteps;
}

void check_arrows(const std::vector<scene::WindArrow>& arrows) {
    std::map<std::string, std::string> parents;
    for (const scene::WindArrow& arrow : arrows) {
        const bool finite = std::isfinite(arrow.root.x + arrow.root.y + arrow.tip.x + arrow.tip.y);
        if (!finite || !(arrow.radius_m > 0 && arrow.radius_m <= 1e6) ||
            !(std::abs(arrow.strength_mps) <= 1e4) || std::isnan(arrow.start_s + arrow.end_s)) {
            throw unfit(("arrow " + base::printable(arrow.id)).c_str(), "numbers out of range",
                        "finite places, a radius above 0, a speed");
        }
        if (!parents.emplace(arrow.id, arrow.parent).second) {
            throw unfit("arrows", "two named " + base::printable(arrow.id), "names of their own");
        }
    }
    for (const auto& [id, parent] : parents) {
        std::set<std::string> seen{id};
        for (std::string at = parent; !at.empty(); at = parents.at(at)) {
            if (!parents.contains(at) || !seen.insert(at).second) {
                throw unfit(("arrow " + base::printable(id)).c_str(),
                            "parent " + base::printable(at),
                            "another arrow's name, in a chain that ends");
            }
        }
    }
}

scene::MovingWindSource source_of(const Blower& blower, double time_s) {
    const bool finite = std::isfinite(blower.place.x + blower.place.y + blower.velocity.x +
                                      blower.velocity.y + blower.yaw_deg + time_s);
    const bool rotor = blower.kind == Blower::Kind::kRotor;
    if (!finite || !(blower.speed_mps >= 0 && blower.speed_mps <= 300) ||
        !(blower.radius_m >= 0.05 && blower.radius_m <= 1000) ||
        !(!rotor || (blower.height_m >= 0 && blower.height_m <= 1e6)) ||
        !(rotor || (blower.length_m >= 0.1 && blower.length_m <= 1e4)))
        throw unfit("blower", "numbers out of range",
                    "finite places, a speed of 0 to 300 m/s, a radius of 0.05 to 1000 m, a height "
                    "of 0 or more, a length of 0.1 to 10000 m");
    using Kind = scene::WindSource::Kind;
    scene::MovingWindSource moving;
    moving.source.kind = rotor                                ? Kind::kRotor
                         : blower.kind == Blower::Kind::kWake ? Kind::kWake
                                                              : Kind::kJet;
    moving.source.where.place = blower.place;
    moving.source.where.yaw_deg = blower.yaw_deg;
    moving.source.strength_mps = blower.speed_mps;
    moving.source.radius_m = blower.radius_m;
    moving.source.length_m = blower.length_m;
    if (rotor)
        moving.source.height_m = blower.height_m;
    moving.velocity_mps = blower.velocity;
    moving.time_s = time_s;
    return moving;
}

void check_textures(const HostTextures& host, int width, int height) {
    const auto check = [&](const char* what, std::uint32_t texture) {
        if (texture == 0) {
            return;
        }
        GLint found_width = 0, found_height = 0, target = 0;
        if (glIsTexture(texture) == GL_TRUE) {
            glGetTextureParameteriv(texture, GL_TEXTURE_TARGET, &target);
            glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_WIDTH, &found_width);
            glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_HEIGHT, &found_height);
        }
        if (target != GL_TEXTURE_2D || found_width != width || found_height != height) {
            throw unfit((std::string("target: ") + what).c_str(),
                        fmt::format("{} x {}, kind 0x{:x}", found_width, found_height, target),
                        "a GL_TEXTURE_2D of the picture's size");
        }
    };
    check("colour", host.colour);
    check("depth", host.depth);
    check("scene_colour", host.scene_colour);
    check("scene_depth", host.scene_depth);
    if (host.scene_colour != 0 && host.scene_depth == 0) {
        throw unfit("target: scene_depth", "none beside scene_colour",
                    "a depth: it says where the colour counts");
    }
}

} // namespace sward::render
