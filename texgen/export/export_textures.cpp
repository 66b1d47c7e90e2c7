// SPDX-License-Identifier: Apache-2.0
#include "texgen/export/export_textures.h"

#include <algorithm>
#include <bit>
#include <functional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "assets/assets.h"
#include "base/error.h"
#include "base/file.h"
#include "grass/ktx2.h"
#include "grass/set_files.h"
#include "texgen/bake/set_files_check.h"
#include "texgen/export/atlas.h"
#include "texgen/export/export_texels.h"
#include "texgen/seam/stack_json.h"
#include "texgen/support/parallel.h"
#include "texgen/support/step_timer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Layers or slices: what goes into one array, variant by variant.
struct Group {
    std::string name; ///< "layers"
    std::vector<ImageSource> images;
    int width = 0, height = 0, mips = 0;
    AtlasPlan atlas; ///< of one variant

    [[nodiscard]] int per_variant(const grass::GrassSet& set) const {
        return static_cast<int>(images.size()) / set.variants;
    }
};

std::vector<Group> groups_of(const grass::GrassSet& set) {
    std::vector<Group> groups(2);
    groups[0].name = "layers";
    groups[1].name = "slices";
    for (ImageSource& source : image_sources(set))
        groups[source.slice ? 1 : 0].images.push_back(std::move(source));
    for (Group& group : groups) {
        const grass::TextureArray& array = *group.images.front().array;
        group.width = array.width;
        group.height = array.height;
        group.mips = std::bit_width(static_cast<unsigned>(std::max(array.width, array.height)));
        group.atlas = plan_atlas(group.per_variant(set), group.width, group.height);
    }
    return groups;
}

std::string array_file(const char* kind, const Group& group) {
    return fmt::format("{}_{}.ktx2", kind, group.name);
}
std::string atlas_file(const char* kind, const Group& group, int variant, const char* ending) {
    return fmt::format("{}_{}_variant{}.{}", kind, group.name, variant, ending);
}

void check_atlas(const Group& group, const fs::path& set) {
    const int side = std::max(group.atlas.width(), group.atlas.height());
    if (side > static_cast<int>(grass::kMaxPlainSide))
        throw base::input_error(
            base::ExitCode::kOverLimit, set, 0, "atlas of " + group.name,
            fmt::format("{} texels a side", side),
            fmt::format("at most {}: --no-atlas leaves them out", grass::kMaxPlainSide));
}

/// What an image without a blade shows: the mean of all others.
AlbedoTexel mean_texel(const Group& group, const TexelDecoder& decoder) {
    constexpr int kStep = 7; // texels: a sample is enough
    AlbedoTexel sum;
    double weight = 0;
    for (const ImageSource& source : group.images)
        for (int y = 0; y < group.height; y += kStep)
            for (int x = 0; x < group.width; x += kStep) {
                const TexelValues v = decoder.texel(source, x, y);
                sum.albedo += v.albedo * static_cast<float>(v.coverage);
                weight += v.coverage;
            }
    if (weight > 0)
        sum.albedo /= static_cast<float>(weight);
    sum.tangent = {0, 1, 0};
    return sum;
}

/// A file that some worker encodes.
struct Part {
    std::string name;
    std::function<void(const fs::path&)> write;
};

void write_parts(const std::vector<Part>& parts, const fs::path& folder, int threads) {
    parallel_for(parts.size(), resolve_threads(threads),
                 [&](std::size_t i, int) { parts[i].write(folder / parts[i].name); });
}

Part ktx2_part(std::string name, const grass::TextureArray& array, int compression) {
    return {std::move(name), [&array, compression](const fs::path& path) {
                base::write_file_atomic(path, grass::encode_ktx2(array, compression));
            }};
}

Part png_part(std::string name, const grass::TextureArray& array, bool colour) {
    return {std::move(name), [&array, colour](const fs::path& path) {
                assets::write_png(path, {array.width, array.height, 4, array.mips[0], colour});
            }};
}

/// The atlas of one variant, and its images into the arrays.
void write_variant(const grass::GrassSet& set, const Group& group, int variant,
                   AlbedoArrays& arrays, const fs::path& folder, const TextureExport& options) {
    const TexelDecoder decoder(set);
    const AlbedoTexel empty = mean_texel(group, decoder);
    const AtlasPlan& plan = group.atlas;
    AlbedoArrays atlas =
        empty_arrays(plan.width(), plan.height(), 1, options.atlases ? plan.mips : 0);
    atlas.albedo.plain = atlas.tangent.plain = true;
    const int count = group.per_variant(set), rows = plan.tile_height - group.height;
    parallel_for(static_cast<std::size_t>(count), resolve_threads(options.threads),
                 [&](std::size_t task, int) {
                     const int i = static_cast<int>(task), layer = variant * count + i;
                     const ImageSource& source = group.images[static_cast<std::size_t>(layer)];
                     const std::vector<AlbedoImage> mips =
                         albedo_mips(albedo_image(decoder, source), group.mips, empty);
                     store_layer(mips, layer, arrays);
                     if (options.atlases)
                         store_tile(rows == 0 ? mips
                                              : albedo_mips(albedo_image(decoder, source, rows),
                                                            plan.mips, empty),
                                    plan, i, atlas);
                 });
    if (!options.atlases)
        return;
    write_parts(
        {png_part(atlas_file("albedo", group, variant, "png"), atlas.albedo, true),
         png_part(atlas_file("tangent", group, variant, "png"), atlas.tangent, false),
         ktx2_part(atlas_file("albedo", group, variant, "ktx2"), atlas.albedo, options.compression),
         ktx2_part(atlas_file("tangent", group, variant, "ktx2"), atlas.tangent,
                   options.compression)},
        folder, options.threads);
}

