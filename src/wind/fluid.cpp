// SPDX-License-Identifier: Apache-2.0
#include "wind/fluid.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "shared/bindings.h"

namespace sward::wind {

namespace {

int wrap(int value, int n) {
    return ((value % n) + n) % n;
}

void storage_barrier() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}
constexpr int kFirstSteps = 2, kEarlySteps = 12; // see Fluid::iterations
constexpr GLbitfield kAll =
    GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;

/// The published cells are the largest block, and a buffer texture over them.
void require_room(int cells) {
    GLint64 block = 0;
    GLint texels = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block);
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &texels);
    const std::int64_t most = std::min(block / static_cast<std::int64_t>(sizeof(glm::vec4)),
                                       static_cast<std::int64_t>(texels));
    if (static_cast<std::int64_t>(cells) * cells > most) {
        throw base::Error(base::ExitCode::kOverLimit,
                          fmt::format("wind.cells: found {}, expected at most {} on this GPU",
                                      cells,
                                      static_cast<int>(std::sqrt(static_cast<double>(most)))));
    }
}

} // namespace

Fluid::Fluid(const FluidSettings& settings, std::shared_ptr<FluidPrograms> programs)
    : settings_(settings), constants_(wind_grid(settings)),
      programs_(programs ? std::move(programs) : std::make_shared<FluidPrograms>()) {
    if (settings_.periodic) {
        defines_.emplace_back("PERIODIC");
    }
    if (settings_.confinement > 0) {
        defines_.emplace_back("CONFINEMENT");
    }
    require_room(settings_.cells);
    const std::size_t cells = static_cast<std::size_t>(settings_.cells) * settings_.cells;
    const shared::WindLevel& last = constants_.levels[constants_.level_count - 1];
    const std::size_t all =
        static_cast<std::size_t>(last.first) + static_cast<std::size_t>(last.cells) * last.cells;
    for (gl::Buffer* buffer : {&u_, &v_, &u_carried_, &v_carried_}) {
        *buffer = gl::Buffer(cells * sizeof(float));
        buffer->clear_to_zero();
    }
    vorticity_ = gl::Buffer(settings_.confinement > 0 ? cells * sizeof(float) : 4);
    published_ = gl::Buffer(cells * sizeof(glm::vec4));
    solid_ = gl::Buffer(cells * sizeof(std::uint32_t));
    solid_velocity_ = gl::Buffer(cells * sizeof(glm::vec2));
    inflow_ = gl::Buffer(cells * sizeof(float));
    phi_ = gl::Buffer(all * sizeof(float));
    rhs_ = gl::Buffer(all * sizeof(float));
    weights_ = gl::Buffer(all * sizeof(std::uint32_t));
    for (gl::Buffer* buffer :
         {&pressure_, &earlier_pressure_, &direction_, &next_direction_, &product_}) {
        *buffer = gl::Buffer(cells * sizeof(float));
        buffer->clear_to_zero();
    }
    partials_ = gl::Buffer(cells / (WIND_GROUP_X * WIND_GROUP_Y) * 2 * sizeof(glm::vec2) + 4096);
    scalars_ = gl::Buffer(4 * sizeof(float));
    for (gl::Buffer* buffer :
         {&published_, &solid_, &solid_velocity_, &inflow_, &phi_, &rhs_, &weights_}) {
        buffer->clear_to_zero();
    }
    constants_buffer_ = gl::Buffer(sizeof(constants_));
    rim_buffer_ = gl::Buffer(sizeof(shared::WindField));
    const shared::WindField none{};
    rim_buffer_.upload(&none, sizeof(none));
}

gl::Program& Fluid::program(const std::string& name) {
    auto found = programs_->find(name);
    if (found == programs_->end()) {
        const bool correct = name == "poisson_correct";
        std::vector<std::string> defines = defines_;
        if (correct) {
            defines.emplace_back("CORRECT");
        }
        found = programs_
                    ->emplace(name,
                              gl::Program("wind " + name,
                                          {"wind/" + (correct ? "poisson_relax" : name) + ".comp"},
                                          defines))
                    .first;
    }
    return found->second;
}

void Fluid::reload() {
    for (auto& [name, program] : *programs_) {
        program.reload();
    }
}

void Fluid::dispatch(const std::string& name, glm::ivec2 cells, int level, int colour) {
    const gl::Program& pass = program(name);
    pass.use();
    if (level >= 0) {
        glUniform1i(0, level);
    }
    if (colour >= 0) {
        glUniform1i(1, colour);
    }
    glDispatchCompute((cells.x + WIND_GROUP_X - 1) / WIND_GROUP_X,
                      (cells.y + WIND_GROUP_Y - 1) / WIND_GROUP_Y, 1);
    storage_barrier();
}

