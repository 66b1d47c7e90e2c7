// SPDX-License-Identifier: Apache-2.0
// What rays see of blades on ground that slopes. Blades stand upright on any ground; the march's
// images lie in its plane.
#pragma once

#include "shared/march_medium.h"
#include "texgen/far/march_fit.h"

namespace sward::texgen {

/// Fills MarchMedium::slopes by rays through the blades, `rays` a view at most. A medium of
/// something else is left at 0: as on level ground.
void fit_slopes(const Patch& patch, int rays, int threads, shared::MarchMedium& medium);

} // namespace sward::texgen
