// SPDX-License-Identifier: Apache-2.0
#include "wind/published_scheme.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::wind {

PublishedScheme::PublishedScheme(const FluidSettings& settings)
    : cells_(settings.cells), constants_(sizeof(shared::WindGrid)) {
    shared::WindGrid grid{};
    grid.cells = grid.inner_cells = cells_;
    grid.level_count = 1;
    grid.cell_m = static_cast<float>(settings.cell_m);
    grid.per_m = static_cast<float>(1 / settings.cell_m);
    grid.step_s = static_cast<float>(settings.step_s);
    grid.step_per_m = static_cast<float>(settings.step_s / settings.cell_m);
    grid.confinement = static_cast<float>(settings.confinement);
    grid.kept = static_cast<float>(1 / (1 + settings.dissipation_per_s * settings.step_s));
    grid.brake_mps = shared::kWindCeiling_mps;
    constants_.upload(&grid, sizeof(grid));
    for (const char* name : {"vorticity", "published_advect", "published_confine",
                             "published_divergence", "published_jacobi", "published_project"}) {
        programs_.emplace(name, gl::Program(std::string("wind ") + name,
                                            {std::string("wind/") + name + ".comp"}));
    }
    for (gl::Buffer* buffer :
         {&u_, &v_, &u_next_, &v_next_, &vorticity_, &rhs_, &pressure_, &next_pressure_}) {
        *buffer = gl::Buffer(static_cast<std::size_t>(cells_) * cells_ * sizeof(float));
        buffer->clear_to_zero();
    }
}

void PublishedScheme::set_state(std::span<const float> u, std::span<const float> v) {
    u_.upload(u.data(), std::min(u.size_bytes(), u_.bytes()));
    v_.upload(v.data(), std::min(v.size_bytes(), v_.bytes()));
}

void PublishedScheme::dispatch(const std::string& name) {
    programs_.at(name).use();
    glDispatchCompute((cells_ + WIND_GROUP_X - 1) / WIND_GROUP_X,
                      (cells_ + WIND_GROUP_Y - 1) / WIND_GROUP_Y, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void PublishedScheme::step() {
    constants_.bind_uniform(BIND_WIND_GRID);
    u_.bind_storage(BIND_WIND_U);
    v_.bind_storage(BIND_WIND_V);
    u_next_.bind_storage(BIND_WIND_U_NEXT);
    v_next_.bind_storage(BIND_WIND_V_NEXT);
    dispatch("published_advect");
    std::swap(u_, u_next_);
    std::swap(v_, v_next_);
    u_.bind_storage(BIND_WIND_U);
    v_.bind_storage(BIND_WIND_V);
    vorticity_.bind_storage(BIND_WIND_VORTICITY);
    dispatch("vorticity");
    dispatch("published_confine");
    rhs_.bind_storage(BIND_WIND_RHS);
    dispatch("published_divergence");
    pressure_.clear_to_zero();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        pressure_.bind_storage(BIND_WIND_PRESSURE);
        next_pressure_.bind_storage(BIND_WIND_NEXT_PRESSURE);
        dispatch("published_jacobi");
        std::swap(pressure_, next_pressure_);
    }
    pressure_.bind_storage(BIND_WIND_PRESSURE);
    dispatch("published_project");
}

} // namespace sward::wind
