// SPDX-License-Identifier: Apache-2.0
#include "wind/ambient.h"

#include <cmath>
#include <utility>

#include <epoxy/gl.h>

#include "shared/bindings.h"

namespace sward::wind {

namespace {
constexpr double kTwoPi = 6.283185307179586;
// Turns of each group while the strongest gust turns over once: no two in a simple ratio, so that
// the sum never repeats.
constexpr double kRates[kGustGroups] = {0.11, -0.17, 0.0687};
constexpr double kDrawn =
    0.25; // share of a turn-over in which the fluid is drawn to the synthesised gusts
constexpr float kAnySpeed = shared::kWindCeiling_mps;
} // namespace

AmbientTile::AmbientTile(const scene::WindSpec& spec)
    : AmbientTile(spec, std::make_shared<Shared>(), 0) {}

AmbientTile::AmbientTile(const scene::WindSpec& spec, const AmbientTile& other, std::int64_t first)
    : AmbientTile(spec, other.shared_, first) {}

AmbientTile::AmbientTile(const scene::WindSpec& spec, std::shared_ptr<Shared> shared,
                         std::int64_t first)
    : seed_(static_cast<std::uint64_t>(spec.seed)),
      strength_mps_(kGustShare * spec.gust * spec.speed_mps), shared_(std::move(shared)) {
    tag_.step_s = kStep_s;
    tag_.cells = kCells;
    tag_.cell_m = kCell_m;
    if (strength_mps_ > 0) {
        if (!shared_->spectrum) {
            shared_->spectrum =
                std::make_shared<const GustSpectrum>(gust_spectrum(kCells, kPeakWaves, seed_));
        }
        initial_ = gl::Buffer(sizeof(glm::vec4) * kCells * kCells);
    } else {
        initial_ = gl::Buffer(sizeof(glm::vec4)); // bound, not read
    }
    begin(first);
}

/// Gusts turn over in the time that one of them takes to pass its own length at its own speed.
std::array<double, kGustGroups> AmbientTile::phases(std::int64_t state) const {
    const double turn_over_s = kCells * kCell_m / kPeakWaves / strength_mps_;
    std::array<double, kGustGroups> out{};
    for (std::size_t g = 0; g < out.size(); ++g) {
        out[g] =
            kTwoPi * std::fmod(kRates[g] * static_cast<double>(state) * kStep_s / turn_over_s, 1.0);
    }
    return out;
}

void AmbientTile::begin(std::int64_t first) {
    const bool known = !initial_cells_.empty() && tag_.first == first;
    tag_.latest = tag_.first = first;
    fluid_.reset();
    if (strength_mps_ <= 0 || known) {
        return;
    }
    shared_->spectrum->velocities(phases(first), u_, v_);
    const auto strength = static_cast<float>(strength_mps_);
    for (std::size_t i = 0; i < u_.size(); ++i) {
        u_[i] *= strength;
        v_[i] *= strength;
    }
    initial_cells_.resize(u_.size());
    for (std::size_t row = 0; row < kCells; ++row) {
        for (std::size_t column = 0; column < kCells; ++column) {
            const std::size_t own = row * kCells + column;
            const glm::vec2 centre =
                0.5f * glm::vec2(u_[own] + u_[row * kCells + (column + 1) % kCells],
                                 v_[own] + v_[(row + 1) % kCells * kCells + column]);
            initial_cells_[own] = glm::vec4(centre, centre);
        }
    }
    initial_.upload(initial_cells_.data(), initial_cells_.size() * sizeof(glm::vec4));
}

void AmbientTile::prepare_shared() {
    if (!totals_.id()) {
        totals_ = gl::Buffer(4 * sizeof(float));
    }
    if (shared_->target.id()) {
        return;
    }
    shared_->target = gl::Buffer(kGustGroups * kCells * kCells * sizeof(glm::vec2));
    for (std::size_t g = 0; g < kGustGroups; ++g) {
        const auto& stream = shared_->spectrum->stream[g];
        shared_->target.upload(stream.data(), stream.size() * sizeof(glm::vec2),
                               g * stream.size() * sizeof(glm::vec2));
    }
    shared_->totals =
        gl::Program("wind ambient_totals", {"wind/ambient_totals.comp"}, {"PERIODIC"});
    shared_->force = gl::Program("wind ambient_force", {"wind/ambient_force.comp"}, {"PERIODIC"});
}

void AmbientTile::step() {
    if (strength_mps_ > 0) {
        if (!fluid_) {
            prepare_shared();
            FluidSettings settings;
            settings.cells = kCells;
            settings.cell_m = kCell_m;
            settings.step_s = kStep_s;
            settings.periodic = true;
            fluid_ = std::make_unique<Fluid>(settings, shared_->fluid);
            fluid_->set_state(u_, v_);
        }
        fluid_->step(*this, static_cast<double>(tag_.latest + 1) * kStep_s, {}, kAnySpeed);
    }
    ++tag_.latest;
}

void AmbientTile::apply_forces(const FluidGrid& grid) {
    const double turn_over_s = kCells * kCell_m / kPeakWaves / strength_mps_;
    const std::array<double, kGustGroups> now = phases(tag_.latest + 1);
    glm::vec4 cosines(0, 0, 0, 1 - std::exp(-kStep_s / (kDrawn * turn_over_s))),
        sines(0, 0, 0, strength_mps_);
    for (int g = 0; g < kGustGroups; ++g) {
        cosines[g] = static_cast<float>(strength_mps_ * std::cos(now[static_cast<std::size_t>(g)]));
        sines[g] = static_cast<float>(strength_mps_ * std::sin(now[static_cast<std::size_t>(g)]));
    }
    grid.u->bind_storage(BIND_WIND_U);
    grid.v->bind_storage(BIND_WIND_V);
    shared_->target.bind_storage(BIND_WIND_TARGET);
    totals_.bind_storage(BIND_WIND_TOTALS);
    shared_->totals.use();
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    shared_->force.use();
    glUniform4fv(0, 1, &cosines.x);
    glUniform4fv(1, 1, &sines.x);
    glDispatchCompute((kCells + WIND_GROUP_X - 1) / WIND_GROUP_X,
                      (kCells + WIND_GROUP_Y - 1) / WIND_GROUP_Y, 1);
}

void AmbientTile::reload() {
    if (shared_->target.id()) {
        shared_->totals.reload();
        shared_->force.reload();
    }
    if (fluid_) {
        fluid_->reload();
    }
}

} // namespace sward::wind
