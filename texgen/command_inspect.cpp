// SPDX-License-Identifier: Apache-2.0
#include "texgen/commands.h"

#include <cstdio>

#include <fmt/format.h>

#include "base/error.h"
#include "grass/grass_set.h"

namespace sward::texgen {

int run_inspect(const InspectOptions& options) {
    base::set_verbosity(options.verbosity);
    const grass::GrassSet set = grass::read_grass_set(options.input);
    fmt::print("{}: {} blades, {} levels\n", set.name, set.blades.size(), set.levels.size());
    return 0;
}

} // namespace sward::texgen