FluidGrid Fluid::grid() const {
    FluidGrid grid;
    grid.u = &u_;
    grid.v = &v_;
    grid.solid = &solid_;
    grid.solid_velocity = &solid_velocity_;
    grid.inflow = &inflow_;
    grid.cells = settings_.cells;
    grid.cell_m = settings_.cell_m;
    grid.first_cell = first_;
    grid.origin_m = glm::dvec2(first_) * settings_.cell_m;
    grid.offset = {wrap(first_.x, grid.cells), wrap(first_.y, grid.cells)};
    grid.time_s = time_s_;
    grid.step_s = settings_.step_s;
    return grid;
}

void Fluid::upload_constants() {
    constants_.stored = grid().offset;
    constants_.levels[0].stored = constants_.stored + constants_.inner_first;
    constants_buffer_.upload(&constants_, sizeof(constants_));
    constants_buffer_.bind_uniform(BIND_WIND_GRID);
    rim_buffer_.bind_uniform(BIND_WIND_FIELD);
}

void Fluid::bind_faces() const {
    u_.bind_storage(BIND_WIND_U);
    v_.bind_storage(BIND_WIND_V);
}

void Fluid::bind_poisson() const {
    bind_faces();
    solid_.bind_storage(BIND_WIND_SOLID);
    solid_velocity_.bind_storage(BIND_WIND_SOLID_VELOCITY);
    phi_.bind_storage(BIND_WIND_PHI);
    rhs_.bind_storage(BIND_WIND_RHS);
    weights_.bind_storage(BIND_WIND_WEIGHTS);
    inflow_.bind_storage(BIND_WIND_DRAWN_INFLOW);
}

void Fluid::set_state(std::span<const float> u, std::span<const float> v) {
    u_.upload(u.data(), std::min(u.size_bytes(), u_.bytes()));
    v_.upload(v.data(), std::min(v.size_bytes(), v_.bytes()));
    u_carried_.upload(u.data(), std::min(u.size_bytes(), u_.bytes()));
    v_carried_.upload(v.data(), std::min(v.size_bytes(), v_.bytes()));
    pressure_.clear_to_zero();
    earlier_pressure_.clear_to_zero();
    steps_ = 0;
    upload_constants();
    publish(true);
}

void Fluid::move_to(glm::ivec2 first, const shared::WindField& rim) {
    const glm::ivec2 shift = first - first_;
    const int n = settings_.cells;
    glm::ivec2 low = glm::clamp(-shift, glm::ivec2(0), glm::ivec2(n)),
               high = glm::clamp(n - shift, glm::ivec2(0), glm::ivec2(n));
    if (!solids_known_) { // never stepped: nothing is worth keeping
        low = high = glm::ivec2(0);
    }
    if (const int kept = (high.x - low.x) * (high.y - low.y);
        kept < n * n / 2) { // after a leap the last pressure is none to begin with
        steps_ = 0;
    } else if (kept < n * n - n * n / 8) {
        steps_ = std::min(steps_, kFirstSteps);
    }
    first_ = first;
    moved_ = true;
    rim_buffer_.upload(&rim, sizeof(rim));
    upload_constants();
    bind_faces();
    u_carried_.bind_storage(BIND_WIND_U_CARRIED);
    v_carried_.bind_storage(BIND_WIND_V_ENTERING);
    pressure_.bind_storage(BIND_WIND_PRESSURE);
    earlier_pressure_.bind_storage(BIND_WIND_EARLIER_PRESSURE);
    published_.bind_storage(BIND_WIND_CELLS);
    program("enter").set("kept", glm::ivec4(low, high));
    dispatch("enter", glm::ivec2(n));
    glMemoryBarrier(kAll);
}

void Fluid::publish(bool fresh) {
    bind_faces();
    published_.bind_storage(BIND_WIND_CELLS);
    dispatch("publish", glm::ivec2(settings_.cells), fresh ? 1 : 0);
    glMemoryBarrier(kAll);
}

void Fluid::build_weights() {
    bind_poisson();
    for (int level = 0; level < constants_.level_count; ++level) {
        dispatch("poisson_weights", glm::ivec2(constants_.levels[level].cells), level);
    }
}

void Fluid::advect() {
    u_carried_.bind_storage(BIND_WIND_U);
    v_carried_.bind_storage(BIND_WIND_V);
    if (settings_.confinement > 0) {
        vorticity_.bind_storage(BIND_WIND_VORTICITY);
        dispatch("vorticity", glm::ivec2(settings_.cells));
    }
    u_.bind_storage(BIND_WIND_U_NEXT);
    v_.bind_storage(BIND_WIND_V_NEXT);
    pressure_.bind_storage(BIND_WIND_LAST_PRESSURE);
    weights_.bind_storage(BIND_WIND_WEIGHTS);
    dispatch("advect", glm::ivec2(settings_.cells));
}

