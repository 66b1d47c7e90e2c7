// SPDX-License-Identifier: Apache-2.0
// What a patch takes, without the time that its ranks take.
#pragma once

#include "texgen/patch/patch.h"

namespace sward::texgen {

/// The blades of generate_patch without ranks and seeds, in no order: all that sizes and heights
/// ask for.
[[nodiscard]] Patch unranked_patch(const Preset& preset, int threads);

} // namespace sward::texgen
