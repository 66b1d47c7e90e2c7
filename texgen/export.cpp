// SPDX-License-Identifier: Apache-2.0
#include "texgen/export.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "assets/assets.h"
#include "base/error.h"
#include "base/file.h"
#include "grass/ktx2.h"
#include "shared/shading.h"
#include "texgen/parallel.h"
#include "texgen/stack_json.h"
#include "texgen/step_timer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kPrefix = "variant";

/// One image of the set, and what it is called.
struct Source {
    std::string name; ///< "variant0_layer03"
    const grass::TextureArray* array = nullptr;
    int id_index = 0, shape_index = 0;
    bool slice = false;
    double place_m = 0; ///< a layer's height above the ground; a slice's middle along its axis
};

/// What one texel says, as numbers; all 0 where nothing stands.
struct TexelValues {
    double coverage = 0;
    shared::vec3 albedo{0}, tangent{0}; ///< linear reflectance; unit
    double rank = 0, seed = 0, along = 0, height = 0;
    shared::vec2 offset{0}; ///< metres to the blade's root, x and z
    int species = 0;
};

class Decoder {
public:
    explicit Decoder(const grass::GrassSet& set) : set_(set) {}

    /// Row 0 at the top of the picture: a slice's ground is at its bottom.
    TexelValues texel(const Source& source, int x, int row) const {
        const grass::TextureArray& array = *source.array;
        const int y = source.slice ? array.height - 1 - row : row;
        const std::size_t bytes =
            grass::mip_bytes(array, 0) / static_cast<std::size_t>(array.layers);
        const std::size_t t = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(array.width) +
                                   static_cast<std::size_t>(x));
        const std::uint8_t* id =
            array.mips[0].data() + bytes * static_cast<std::size_t>(source.id_index) + t;
        const std::uint8_t* shape =
            array.mips[0].data() + bytes * static_cast<std::size_t>(source.shape_index) + t;
        TexelValues v;
        if (id[0] == 0)
            return v;
        const bool height_map = !source.slice && set_.height_coding != shared::kHeightNone; // B1: the byte is a height
        v.coverage = height_map ? 1 : id[0] / 255.0;
        v.rank = (id[1] + 0.5) / 256;
        v.seed = (id[2] + 0.5) / 256;
        v.species = std::min(shared::decode_species(id[3]), static_cast<int>(set_.species.size()) - 1);
        v.along = shared::decode_along(id[3]);
        v.albedo = shared::blade_albedo(set_.species[static_cast<std::size_t>(v.species)].look,
                                        {v.rank, v.seed}, static_cast<float>(v.along), 1);
        v.tangent = shared::decode_tangent(shared::vec2(shape[0], shape[1]) / 255.0f);
        v.offset = shared::decode_offset(shared::vec2(shape[2], shape[3]) / 255.0f, set_.offset_range_m);
        v.height = source.slice ? (y + 0.5) / array.height
                   : height_map ? shared::decode_height(id[0] / 255.0f, set_.height_coding)
                                : source.place_m / set_.canopy_m;
        return v;
    }

private:
    const grass::GrassSet& set_;
};

