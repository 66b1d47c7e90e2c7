// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/glm.hpp>

#include "gl/buffer.h"

namespace sward::wind {

/// The grid that a step works on: `cells` x `cells`, staggered (MAC). Storage is toroidal: the cell
/// with world index c (its corner at c * cell_m metres) lies at c mod cells on each axis for as
/// long as the window holds it, so that moving the window copies nothing. Element (column, row) is
/// at index row * cells + column; shaders/wind/grid.glsl does the sums. While a FluidInputs is
/// called, the uniform block BIND_WIND_GRID holds the same facts.
struct FluidGrid {
    const gl::Buffer* u = nullptr; ///< float a cell: velocity to the east (m/s) at its west face
    const gl::Buffer* v = nullptr; ///< float a cell: velocity to the south (m/s) at its north face
    const gl::Buffer* solid = nullptr; ///< uint a cell: 0 air, else solid
    const gl::Buffer* solid_velocity =
        nullptr; ///< vec2 a cell: velocity (m/s) of the solid that fills it
    /// float a cell: divergence (1/s) that the projection leaves there, 0 at first. A wind in the
    /// plane that flows out of a rotor's downwash or into a cyclone's updraft is a pure gradient:
    /// as a force the projection would take all of it away again. apply_forces owns the content,
    /// which keeps its storage place from step to step.
    const gl::Buffer* inflow = nullptr;
    int cells = 0;
    double cell_m = 0;
    glm::ivec2 first_cell{0}; ///< world index of the logical cell (0, 0), the north-west one
    glm::dvec2 origin_m{0};   ///< world x, z of its north-west corner: first_cell * cell_m
    glm::ivec2 offset{0};     ///< where it is stored: first_cell mod cells
    double time_s = 0;        ///< at the end of this step
    double step_s = 0;
};

/// What stands in the air and what pushes it. The solver calls both once a step, with a current
/// context and nothing else promised about bindings; they may use storage bindings 0 to 7 and
/// change the program. Memory barriers for buffers are the solver's, before and after each call.
class FluidInputs {
public:
    virtual ~FluidInputs() = default;
    /// False while there is nothing local: then the ambient wind alone answers, and no window is
    /// simulated.
    [[nodiscard]] virtual bool active() const = 0;
    /// Whether that is nothing but what a host moves near the eye, for which a small window is
    /// enough.
    [[nodiscard]] virtual bool only_moving() const { return false; }
    /// Fills `grid.solid` and `grid.solid_velocity` for the grid's present place and time, every
    /// cell of them. Called when the window has moved, and each step. Returns false when it wrote
    /// nothing because both still hold the answer
    /// (`moved` says that the window shows other cells than at the last call, or that the buffers
    /// are fresh): the solver then keeps its coarse levels.
    virtual bool fill_solids(const FluidGrid& grid, bool moved) = 0;
    /// Adds this step's pushes to `grid.u` and `grid.v` (m/s, that is force times grid.step_s),
    /// before the projection, and sets `grid.inflow` (whose sum over the window is 0 as long as no
    /// source is cut by its rim).
    virtual void apply_forces(const FluidGrid& grid) = 0;
    /// The highest speed (m/s) that the present forces and solids aim for. The solver lets the air
    /// reach it; what is faster than that and the ambient wind explain is braked within a second.
    [[nodiscard]] virtual double loudest_mps() const = 0;
};

} // namespace sward::wind
