// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "texgen/patch/patch.h"

namespace sward::texgen {

/// Where the layers of a level stand (B5: not evenly).
struct Placing {
    std::vector<float> edges;   ///< metres, rising from 0 to the canopy's top: layer i is the slab
                                ///< edges[i] .. edges[i + 1]
    std::vector<float> heights; ///< where each is drawn
};

/// Heights (metres, rising) at which rays from above and aslant (75, 60, 45 degrees) meet the
/// blades: what shells have to show. The rays spread evenly over places, azimuths and variants.
[[nodiscard]] std::vector<double> heights_seen(const Patch& patch, double canopy_m, int threads);

/// `count` layers placed so that what is seen lies as near as can be to the layer that shows it: a
/// shell moves what it shows by its distance in height times the cotangent of the view's elevation,
/// and where that is more than a blade's width the shell covers other pixels than the blade does.
/// The least sum of distances, by dynamic programming; each layer is drawn at the median of its
/// slab.
[[nodiscard]] Placing place_layers(std::span<const double> seen, double canopy_m, int count);

/// The same number of even slabs, drawn at their middles: for comparison.
[[nodiscard]] Placing even_layers(double canopy_m, int count);

/// Mean distance in height (metres) between what is seen and the layer that shows it.
[[nodiscard]] double placing_error(std::span<const double> seen, const Placing& placing);

} // namespace sward::texgen
