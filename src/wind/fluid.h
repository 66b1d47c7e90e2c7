// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gl/program.h"
#include "shared/wind.h"
#include "shared/wind_grid.h"
#include "wind/fluid_inputs.h"

namespace sward::wind {

struct FluidSettings {
    int cells = 1000; ///< a side; time and memory grow with its square (about 90 bytes a cell)
    double cell_m = 0.5;
    double step_s = 1.0 / 60.0;
    bool periodic = false;  ///< a torus; else open, its rim fed by the ambient wind. Periodic sides
                            ///< are powers of two
    double confinement = 0; ///< strength of W2's vorticity confinement, no unit; keeps small
                            ///< eddies, costs a tenth of a step
    double viscosity_m2s = 0;
    double dissipation_per_s = 0; ///< of what differs from the mean wind
    glm::dvec2 mean_mps{0};       ///< mean wind (m/s)
    int cycles = 1; ///< iterations of the pressure solve: each divides the divergence by seven to
                    ///< thirty and costs a third of a step. More where the last pressure is no good
                    ///< guess: see Fluid::iterations
};

/// What the passes know of a grid, and the levels of its pressure solve. Levels halve while their
/// side is even and too long for one workgroup; an open grid leaves a rim so wide that the solved
/// square halves often enough.
[[nodiscard]] shared::WindGrid wind_grid(const FluidSettings& settings);

/// Of a fluid, by their names; fluids of the same edge and confinement may share them.
using FluidPrograms = std::map<std::string, gl::Program>;

/// W2 in two dimensions on a staggered grid, by compute passes over storage buffers: vorticity
/// confinement, advection of third order in space, viscosity, dissipation, forces, and a projection
/// by multigrid with the solid cells in every level. State is bit-equal from run to run: nothing is
/// added in an order that the GPU chooses.
class Fluid {
public:
    /// Throws base::Error(kNoGpu) for shader trouble. Starts calm. `programs`: another fluid's, so
    /// that none are built again; null: its own.
    explicit Fluid(const FluidSettings& settings,
                   std::shared_ptr<FluidPrograms> programs = nullptr);

    /// Replaces all velocities (m/s), `cells` squared each, in storage order; publishes them as the
    /// first state.
    void set_state(std::span<const float> u, std::span<const float> v);
    /// Another mean wind (m/s) from the next step on.
    void set_mean(glm::dvec2 mean_mps);
    /// Moves the window so that its north-west cell is world cell `first`. Cells that stay keep
    /// their bits; those that come take the ambient wind of `rim`, whose anchor is the new corner.
    void move_to(glm::ivec2 first, const shared::WindField& rim);
    /// One step, to `time_s`. `rim`: the ambient wind at the open rim at that time, anchored at the
    /// corner; unused when periodic. `calm_mps`: speed that the ambient wind may reach; faster air
    /// is braked unless the inputs aim for more.
    void step(FluidInputs& inputs, double time_s, const shared::WindField& rim, double calm_mps);

    [[nodiscard]] FluidGrid grid() const;
    [[nodiscard]] const FluidSettings& settings() const { return settings_; }
    /// vec4 a cell at storage places: velocity at the centre, previous state xy, latest zw.
    [[nodiscard]] const gl::Buffer& cells() const { return published_; }
    /// The solved cells are [first, first + side) on both axes; the rest is rim.
    [[nodiscard]] int inner_first() const { return constants_.inner_first; }
    [[nodiscard]] int inner_side() const { return constants_.inner_cells; }
    void reload();

private:
    void upload_constants();
    void bind_faces() const;
    void bind_poisson() const;
    void dispatch(const std::string& name, glm::ivec2 cells, int level = -1, int colour = -1);
    void build_weights();
    void advect();
    void guess_pressure();
    void cycle();
    [[nodiscard]] int iterations(bool solids_changed) const;
    void solve(int iterations);
    void publish(bool fresh);
    gl::Program& program(const std::string& name);

    FluidSettings settings_;
    glm::ivec2 first_{0};
    double time_s_ = 0;
    bool moved_ = true, solids_known_ = false;
    int steps_ = 0; ///< since the state was set
    shared::WindGrid constants_{};
    std::vector<std::string> defines_;
    std::shared_ptr<FluidPrograms> programs_;
    gl::Buffer constants_buffer_, rim_buffer_;
    gl::Buffer u_, v_, u_carried_, v_carried_, vorticity_, published_, solid_, solid_velocity_,
        inflow_;
    gl::Buffer phi_, rhs_, weights_, pressure_, earlier_pressure_, direction_, next_direction_,
        product_, partials_, scalars_;
};

} // namespace sward::wind
