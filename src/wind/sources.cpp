// SPDX-License-Identifier: Apache-2.0
#include "wind/sources.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::wind {
namespace {

using shared::WindForce;
using shared::WindSolid;

constexpr std::size_t kMostGroups = 65535; // what GL promises an axis

template<class T, class Bounds>
TileBins bins_of(const std::vector<T>& things, Bounds bounds_of, const FluidGrid& grid) {
    std::vector<glm::vec4> bounds;
    bounds.reserve(things.size());
    for (const T& thing : things)
        bounds.push_back(bounds_of(thing));
    return bin_tiles(bounds, grid.cells, grid.cell_m);
}

std::vector<WindForce> those(const std::vector<WindForce>& forces,
                             bool (*wanted)(const WindForce&)) {
    std::vector<WindForce> out;
    std::copy_if(forces.begin(), forces.end(), std::back_inserter(out), wanted);
    return out;
}

bool same(const std::vector<WindSolid>& a, const std::vector<WindSolid>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(WindSolid)) == 0);
}

/// Speed of a solid's fastest point.
double speed_of(const WindSolid& solid) {
    const glm::vec4 bounds = solid_bounds(solid);
    const glm::vec2 place = solid.place;
    const glm::vec2 far = glm::max(glm::abs(glm::vec2(bounds) - place),
                                   glm::abs(glm::vec2(bounds.z, bounds.w) - place));
    return glm::length(solid.velocity) + std::abs(solid.turn_rad_s) * glm::length(far);
}

} // namespace

void BinnedList::put(gl::Buffer& buffer, const void* data, std::size_t bytes) {
    buffer.reserve(std::max<std::size_t>(bytes, 16)); // an empty buffer cannot be bound
    if (bytes > 0)
        buffer.upload(data, bytes);
}

void BinnedList::dispatch(const gl::Program& program, std::uint32_t things_binding) const {
    if (tile_count_ == 0)
        return;
    things_.bind_storage(things_binding);
    tiles_.bind_storage(BIND_WIND_TILES);
    items_.bind_storage(BIND_WIND_TILE_ITEMS);
    program.use();
    for (std::size_t first = 0; first < tile_count_; first += kMostGroups) {
        program.set("first_tile", static_cast<int>(first));
        glDispatchCompute(static_cast<GLuint>(std::min(tile_count_ - first, kMostGroups)), 1, 1);
    }
}

Sources::Sources(const scene::Scene& scene, const Meshes& meshes, GroundHeight ground)
    : forces_(scene.wind, scene.paths, std::move(ground)), solids_(scene, meshes),
      force_program_("wind forces", {"wind/forces.comp"}),
      inflow_program_("wind inflow", {"wind/forces.comp"}, {"INFLOW"}),
      solid_program_("wind solids", {"wind/solids.comp"}),
      footprints_(gl::Buffer::of(std::span<const std::uint32_t>(solids_.words()))) {}

bool Sources::fill_solids(const FluidGrid& grid, bool moved) {
    std::vector<WindSolid> solids = solids_.at(grid.time_s, grid.origin_m);
    if (!moved && same(solids, drawn_))
        return false;
    loudest_solid_mps_ = 0;
    for (const WindSolid& solid : solids)
        loudest_solid_mps_ = std::max(loudest_solid_mps_, speed_of(solid));
    solid_list_.upload(solids, bins_of(solids, solid_bounds, grid));
    drawn_ = std::move(solids);
    const std::uint32_t air = 0;
    glClearNamedBufferData(grid.solid->id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &air);
    glClearNamedBufferData(grid.solid_velocity->id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT,
                           &air);
    grid.solid->bind_storage(BIND_WIND_SOLID);
    grid.solid_velocity->bind_storage(BIND_WIND_SOLID_VELOCITY);
    footprints_.bind_storage(BIND_WIND_FOOTPRINTS);
    solid_list_.dispatch(solid_program_, BIND_WIND_SOLIDS);
    return true;
}

void Sources::set_inflow(const FluidGrid& grid, const std::vector<WindForce>& forces) {
    if (forces.empty() && !has_inflow_)
        return;
    const float none = 0;
    glClearNamedBufferData(grid.inflow->id(), GL_R32F, GL_RED, GL_FLOAT, &none);
    has_inflow_ = !forces.empty();
    inflow_list_.upload(forces, bins_of(forces, force_bounds, grid));
    grid.inflow->bind_storage(BIND_WIND_INFLOW);
    inflow_list_.dispatch(inflow_program_, BIND_WIND_FORCES);
}

void Sources::apply_forces(const FluidGrid& grid) {
    const std::vector<WindForce> forces = forces_.at(grid.time_s, grid.origin_m, grid.cell_m);
    loudest_force_mps_ = 0;
    for (const WindForce& force : forces)
        loudest_force_mps_ = std::max(loudest_force_mps_, static_cast<double>(force.speed_mps));
    set_inflow(grid, those(forces, brings_air));
    const std::vector<WindForce> pushes = those(forces, relaxes);
    force_list_.upload(pushes, bins_of(pushes, force_bounds, grid));
    grid.u->bind_storage(BIND_WIND_U);
    grid.v->bind_storage(BIND_WIND_V);
    force_list_.dispatch(force_program_, BIND_WIND_FORCES);
}

double Sources::loudest_mps() const {
    return std::max(loudest_force_mps_, loudest_solid_mps_);
}

void Sources::reload() {
    force_program_.reload();
    inflow_program_.reload();
    solid_program_.reload();
}

} // namespace sward::wind
