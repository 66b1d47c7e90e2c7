// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>

#include "gl/program.h"
#include "wind/fluid.h"

namespace sward::wind {

/// The wind as W2 publishes it, its printed errors corrected: semi-Lagrangian advection, vorticity
/// confinement, 40 Jacobi sweeps from 0, on the same staggered grid, storage and workgroups as
/// Fluid, without its obstacles and rim. It is here to be measured against (`sward bench wind`);
/// nothing else uses it.
class PublishedScheme {
public:
    static constexpr int kSweeps = 40;

    /// `settings`: cells, cell_m, step_s, confinement and dissipation count.
    explicit PublishedScheme(const FluidSettings& settings);
    void set_state(std::span<const float> u, std::span<const float> v);
    void step();
    [[nodiscard]] const gl::Buffer& u() const { return u_; }
    [[nodiscard]] const gl::Buffer& v() const { return v_; }

private:
    void dispatch(const std::string& name);
    int cells_;
    std::map<std::string, gl::Program> programs_;
    gl::Buffer constants_, u_, v_, u_next_, v_next_, vorticity_, rhs_, pressure_, next_pressure_;
};

} // namespace sward::wind
