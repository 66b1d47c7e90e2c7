// SPDX-License-Identifier: Apache-2.0
#include "app/commands.h"

namespace sward::app {

void run_view(const Options&) {
    throw base::Error(base::ExitCode::kNoGpu,
                      "view: found the core build, which has no window, expected the full one; "
                      "`sward render SCENE -o OUT.ppm` draws the same without a display");
}

} // namespace sward::app
