// SPDX-License-Identifier: Apache-2.0
#include "app/set_cache.h"

#include "app/set_lookup.h"
#include "base/error.h"

namespace sward::app {

grass::GrassSet load_grass(const scene::Scene& scene, const LoadTold&) {
    const SetPlace place = find_set(scene);
    if (place.is_preset)
        throw base::input_error(base::ExitCode::kBadInput, scene.file, 0, "grass.set",
                                scene.grass.set,
                                "a set's directory (the core build bakes no preset; texgen does)");
    return grass::read_grass_set(place.path);
}

} // namespace sward::app
