// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "base/error.h"

namespace sward::render {

/// Reloads `part` where there is one; where that fails the old program stays, and the message is
/// added.
template<class Part> void reload(Part* part, std::vector<std::string>& failures) {
    try {
        if (part)
            part->reload();
    } catch (const base::Error& error) {
        failures.emplace_back(error.what());
    }
}

} // namespace sward::render
