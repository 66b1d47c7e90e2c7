// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "texgen/preset.h"

namespace sward::texgen {

/// One key of a preset: where it stands, what it may hold, where it goes. The one list that the
/// reader, the range checks of the command line and the messages share.
struct Field {
    using Target = std::variant<std::string Preset::*, std::int64_t Preset::*, double Preset::*,
                                Range Preset::*, Colour Preset::*>;
    std::string_view section; ///< empty: top level
    std::string_view key;
    Target target;
    double low = 0;
    double high = 0;
    std::string_view unit; ///< for messages

    [[nodiscard]] std::string full_key() const;
    [[nodiscard]] std::string expected() const; ///< "a number from 1 to 5 metres"
};

[[nodiscard]] std::span<const Field> preset_fields();

} // namespace sward::texgen
