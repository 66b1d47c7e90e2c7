// SPDX-License-Identifier: Apache-2.0
#include "base/error.h"
#include "texgen/commands.h"

namespace sward::texgen {

int run_seam(const SeamOptions& options) {
    throw base::input_error(base::ExitCode::kFailure, options.input, 0, "seam", "a command in work", "a later texgen");
}

} // namespace sward::texgen