std::uint8_t byte_of(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

double srgb(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

void write_pngs(const Decoder& decoder, const Source& source, const fs::path& folder) {
    const int w = source.array->width, h = source.array->height;
    assets::ByteImage albedo{w, h, 4, {}, true}, tangent{w, h, 3, {}, false};
    std::array<assets::ByteImage, 4> grey;
    static constexpr const char* kGrey[] = {"rank", "seed", "along", "height"};
    grey.fill({w, h, 1, {}, false});
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const TexelValues v = decoder.texel(source, x, y);
            for (int c = 0; c < 3; ++c)
                albedo.values.push_back(byte_of(srgb(v.albedo[c])));
            albedo.values.push_back(byte_of(v.coverage));
            for (int c = 0; c < 3; ++c) // as a normal map: flat where nothing stands
                tangent.values.push_back(byte_of(v.tangent[c] * 0.5 + 0.5));
            const double values[] = {v.rank, v.seed, v.along, v.height};
            for (std::size_t i = 0; i < grey.size(); ++i)
                grey[i].values.push_back(byte_of(values[i]));
        }
    assets::write_png(folder / (source.name + "_albedo.png"), albedo);
    assets::write_png(folder / (source.name + "_tangent.png"), tangent);
    for (std::size_t i = 0; i < grey.size(); ++i)
        assets::write_png(folder / fmt::format("{}_{}.png", source.name, kGrey[i]), grey[i]);
}

void write_exr(const Decoder& decoder, const Source& source, const fs::path& folder) {
    scene::Image image{source.array->width, source.array->height,
                       {"R", "G", "B", "A", "tangent.X", "tangent.Y", "tangent.Z", "rank", "seed",
                        "along", "height", "offset.X", "offset.Z", "species"},
                       {}, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const TexelValues v = decoder.texel(source, x, y);
            const auto a = static_cast<float>(v.coverage); // colour is premultiplied, as in every EXR
            image.texels.insert(image.texels.end(),
                                {v.albedo.x * a, v.albedo.y * a, v.albedo.z * a, a, v.tangent.x,
                                 v.tangent.y, v.tangent.z, static_cast<float>(v.rank),
                                 static_cast<float>(v.seed), static_cast<float>(v.along),
                                 static_cast<float>(v.height), v.offset.x, v.offset.y,
                                 static_cast<float>(v.species)});
        }
    assets::write_exr(folder / (source.name + ".exr"), image);
}

std::vector<Source> sources_of(const grass::GrassSet& set) {
    const grass::FarLevel& level = set.levels.front();
    const int layers = grass::layer_images(set, level); // 1 for a height map
    std::vector<Source> all;
    for (int v = 0; v < set.variants; ++v) {
        for (int i = 0; i < layers; ++i)
            all.push_back({fmt::format("{}{}_{}", kPrefix, v,
                                       layers == 1 ? std::string("height-map") : fmt::format("layer{:02}", i)), &level.layers,
                           shared::layer_index(v, i, layers, shared::kPlaneId),
                           shared::layer_index(v, i, layers, shared::kPlaneShape), false,
                           layers == 1 ? set.canopy_m : level.layer_heights[static_cast<std::size_t>(i)]});
        for (const int axis : {shared::kAxisX, shared::kAxisZ})
            for (int i = 0; i < level.slice_count; ++i)
                all.push_back({fmt::format("{}{}_slice-{}{:02}", kPrefix, v,
                                           axis == shared::kAxisX ? 'x' : 'z', i),
                               &level.slices,
                               shared::slice_index(v, axis, i, level.slice_count, shared::kPlaneId),
                               shared::slice_index(v, axis, i, level.slice_count, shared::kPlaneShape),
                               true, (i + 0.5) * set.side_m / level.slice_count});
    }
    return all;
}

std::string stack_json(const grass::GrassSet& set, const std::vector<Source>& sources) {
    ordered_json root = {{"format", "Sward pictures"},
                         {"preset", set.name},
                         {"side_m", set.side_m},
                         {"canopy_m", set.canopy_m},
                         {"variants", set.variants},
                         {"tangent", "xyz * 0.5 + 0.5, y up"},
                         {"height", "0 ground .. 1 canopy_m"}};
    for (const Source& source : sources)
        root["images"].push_back({{"name", source.name},
                                  {source.slice ? "middle_m" : "height_m", source.place_m}});
    return root.dump(2) + "\n";
}

} // namespace

fs::path export_directory(const fs::path& set, ExportFormat format) {
    fs::path directory = set;
    return directory += format == ExportFormat::kPng ? "-png" : "-exr";
}

void require_export_place(const fs::path& directory) {
    base::require_writable(directory, base::PendingOutput::Kind::kDirectory);
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error)) {
        const std::string name = it->path().filename().string();
        if (name != kStackJson && !name.starts_with(kPrefix))
            throw base::input_error(base::ExitCode::kIo, directory, 0, "--export",
                                    "a directory with another file: " + base::printable(name),
                                    "earlier pictures, an empty directory, or none yet");
    }
}

void export_pictures(const grass::GrassSet& set, const fs::path& directory, ExportFormat format,
                     int threads) {
    require_export_place(directory);
    const StepTimer timer("pictures");
    base::PendingOutput pending(directory, base::PendingOutput::Kind::kDirectory);
    const std::vector<Source> sources = sources_of(set);
    const Decoder decoder(set);
    {
        base::Progress progress("pictures", sources.size());
        parallel_for(sources.size(), resolve_threads(threads), [&](std::size_t i, int) {
            if (format == ExportFormat::kPng)
                write_pngs(decoder, sources[i], pending.path());
            else
                write_exr(decoder, sources[i], pending.path());
            progress.advance();
        });
    }
    base::write_file_atomic(pending.path() / kStackJson, stack_json(set, sources));
    pending.commit();
    base::log_info(fmt::format("{}: {} images", directory.string(), sources.size()));
}

} // namespace sward::texgen
