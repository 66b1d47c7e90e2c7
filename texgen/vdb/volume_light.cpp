// SPDX-License-Identifier: Apache-2.0
#include "texgen/vdb/volume_light.h"

#include <cstdint>
#include <variant>

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "texgen/preset/preset_fields.h"
#include "texgen/vdb/vdb_grid.h"
#include "texgen/vdb/vdb_reader.h"

namespace sward::texgen {
namespace {

/// visit(key of the metadata, field of the preset, its member) for each term.
template<typename Visit> void for_terms(const Visit& visit) {
    for (const Field& field : preset_fields())
        if (field.section == "light")
            visit(fmt::format("light_{}", field.key), field,
                  std::get<double Species::*>(field.target));
}

} // namespace

std::array<std::pair<std::string, float>, 5> light_terms(const Species& light) {
    std::array<std::pair<std::string, float>, 5> terms;
    std::size_t count = 0;
    for_terms([&](const std::string& key, const Field&, double Species::*member) {
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
    for_terms([&](const std::string& key, const Field& field, double Species::*member) {
        float value = 0;
        const bool there = grid.read_meta(key.c_str(), "float", value);
        if (!there ||
            !(value >= static_cast<float>(field.low) && value <= static_cast<float>(field.high)))
            reader.refuse("metadata " + key, there ? fmt::format("{}", value) : "none",
                          field.expected());
        light.*member = static_cast<double>(value);
    });
    return light;
}

} // namespace sward::texgen