/// The first two pressures follow a start from nothing: no trend to go on with.
void Fluid::guess_pressure() {
    if (steps_ > kFirstSteps) {
        bind_poisson();
        pressure_.bind_storage(BIND_WIND_PRESSURE);
        earlier_pressure_.bind_storage(BIND_WIND_EARLIER_PRESSURE);
        dispatch("poisson_guess", glm::ivec2(constants_.inner_cells));
    } else {
        glCopyNamedBufferSubData(pressure_.id(), earlier_pressure_.id(), 0, 0,
                                 static_cast<GLsizeiptr>(pressure_.bytes()));
    }
}

/// phi from the residual: a V-cycle with one red-black sweep down and one up.
void Fluid::cycle() {
    const int coarsest = constants_.level_count - 1;
    const auto cells = [&](int level) { return glm::ivec2(constants_.levels[level].cells); };
    const auto half = [&](int level) {
        return glm::ivec2((cells(level).x + 1) / 2, cells(level).y);
    };
    for (int level = 0; level < coarsest; ++level) {
        dispatch("poisson_begin", cells(level), level);
        dispatch("poisson_restrict", cells(level + 1), level);
    }
    dispatch("poisson_solve", glm::ivec2(1), coarsest);
    for (int level = coarsest - 1; level >= 0; --level) {
        dispatch("poisson_correct", half(level), level, 0);
        dispatch("poisson_relax", half(level), level, 1);
    }
}

/// The first steps have no pressure to begin with (the second one's is the first to hold the half
/// that acts before the advection).
int Fluid::iterations(bool solids_changed) const {
    return settings_.cycles * (steps_ < kFirstSteps   ? 8
                               : steps_ < kEarlySteps ? 4
                               : solids_changed       ? 2
                                                      : 1);
}

/// Conjugate gradients with the multigrid as preconditioner: alone it converges in free air, but
/// may diverge beside walls thinner than coarse cells. Begins with the last step's pressure. A
/// fixed number of iterations: nothing waits for a norm.
void Fluid::solve(int iterations) {
    const glm::ivec2 inner(constants_.inner_cells);
    const int groups = ((inner.x + WIND_GROUP_X - 1) / WIND_GROUP_X) *
                       ((inner.y + WIND_GROUP_Y - 1) / WIND_GROUP_Y);
    scalars_.clear_to_zero();
    scalars_.bind_storage(BIND_WIND_SCALARS);
    product_.bind_storage(BIND_WIND_PRODUCT);
    partials_.bind_storage(BIND_WIND_PARTIALS);
    for (int i = 0; i < iterations; ++i) {
        phi_.bind_storage(BIND_WIND_PHI);
        cycle();
        dispatch("poisson_dots", inner);
        dispatch("poisson_scalars", glm::ivec2(1), groups, 0);
        direction_.bind_storage(BIND_WIND_DIRECTION);
        next_direction_.bind_storage(BIND_WIND_NEXT_DIRECTION);
        dispatch("poisson_direction", inner);
        dispatch("poisson_scalars", glm::ivec2(1), groups, 1);
        pressure_.bind_storage(BIND_WIND_PRESSURE);
        dispatch("poisson_update", inner);
        std::swap(direction_, next_direction_);
    }
}

void Fluid::set_mean(glm::dvec2 mean_mps) {
    settings_.mean_mps = mean_mps;
    constants_.mean = glm::vec2(mean_mps); // uploaded by step()
}

void Fluid::step(FluidInputs& inputs, double time_s, const shared::WindField& rim,
                 double calm_mps) {
    time_s_ = time_s;
    const double loudest = inputs.loudest_mps();
    const double limit = std::max(calm_mps, std::isfinite(loudest) ? 1.2 * loudest : calm_mps);
    constants_.brake_mps =
        static_cast<float>(std::min(limit, static_cast<double>(shared::kWindCeiling_mps)));
    rim_buffer_.upload(&rim, sizeof(rim));
    upload_constants();
    const bool solids_changed = inputs.fill_solids(grid(), moved_ || !solids_known_);
    storage_barrier();
    if (solids_changed && constants_.has_solids == 0) {
        constants_.has_solids = 1;
        upload_constants();
    }
    if (solids_changed || moved_ || !solids_known_) {
        build_weights();
    }
    moved_ = false;
    solids_known_ = true;
    advect();
    inputs.apply_forces(grid());
    storage_barrier();
    guess_pressure();
    bind_poisson();
    pressure_.bind_storage(BIND_WIND_PRESSURE);
    dispatch("divergence", glm::ivec2(constants_.inner_cells));
    solve(iterations(solids_changed));
    ++steps_;
    bind_poisson();
    pressure_.bind_storage(BIND_WIND_PRESSURE);
    u_carried_.bind_storage(BIND_WIND_U_CARRIED);
    v_carried_.bind_storage(BIND_WIND_V_CARRIED);
    dispatch("project", glm::ivec2(settings_.cells));
    publish(false);
}

} // namespace sward::wind
