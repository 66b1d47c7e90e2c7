// SPDX-License-Identifier: Apache-2.0
#include "texgen/commands.h"

#include "base/error.h"
#include "grass/grass_set.h"

namespace sward::texgen {

int run_verify(const VerifyOptions& options) {
    base::set_verbosity(options.verbosity);
    (void)grass::read_grass_set(options.input);
    return 0;
}

} // namespace sward::texgen
