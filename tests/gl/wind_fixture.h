// SPDX-License-Identifier: Apache-2.0
// What the wind's tests share: inputs made on the CPU, and measures of a fluid read back.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "gl/fixture.h"
#include "wind/fluid.h"

namespace sward::tests {

/// Solids and forces as plain functions; what the solver asks for is made on the CPU and uploaded.
class PlainInputs : public wind::FluidInputs {
public:
    using Solid = std::function<bool(glm::dvec2 place)>; ///< world x, z of a cell's centre
    using Push = std::function<void(const wind::FluidGrid& grid, std::vector<float>& u,
                                    std::vector<float>& v)>;

    Solid solid;
    glm::vec2 solid_velocity{0};
    Push push;
    double loudest = 0;

    [[nodiscard]] bool active() const override { return true; }
    bool fill_solids(const wind::FluidGrid& grid, bool moved) override {
        if (!solid || !moved) {
            return false;
        }
        const std::size_t count = static_cast<std::size_t>(grid.cells) * grid.cells;
        std::vector<std::uint32_t> mask(count);
        for (int y = 0; y < grid.cells; ++y) {
            for (int x = 0; x < grid.cells; ++x) {
                mask[stored(grid, {x, y})] =
                    solid(grid.origin_m + (glm::dvec2(x, y) + 0.5) * grid.cell_m);
            }
        }
        const std::vector<glm::vec2> speeds(count, solid_velocity);
        const_cast<gl::Buffer*>(grid.solid)->upload(mask.data(), count * sizeof(mask[0]));
        const_cast<gl::Buffer*>(grid.solid_velocity)
            ->upload(speeds.data(), count * sizeof(speeds[0]));
        return true;
    }
    void apply_forces(const wind::FluidGrid& grid) override {
        if (!push) {
            return;
        }
        const std::size_t count = static_cast<std::size_t>(grid.cells) * grid.cells;
        std::vector<float> u = grid.u->read_all<float>(count), v = grid.v->read_all<float>(count);
        push(grid, u, v);
        const_cast<gl::Buffer*>(grid.u)->upload(u.data(), count * sizeof(float));
        const_cast<gl::Buffer*>(grid.v)->upload(v.data(), count * sizeof(float));
    }
    [[nodiscard]] double loudest_mps() const override { return loudest; }

    /// Storage place of a logical cell.
    static std::size_t stored(const wind::FluidGrid& grid, glm::ivec2 cell) {
        const glm::ivec2 place = (cell + grid.offset) % grid.cells;
        return static_cast<std::size_t>(place.y) * grid.cells + place.x;
    }
};

/// Velocities of a fluid, by logical cell.
struct FluidState {
    explicit FluidState(const wind::Fluid& fluid) : grid(fluid.grid()) {
        const std::size_t count = static_cast<std::size_t>(grid.cells) * grid.cells;
        u_ = grid.u->read_all<float>(count);
        v_ = grid.v->read_all<float>(count);
    }
    [[nodiscard]] double u(int x, int y) const { return static_cast<double>(u_[place(x, y)]); }
    [[nodiscard]] double v(int x, int y) const { return static_cast<double>(v_[place(x, y)]); }
    /// Around the torus; callers keep inside an open grid.
    [[nodiscard]] std::size_t place(int x, int y) const {
        const int n = grid.cells;
        return PlainInputs::stored(grid, {(x + n) % n, (y + n) % n});
    }
    [[nodiscard]] double divergence(int x, int y) const {
        return (u(x + 1, y) - u(x, y) + v(x, y + 1) - v(x, y)) / grid.cell_m;
    }
    [[nodiscard]] double mean_square() const {
        double sum = 0;
        for (std::size_t i = 0; i < u_.size(); ++i) {
            sum += static_cast<double>(u_[i]) * static_cast<double>(u_[i]) +
                   static_cast<double>(v_[i]) * static_cast<double>(v_[i]);
        }
        return sum / static_cast<double>(u_.size());
    }
    [[nodiscard]] double fastest() const {
        double most = 0;
        for (std::size_t i = 0; i < u_.size(); ++i) {
            const double speed = std::hypot(static_cast<double>(u_[i]), static_cast<double>(v_[i]));
            most = std::isfinite(speed) ? std::max(most, speed) : INFINITY;
        }
        return most;
    }
    [[nodiscard]] bool operator==(const FluidState& other) const {
        return u_ == other.u_ && v_ == other.v_;
    }

    wind::FluidGrid grid;
    std::vector<float> u_, v_;
};

/// Divergence over speed / cell, both as root mean squares over the solved cells that are not
/// solid.
inline double divergence_share(const wind::Fluid& fluid, const PlainInputs::Solid& solid = {}) {
    const FluidState state(fluid);
    double sum = 0;
    int count = 0;
    const int first = fluid.inner_first(), end = first + fluid.inner_side();
    for (int y = first; y < end; ++y) {
        for (int x = first; x < end; ++x) {
            if (!solid ||
                !solid(state.grid.origin_m + (glm::dvec2(x, y) + 0.5) * state.grid.cell_m)) {
                sum += state.divergence(x, y) * state.divergence(x, y);
                ++count;
            }
        }
    }
    return std::sqrt(sum / count) / (std::sqrt(state.mean_square()) / state.grid.cell_m);
}

/// The ambient wind of a window without gusts.
inline shared::WindField steady_wind(glm::vec2 mean) {
    shared::WindField field{};
    field.mean = mean;
    return field;
}

/// Dummies where lib/wind_field.glsl reads: a steady wind needs no tile.
class WindTextures {
public:
    WindTextures() : buffer_(16) {
        glCreateTextures(GL_TEXTURE_BUFFER, 1, &texture_);
        glTextureBuffer(texture_, GL_RGBA32F, buffer_.id());
        glBindTextureUnit(TEX_WIND_AMBIENT, texture_);
        glBindTextureUnit(TEX_WIND_LOCAL, texture_);
    }
    ~WindTextures() { glDeleteTextures(1, &texture_); }
    WindTextures(const WindTextures&) = delete;
    WindTextures& operator=(const WindTextures&) = delete;

private:
    gl::Buffer buffer_;
    std::uint32_t texture_ = 0;
};

} // namespace sward::tests
