// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shared/blade.h"
#include "shared/grass_layout.h"
#include "texgen/preset/preset.h"

namespace sward::texgen {

/// The blades of all variants. Root x, z in [0, side); toroidal in both.
struct Patch {
    double side_m = 0;
    std::vector<shared::GrassAppearance> looks; ///< of the species, by number
    std::vector<shared::BladeRecord> blades;    ///< variant-major; inside a variant by rising rank
    std::vector<std::uint32_t> variant_begin;   ///< variants + 1

    [[nodiscard]] int variants() const { return static_cast<int>(variant_begin.size()) - 1; }
    [[nodiscard]] std::span<const shared::BladeRecord> variant(int v) const {
        return std::span(blades).subspan(variant_begin[v], variant_begin[v + 1] - variant_begin[v]);
    }
};

/// Blades of a species on its patch (J2): single blades uniform, tufts Poisson-disk. Every variant
/// has the same number of blades, and every blade with its root within border_width() of an edge is
/// the same, at the same index, in all. Depends on the preset alone, not on the number of threads.
[[nodiscard]] Patch generate_patch(const Preset& preset, int threads);

/// Rest pose of a blade: a quadratic Bezier near the circular arc that starts `lean` from the
/// vertical and turns by `bend` (radians) towards `azimuth`, its curve exactly `length` long.
struct RestCurve {
    shared::vec3 v1{};
    shared::vec3 v2{};
};
[[nodiscard]] RestCurve rest_curve(double length, double lean, double bend, double azimuth);

/// Length of the Bezier 0, v1, v2, closed form.
[[nodiscard]] double curve_length(shared::vec3 v1, shared::vec3 v2);

/// A root before its blade has grown: place, number of its random stream, and the tuft it stands
/// in.
struct Sprout {
    double x = 0;
    double z = 0;
    std::uint64_t id = 0; ///< unique over the patch's border and each variant's interior
    std::uint32_t species = 0;
    double out_x =
        0; ///< offset from the tuft's centre as a share of its radius; 0 for a single blade
    double out_z = 0;
};

/// Roots of the border, shared by all variants, followed by each variant's own.
struct Roots {
    std::vector<Sprout> border;
    std::vector<std::vector<Sprout>> interior; ///< one a variant, all of the same length
};
[[nodiscard]] Roots scatter_roots(const Preset& preset);

/// Orders points so that every prefix is as evenly spread as the points themselves allow (a
/// progressive void-and-cluster, toroidal). `fixed[p]` >= 0 puts that point at position p; such
/// points are placed there only. Returns the point at each position.
[[nodiscard]] std::vector<std::uint32_t> progressive_order(std::span<const shared::vec2> points,
                                                           double side,
                                                           std::span<const std::int32_t> fixed,
                                                           std::uint64_t seed);

} // namespace sward::texgen
