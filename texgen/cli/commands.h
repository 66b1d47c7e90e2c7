// SPDX-License-Identifier: Apache-2.0
// One function a command. Each returns the exit code of a run that did its work, and throws
// base::Error where it could not.
#pragma once

#include "texgen/cli/options.h"

namespace sward::texgen {

[[nodiscard]] int run_bake(const BakeCommandOptions& options);
[[nodiscard]] int run_seam(const SeamOptions& options);
[[nodiscard]] int run_import(const ImportOptions& options);
[[nodiscard]] int run_export(const ExportCommandOptions& options);
[[nodiscard]] int run_inspect(const InspectOptions& options);
[[nodiscard]] int run_verify(const VerifyOptions& options);

} // namespace sward::texgen
