// SPDX-License-Identifier: Apache-2.0
// Shape planes as BC5, image by image on all workers.
#include "grass/bc5.h"
#include "texgen/bake/writer.h"
#include "texgen/support/parallel.h"
#include "texgen/support/step_timer.h"

namespace sward::texgen {

void compress_shapes(grass::GrassSet& set, int threads) {
    const StepTimer timer("block compression");
    std::size_t images = 0;
    for (const grass::FarLevel& level : set.levels)
        images += static_cast<std::size_t>(level.layers.layers + level.slices.layers) / 2;
    base::Progress progress("block compression", images);
    const auto compress = [&](grass::TextureArray& planes, grass::TextureArray& shapes) {
        shapes = grass::empty_shapes(planes);
        parallel_for(static_cast<std::size_t>(planes.layers / shared::kPlanes),
                     resolve_threads(threads), [&](std::size_t i, int) {
                         grass::compress_shape(planes, static_cast<int>(i), shapes);
                         progress.advance();
                     });
    };
    for (grass::FarLevel& level : set.levels) {
        compress(level.layers, level.layers_shape);
        compress(level.slices, level.slices_shape);
    }
}

} // namespace sward::texgen
