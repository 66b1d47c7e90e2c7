// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gl/program.h"
#include "wind/fluid_inputs.h"
#include "wind/force_list.h"
#include "wind/solid_list.h"
#include "wind/tile_bins.h"

namespace sward::wind {

/// A list on the GPU, binned by tiles: what the passes over forces and solids read. One workgroup a
/// tile.
class BinnedList {
public:
    template<class T> void upload(const std::vector<T>& things, const TileBins& bins) {
        put(things_, things.data(), things.size() * sizeof(T));
        put(tiles_, bins.tiles.data(), bins.tiles.size() * sizeof(glm::ivec4));
        put(items_, bins.items.data(), bins.items.size() * sizeof(std::uint32_t));
        tile_count_ = bins.tiles.size();
    }
    /// Runs `program`, which is bound to everything else already, over the tiles.
    void dispatch(const gl::Program& program, std::uint32_t things_binding) const;

private:
    static void put(gl::Buffer& buffer, const void* data, std::size_t bytes);
    gl::Buffer things_, tiles_, items_;
    std::size_t tile_count_ = 0;
};

/// A scene's arrows, sources and obstacles as the fluid's inputs. Cost follows the area that they
/// cover.
class Sources final : public FluidInputs {
public:
    /// Throws Error(kBadInput) for an obstacle's mesh that is not there or that its height does not
    /// meet.
    Sources(const scene::Scene& scene, const Meshes& meshes, GroundHeight ground);

    /// Arrows of the editor, in the place of the scene's, from the next step on. Every parent is
    /// there; chains end.
    void set_arrows(std::vector<scene::WindArrow> arrows) { forces_.set_arrows(std::move(arrows)); }

    /// What a host moves, beside the scene's own, from the next step on.
    void set_moving(std::vector<scene::MovingWindSource> moving) {
        forces_.set_moving(std::move(moving));
    }

    /// A window is simulated even while nothing stands or pushes.
    void keep_active() { always_active_ = true; }

    [[nodiscard]] bool active() const override {
        return always_active_ || !forces_.empty() || !solids_.empty();
    }
    [[nodiscard]] bool only_moving() const override {
        return !always_active_ && forces_.only_moving() && solids_.empty();
    }
    bool fill_solids(const FluidGrid& grid, bool moved) override;
    void apply_forces(const FluidGrid& grid) override;
    [[nodiscard]] double loudest_mps() const override;

    void reload();

private:
    void set_inflow(const FluidGrid& grid, const std::vector<shared::WindForce>& forces);

    ForceList forces_;
    SolidList solids_;
    gl::Program force_program_, inflow_program_, solid_program_;
    BinnedList force_list_, inflow_list_, solid_list_;
    gl::Buffer footprints_;
    std::vector<shared::WindSolid> drawn_; ///< what the solid mask holds
    bool always_active_ = false;
    bool has_inflow_ = false; ///< whether the grid's inflow is anything but 0
    double loudest_force_mps_ = 0, loudest_solid_mps_ = 0;
};

} // namespace sward::wind
