// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "scene/scene.h"
#include "wind/fluid.h"
#include "wind/gust_spectrum.h"
#include "wind/state.h"

namespace sward::wind {

/// The ambient wind's gusts: a periodic fluid that the mean wind carries along. It is solved in the
/// air's own frame, so that its steps may be long; forced by drawing it slowly to a synthesised
/// field with the gusts' spectrum, which never repeats, and held at the scene's strength and at
/// mean 0. Starts as that field: there is nothing to spin up.
class AmbientTile final : public FluidInputs {
public:
    static constexpr int kCells = 256; // a side; a step costs about 6 ms in software
    static constexpr double kCell_m =
        5; // of the larger of the two layers that are laid over the plane
    static constexpr double kStep_s = 0.5;
    static constexpr double kPeakWaves =
        6; // strongest gusts: 213 m long, and 132 m in the smaller layer
    static constexpr double kGustShare =
        0.45; // root mean square of a component at gust 1, of the mean speed

    explicit AmbientTile(const scene::WindSpec& spec);
    /// Of the same seed as `other`, whose spectrum and programs it shares, for another wind; begins
    /// at state `first`.
    AmbientTile(const scene::WindSpec& spec, const AmbientTile& other, std::int64_t first);

    /// Root mean square of the gusts (m/s a component); 0: there are none, and nothing is ever
    /// stepped.
    [[nodiscard]] double strength_mps() const { return strength_mps_; }
    /// One step.
    void step();
    /// Begins anew with the synthesised gusts of state `first`.
    void begin(std::int64_t first);
    [[nodiscard]] const StateTag& tag() const { return tag_; }
    [[nodiscard]] const gl::Buffer& cells() const { return fluid_ ? fluid_->cells() : initial_; }
    /// The first state, as cells() holds it.
    [[nodiscard]] const std::vector<glm::vec4>& initial() const { return initial_cells_; }
    void reload();

    [[nodiscard]] bool active() const override { return true; }
    bool fill_solids(const FluidGrid&, bool) override { return false; }
    void apply_forces(const FluidGrid& grid) override;
    [[nodiscard]] double loudest_mps() const override { return 0; }

private:
    /// What does not hang on the wind: all tiles of a seed share it, since building programs would
    /// hold up the frame in which a wind changes. Made with the first step of any.
    struct Shared {
        std::shared_ptr<const GustSpectrum> spectrum; ///< null where there are no gusts
        std::shared_ptr<FluidPrograms> fluid = std::make_shared<FluidPrograms>();
        gl::Buffer target; ///< the spectrum's streams
        gl::Program totals, force;
    };
    AmbientTile(const scene::WindSpec& spec, std::shared_ptr<Shared> shared, std::int64_t first);
    void prepare_shared();
    [[nodiscard]] std::array<double, kGustGroups> phases(std::int64_t state) const;
    std::uint64_t seed_;
    double strength_mps_;
    StateTag tag_;
    std::shared_ptr<Shared> shared_;
    std::vector<float> u_, v_; ///< the first state
    std::vector<glm::vec4> initial_cells_;
    gl::Buffer initial_, totals_;
    std::unique_ptr<Fluid> fluid_; ///< made with the first step
};

} // namespace sward::wind
