// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "texgen/report/report.h"

namespace sward::texgen {

/// What a bake would make and take, without drawing an image: the patch is made as in a bake, so
/// blades, images and unpacked bytes are exact; the volume's size and the peak memory are
/// estimates.
[[nodiscard]] SetReport dry_run(const Preset& preset, const BakeOptions& options);

} // namespace sward::texgen
