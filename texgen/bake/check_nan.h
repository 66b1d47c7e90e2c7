// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "grass/grass_set.h"

namespace sward::texgen {

/// Looks at every float of a set that is written. Returns how many there are; throws
/// base::Error(kFailure) that names the first that is NaN or infinite.
std::size_t check_finite(const grass::GrassSet& set);

} // namespace sward::texgen
