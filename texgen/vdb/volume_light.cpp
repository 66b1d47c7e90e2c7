// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/volume_light.h"

#include <cstdint>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "texgen/vdb/vdb_grid.h"
#include "texgen/vdb/vdb_reader.h"

namespace sward::texgen {
namespace {

/// visit(key of the metadata, a preset's key, its member) for each term.
template<typename Visit> void for_terms(const Visit& visit) {
    for (const scene::SpeciesKey& key : scene::species_keys())
        if (std::string_view(key.section) == "light")
            visit(fmt::format("light_{}", key.key), key, std::get<double Species::*>(key.target));
}

} // namespace

std::array<std::pair<std::string, float>, 5> light_terms(const Species& light) {
    std::array<std::pair<std::string, float>, 5> terms;
    std::size_t count = 0;
    for_terms([&](const std::string& key, const scene::SpeciesKey&, double Species::*member) {
        terms.at(count++) = {key, static_cast<float>(light.*member)};
    });
    return terms;
}

Species read_light(const VdbReader& reader, const SparseGrid& grid) {
    Species light;
    std::int32_t version = 0;
    if (!grid.read_meta(kLightVersionKey, "int32", version))
        return light;
    if (version != kLightVersion) {
        base::log_warning(fmt::format("{}: {} {} is not known: the light of plain meadow grass is "
                                      "taken",
                                      reader.file(), kLightVersionKey, version));
        return light;
    }
    for_terms([&](const std::string& key, const scene::SpeciesKey& of, double Species::*member) {
        float value = 0;
        const bool there = grid.read_meta(key.c_str(), "float", value);
        const double low = of.range.low, high = of.range.high;
        if (!there || !(value >= static_cast<float>(low) && value <= static_cast<float>(high)))
            reader.refuse("metadata " + key, there ? fmt::format("{}", value) : "none",
                          fmt::format("a number from {} to {}", low, high));
        light.*member = static_cast<double>(value);
    });
    return light;
}

} // namespace sward::texgen
