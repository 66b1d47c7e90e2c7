// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "texgen/preset/preset.h"

namespace sward::texgen {

/// One key of a preset: where it stands, what it may hold, where it goes. The one list that the
/// reader, the range checks of the command line and the messages share. A key of a species stands
/// at the preset's top level, for all species, or in a [[species]] entry, for that one.
struct Field {
    using Target = std::variant<std::string Preset::*, std::int64_t Preset::*, double Preset::*,
                                Colour Preset::*, std::string Species::*, double Species::*,
                                Range Species::*, Colour Species::*>;
    std::string_view section; ///< empty: top level of the preset or of the species
    std::string_view key;
    Target target;
    double low = 0;
    double high = 0;
    std::string_view unit; ///< for messages

    [[nodiscard]] bool of_species() const { return target.index() >= 4; }
    [[nodiscard]] std::string full_key() const;
    [[nodiscard]] std::string expected() const; ///< "a number from 1 to 5 metres"
};

[[nodiscard]] std::span<const Field> preset_fields();

/// What `element` may be, and the defaults that come with it.
struct Element {
    std::string_view name;
    double taper, stalk, head_from, fullness;
};
[[nodiscard]] std::span<const Element> elements();

} // namespace sward::texgen