bool is_far_file(const std::string& name) {
    constexpr const char* kPlanes[] = {"layers", "slices"};
    return name == grass::kFarLightPicture ||
           (name.ends_with(".ktx2") && std::ranges::none_of(kPlanes, [&](const char* stem) {
                return name.starts_with(stem);
            }));
}

ordered_json image_json(const grass::GrassSet& set, const Group& group, int index, bool atlases) {
    const ImageSource& source = group.images[static_cast<std::size_t>(index)];
    ordered_json out = {{"name", source.name},
                        {"array", group.name},
                        {"index", index},
                        {"variant", source.variant}};
    if (source.slice)
        out["axis"] = source.axis == shared::kAxisX ? "x" : "z";
    out[source.slice ? "middle_m" : "height_m"] = source.place_m;
    out["slab_m"] = {source.from_m, source.to_m};
    if (atlases) {
        const shared::vec4 place = group.atlas.place(index % group.per_variant(set), group.height);
        out["atlas_uv"] = {place.x, place.y, place.z, place.w};
    }
    return out;
}

ordered_json rgb(const glm::vec3& c) {
    return {c.x, c.y, c.z};
}

ordered_json group_json(const grass::GrassSet& set, const Group& group, bool atlases) {
    ordered_json out = {{"width", group.width},
                        {"height", group.height},
                        {"mips", group.mips},
                        {"images", group.images.size()},
                        {"albedo", array_file("albedo", group)},
                        {"tangent", array_file("tangent", group)}};
    for (int v = 0; atlases && v < set.variants; ++v) {
        ordered_json files = {{"variant", v},
                              {"width", group.atlas.width()},
                              {"height", group.atlas.height()},
                              {"mips", group.atlas.mips},
                              {"rim_texels", group.atlas.rim}};
        for (const char* kind : {"albedo", "tangent"})
            files[kind] = {atlas_file(kind, group, v, "ktx2"), atlas_file(kind, group, v, "png")};
        out["atlases"].push_back(files);
    }
    return out;
}

std::string textures_json(const grass::GrassSet& set, const std::vector<Group>& groups,
                          ordered_json far_field, bool atlases) {
    ordered_json root = {
        {"format", "Sward textures"},
        {"version", 1},
        {"preset", set.name},
        {"side_m", set.side_m},
        {"canopy_m", set.canopy_m},
        {"variants", set.variants},
        {"floor",
         {{"cover", set.floor.cover},
          {"moss", rgb(set.floor.moss)},
          {"litter", rgb(set.floor.litter)}}},
        {"albedo", "RGB sRGB, colour of the nearest blades under alpha 0; A linear, straight"},
        {"tangent",
         "RGB x, y, z * 0.5 + 0.5 along the blade, y up; A height, 0 ground .. 1 canopy_m"}};
    for (const Group& group : groups)
        root["arrays"][group.name] = group_json(set, group, atlases);
    root["far_field"] = std::move(far_field);
    for (const Group& group : groups)
        for (int i = 0; i < static_cast<int>(group.images.size()); ++i)
            root["images"].push_back(image_json(set, group, i, atlases));
    return root.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// Copies the far field's files, each after a look at its hash; returns what set.json says of them.
ordered_json copy_far_field(const fs::path& set, const fs::path& folder) {
    std::vector<std::string> names;
    for (const FileEntry& entry : listed_files(set))
        if (is_far_file(entry.name)) {
            base::write_file_atomic(folder / entry.name, checked_file(set, entry));
            names.push_back(entry.name);
        }
    std::ranges::sort(names);
    ordered_json out = {{"files", names}};
    const ordered_json root = ordered_json::parse(
        base::read_text(set / grass::kSetJson, grass::kMaxSetJsonBytes), nullptr, false);
    for (const char* key : {"march", "far", "far_light"})
        if (root.is_object() && root.contains(key))
            out[key] = root[key];
    return out;
}

} // namespace

void write_textures(const grass::GrassSet& set, const fs::path& set_directory,
                    const fs::path& folder, const TextureExport& options) {
    const StepTimer timer("textures");
    const std::vector<Group> groups = groups_of(set);
    for (const Group& group : groups)
        if (options.atlases)
            check_atlas(group, set_directory);
    base::Progress progress("textures", groups.size() * static_cast<std::size_t>(set.variants));
    for (const Group& group : groups) {
        AlbedoArrays arrays = empty_arrays(group.width, group.height,
                                           static_cast<int>(group.images.size()), group.mips);
        for (int v = 0; v < set.variants; ++v) {
            write_variant(set, group, v, arrays, folder, options);
            progress.advance();
        }
        write_parts({ktx2_part(array_file("albedo", group), arrays.albedo, options.compression),
                     ktx2_part(array_file("tangent", group), arrays.tangent, options.compression)},
                    folder, options.threads);
    }
    base::write_file_atomic(
        folder / kStackJson,
        textures_json(set, groups, copy_far_field(set_directory, folder), options.atlases));
}

} // namespace sward::texgen
