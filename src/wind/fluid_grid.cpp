// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "shared/bindings.h"
#include "wind/fluid.h"

namespace sward::wind {

using shared::WindGrid;

namespace {

constexpr double kRimCells = 16;     // layer at the open rim that is drawn to the ambient wind
constexpr double kRimRate_per_s = 2; // at its outer edge
constexpr double kStableDiffusion =
    0.2; // viscosity * step / cell^2 that explicit diffusion carries in one step

} // namespace

WindGrid wind_grid(const FluidSettings& settings) {
    WindGrid grid{};
    const int n = settings.cells;
    int side = n;
    if (!settings.periodic) {
        const int halvings = std::clamp(
            static_cast<int>(std::bit_floor(static_cast<unsigned>(std::max(n / 16, 2)))), 2, 64);
        side = (n - 2) / halvings * halvings;
    }
    const int rim = (n - side) / 2;
    grid.cells = n;
    const double cell = settings.cell_m, step = settings.step_s;
    grid.cell_m = static_cast<float>(cell);
    grid.per_m = static_cast<float>(1 / cell);
    grid.step_s = static_cast<float>(step);
    grid.step_per_m = static_cast<float>(step / cell);
    double diffusion = settings.viscosity_m2s * step / (cell * cell);
    if (diffusion > kStableDiffusion) {
        base::log_warning(fmt::format("wind.viscosity_m2s: found {}, expected at most {:.4g} for "
                                      "this cell_m and step_s; that is used",
                                      settings.viscosity_m2s,
                                      kStableDiffusion * cell * cell / step));
        diffusion = kStableDiffusion;
    }
    grid.confinement = static_cast<float>(settings.confinement);
    grid.diffusion = static_cast<float>(diffusion);
    grid.kept = static_cast<float>(1 / (1 + settings.dissipation_per_s * step));
    grid.brake_mps = shared::kWindCeiling_mps;
    grid.mean = glm::vec2(settings.mean_mps);
    grid.rim_cells = static_cast<float>(std::min(kRimCells, side / 8.0));
    grid.rim_share = static_cast<float>(1 - std::exp(-kRimRate_per_s * step));
    int level = 0, first = 0;
    for (;; ++level) {
        const int row = level == 0 ? n : side;
        grid.levels[level] = {{0, 0}, side, row, first, 0, 0, 0};
        first += row * row;
        if ((level > 0 && side <= WIND_SOLVE_SIDE / 2) || side % 2 != 0 ||
            level + 1 == shared::kMaxWindLevels) {
            break;
        }
        side /= 2;
    }
    grid.inner_first = rim;
    grid.inner_cells = grid.levels[0].cells;
    grid.level_count = level + 1;
    if (level == 0 || side > WIND_SOLVE_SIDE) { // no such size leaves Fluid's callers: cells are 16
                                                // to 4096, tiles powers of two
        throw base::Error(
            base::ExitCode::kFailure,
            fmt::format("wind: found a grid of {} cells, expected one that halves", n));
    }
    return grid;
}

} // namespace sward::wind
