// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "grass/set_files.h"
#include "texgen/bake/writer.h"

namespace sward::texgen {
namespace {

using nlohmann::ordered_json;

/// The shortest decimal that reads back as the same float.
double decimal(float value) {
    const std::string text = fmt::format("{}", value);
    double out = 0;
    std::from_chars(text.data(), text.data() + text.size(), out);
    return out;
}

ordered_json rgb(const shared::vec3& c) {
    return {decimal(c.x), decimal(c.y), decimal(c.z)};
}

ordered_json floor_of(const grass::Floor& floor) {
    return {
        {"cover", decimal(floor.cover)}, {"moss", rgb(floor.moss)}, {"litter", rgb(floor.litter)}};
}

ordered_json look(const shared::GrassAppearance& a) {
    return {{"root", rgb(a.root)},
            {"tip", rgb(a.tip)},
            {"dry", rgb(a.dry)},
            {"dry_share", decimal(a.dry_share)},
            {"variation", decimal(a.variation)},
            {"translucency", decimal(a.translucency)},
            {"kd", decimal(a.gloss.diffuse)},
            {"pd", decimal(a.gloss.diffuse_power)},
            {"ks", decimal(a.gloss.specular)},
            {"ps", decimal(a.gloss.specular_power)},
            {"head", rgb(a.head)},
            {"taper", decimal(a.outline.taper)},
            {"stalk", decimal(a.outline.stalk)},
            {"head_from", decimal(a.outline.head_from)},
            {"fullness", decimal(a.outline.fullness)}};
}

ordered_json decimals(const std::vector<float>& values) {
    ordered_json list = ordered_json::array();
    for (const float value : values)
        list.push_back(decimal(value));
    return list;
}

ordered_json numbers(const shared::vec4& v) {
    return {decimal(v.x), decimal(v.y), decimal(v.z), decimal(v.w)};
}

ordered_json gloss_of(const shared::GrassGloss& gloss) {
    return numbers({gloss.diffuse, gloss.diffuse_power, gloss.specular, gloss.specular_power});
}

ordered_json march_json(const grass::FarMedium& march) {
    ordered_json out = {{"columns", grass::kColumnsFile},
                        {"column_fibres", grass::kColumnFibresFile},
                        {"correction", grass::kCorrectionFile}};
    for (int k = 0; k < shared::kMarchSets; ++k) {
        out["slabs"].push_back(grass::slabs_file(k));
        out["slab_fibres"].push_back(grass::slab_fibres_file(k));
    }
    for (const shared::vec4& edge : march.medium.edges)
        out["edges"].push_back(numbers(edge));
    for (const shared::vec4& layer : march.medium.layers)
        out["layers"].push_back({decimal(layer.x), decimal(layer.y)});
    for (int i = 0; i < shared::kMarchLayers; ++i) {
        out["level_tint"].push_back(rgb(shared::vec3(march.medium.level_tint[i])));
        out["steep_tint"].push_back(rgb(shared::vec3(march.medium.steep_tint[i])));
    }
    for (const shared::vec4& heights : march.medium.slopes)
        out["slopes"].push_back(numbers(heights));
    out["look"] = gloss_of(march.medium.gloss);
    out["translucency"] = decimal(march.medium.translucency);
    return out;
}

} // namespace

std::string set_json(const grass::GrassSet& set, const std::vector<FileEntry>& files) {
    ordered_json root = {{"format", "Sward grass set"},
                         {"version", grass::kSetFormatVersion},
                         {"preset", set.name},
                         {"seed", set.seed},
                         {"side_m", decimal(set.side_m)},
                         {"canopy_m", decimal(set.canopy_m)},
                         {"offset_range_m", decimal(set.offset_range_m)},
                         {"variants", set.variants},
                         {"density_per_m2", decimal(set.density_per_m2)},
                         {"height_coding", set.height_coding},
                         {"floor", floor_of(set.floor)},
                         {"blades", set.blades.size()}};
    for (const grass::Species& species : set.species)
        root["species"].push_back({{"name", species.name},
                                   {"element", species.element},
                                   {"share", decimal(species.share)},
                                   {"look", look(species.look)}});
    for (std::size_t k = 0; k < set.levels.size(); ++k) {
        const grass::FarLevel& level = set.levels[k];
        root["levels"].push_back(
            {{"size", level.layers.width},
             {"texel_m", decimal(set.side_m / static_cast<float>(level.layers.width))},
             {"layer_count", level.layer_count},
             {"layer_edges_m", decimals(level.layer_edges)},
             {"layer_heights_m", decimals(level.layer_heights)},
             {"slice_count", level.slice_count},
             {"slice_rows", level.slices.height},
             {"layers", grass::layers_file(static_cast<int>(k))},
             {"slices", grass::slices_file(static_cast<int>(k))}});
        if (!level.layers_shape.mips.empty()) {
            root["levels"].back()["layers_shape"] = grass::layers_shape_file(static_cast<int>(k));
            root["levels"].back()["slices_shape"] = grass::slices_shape_file(static_cast<int>(k));
        }
    }
    root["far"] = ordered_json::array();
    for (const grass::FarRow& row : set.far) {
        ordered_json shares = ordered_json::array();
        for (std::size_t k = 0; k < set.levels.size(); ++k)
            shares.push_back(decimal(row.share_at(static_cast<int>(k))));
        root["far"].push_back({{"elevation_deg", decimal(row.elevation_deg)},
                               {"coverage", decimal(row.coverage)},
                               {"height", decimal(row.height)},
                               {"along", decimal(row.along)},
                               {"slice_share", decimal(row.slice_share)},
                               {"shell_share", shares}});
    }
    root["march"] = march_json(set.march);
    const grass::FarLight& light = set.far_light;
    root["far_light"] = {{"leans", decimals(light.leans)},
                         {"lean_azimuths_deg", decimals(light.lean_azimuths_deg)},
                         {"elevations_deg", decimals(light.elevations_deg)},
                         {"sun_elevations_deg", decimals(light.sun_elevations_deg)},
                         {"sun_azimuths", light.sun_azimuths},
                         {"table", grass::kFarLightFile}};
    for (const FileEntry& file : files)
        root["files"][file.name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
    return root.dump(2) + "\n";
}

} // namespace sward::texgen
