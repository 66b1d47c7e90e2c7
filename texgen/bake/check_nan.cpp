// SPDX-License-Identifier: Apache-2.0
#include "texgen/bake/check_nan.h"

#include <cmath>
#include <cstring>
#include <span>

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include "base/error.h"

namespace sward::texgen {
namespace {

class Scan {
public:
    void look(std::span<const float> values, const char* what, std::size_t index) {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i]))
                throw base::Error(
                    base::ExitCode::kFailure,
                    fmt::format("--checknan: {} {}, number {}: found {}, expected a finite number",
                                what, index, i, values[i]));
        count_ += values.size();
    }
    /// A struct of nothing but floats.
    template<typename T> void look_at(const T& value, const char* what, std::size_t index) {
        static_assert(sizeof(T) % sizeof(float) == 0);
        float values[sizeof(T) / sizeof(float)];
        std::memcpy(values, &value, sizeof value);
        look(values, what, index);
    }
    [[nodiscard]] std::size_t count() const { return count_; }

private:
    std::size_t count_ = 0;
};

void look_at_floats(Scan& scan, const grass::TextureArray& array, std::size_t level) {
    if (array.format != grass::TexelFormat::kRgba32f)
        return;
    for (const std::vector<std::uint8_t>& mip : array.mips) {
        std::vector<float> values(mip.size() / sizeof(float));
        std::memcpy(values.data(), mip.data(), values.size() * sizeof(float));
        scan.look(values, "texture of level", level);
    }
}

void look_at_halves(Scan& scan, const grass::TextureArray& array, std::size_t kind) {
    for (const std::vector<std::uint8_t>& mip : array.mips) {
        std::vector<float> values(mip.size() / sizeof(std::uint16_t));
        for (std::size_t i = 0; i < values.size(); ++i) {
            std::uint16_t half = 0;
            std::memcpy(&half, &mip[i * sizeof half], sizeof half);
            values[i] = glm::unpackHalf1x16(half);
        }
        scan.look(values, "density of kind", kind);
    }
}

} // namespace

std::size_t check_finite(const grass::GrassSet& set) {
    Scan scan;
    const float head[] = {set.side_m, set.canopy_m, set.offset_range_m, set.density_per_m2};
    scan.look(head, "patch", 0);
    for (std::size_t i = 0; i < set.blades.size(); ++i)
        scan.look_at(set.blades[i], "blade", i);
    for (std::size_t i = 0; i < set.species.size(); ++i) {
        scan.look_at(set.species[i].look, "species", i);
        scan.look({&set.species[i].share, 1}, "share of species", i);
    }
    for (std::size_t k = 0; k < set.levels.size(); ++k) {
        const grass::FarLevel& level = set.levels[k];
        scan.look(level.layer_edges, "layer edges of level", k);
        scan.look(level.layer_heights, "layer heights of level", k);
        look_at_floats(scan, level.layers, k);
        look_at_floats(scan, level.slices, k);
    }
    scan.look_at(set.march.medium, "medium", 0);
    scan.look(set.march.correction, "correction", 0);
    for (std::size_t k = 0; k < set.march.slabs.size(); ++k)
        look_at_halves(scan, set.march.slabs[k].density, k);
    look_at_halves(scan, set.march.columns.density, set.march.slabs.size());
    for (std::size_t i = 0; i < set.far.size(); ++i) {
        const grass::FarRow& row = set.far[i];
        const float values[] = {row.elevation_deg, row.coverage,    row.height,
                                row.along,         row.shell_share, row.slice_share};
        scan.look(values, "far row", i);
        scan.look(row.coarse_shares, "shares of far row", i);
    }
    return scan.count();
}

} // namespace sward::texgen
