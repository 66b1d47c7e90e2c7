// SPDX-License-Identifier: Apache-2.0
#include "texgen/cli/export.h"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "assets/assets.h"
#include "base/error.h"
#include "base/file.h"
#include "texgen/export/export_texels.h"
#include "texgen/seam/stack_json.h"
#include "texgen/support/parallel.h"
#include "texgen/support/step_timer.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

void write_pngs(const TexelDecoder& decoder, const ImageSource& source, const fs::path& folder) {
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

void write_exr(const TexelDecoder& decoder, const ImageSource& source, const fs::path& folder) {
    scene::Image image{source.array->width,
                       source.array->height,
                       {"R", "G", "B", "A", "tangent.X", "tangent.Y", "tangent.Z", "rank", "seed",
                        "along", "height", "offset.X", "offset.Z", "species"},
                       {},
                       {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const TexelValues v = decoder.texel(source, x, y);
            const auto a =
                static_cast<float>(v.coverage); // colour is premultiplied, as in every EXR
            image.texels.insert(image.texels.end(),
                                {v.albedo.x * a, v.albedo.y * a, v.albedo.z * a, a, v.tangent.x,
                                 v.tangent.y, v.tangent.z, static_cast<float>(v.rank),
                                 static_cast<float>(v.seed), static_cast<float>(v.along),
                                 static_cast<float>(v.height), v.offset.x, v.offset.y,
                                 static_cast<float>(v.species)});
        }
    assets::write_exr(folder / (source.name + ".exr"), image);
}

std::string stack_json(const grass::GrassSet& set, const std::vector<ImageSource>& sources) {
    ordered_json root = {{"format", "Sward pictures"},
                         {"preset", set.name},
                         {"side_m", set.side_m},
                         {"canopy_m", set.canopy_m},
                         {"variants", set.variants},
                         {"tangent", "xyz * 0.5 + 0.5, y up"},
                         {"height", "0 ground .. 1 canopy_m"}};
    for (const ImageSource& source : sources)
        root["images"].push_back(
            {{"name", source.name}, {source.slice ? "middle_m" : "height_m", source.place_m}});
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
    for (fs::directory_iterator it(directory, error), end; !error && it != end;
         it.increment(error)) {
        const std::string name = it->path().filename().string();
        if (name != kStackJson && !name.starts_with(kVariantPrefix))
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
    const std::vector<ImageSource> sources = image_sources(set);
    const TexelDecoder decoder(set);
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
