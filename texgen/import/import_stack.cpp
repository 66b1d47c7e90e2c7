// SPDX-License-Identifier: Apache-2.0
#include "texgen/import/import_stack.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "texgen/seam/seam_images.h"
#include "texgen/vdb/vdb_file.h"

namespace sward::texgen {
namespace {

namespace fs = std::filesystem;
using assets::LayerImage;
using base::ExitCode;

constexpr std::size_t kMaxVoxels = std::size_t{1} << 27;

/// Opacity and linear colour of a picture's texel.
struct Seen {
    float opacity = 0;
    glm::vec3 colour{0};
};

float linear(float srgb) {
    return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Seen texel_of(const LayerImage& image, std::size_t texel) {
    const float* p = &image.values[texel * static_cast<std::size_t>(image.channels)];
    const bool whole =
        image.type == LayerImage::Type::kUint8 || image.type == LayerImage::Type::kUint16;
    const float scale = image.type == LayerImage::Type::kUint8    ? 1 / 255.0f
                        : image.type == LayerImage::Type::kUint16 ? 1 / 65535.0f
                                                                  : 1.0f;
    const int alpha = image.alpha(), colours = image.channels - (alpha >= 0 ? 1 : 0);
    Seen out;
    for (int c = 0; c < 3; ++c)
        out.colour[c] = p[colours >= 3 ? c : 0] * scale;
    out.opacity = std::clamp(
        alpha >= 0 ? p[alpha] * scale : glm::dot(out.colour, glm::vec3(0.2126f, 0.7152f, 0.0722f)),
        0.0f, 1.0f);
    for (int c = 0; c < 3; ++c) // integers hold sRGB and straight alpha, floats linear light that
                                // alpha has been multiplied into
        out.colour[c] = std::clamp(whole                           ? linear(out.colour[c])
                                   : out.opacity > 0 && alpha >= 0 ? out.colour[c] / out.opacity
                                                                   : out.colour[c],
                                   0.0f, 1.0f);
    return out;
}

/// The rows of voxels that each layer fills: bounds half-way between the heights.
std::vector<int> slab_rows(const std::vector<double>& heights, double canopy, int rows) {
    std::vector<int> begins = {0};
    for (std::size_t i = 1; i < heights.size(); ++i)
        begins.push_back(
            static_cast<int>(std::lround((heights[i - 1] + heights[i]) / 2 / canopy * rows)));
    begins.push_back(rows);
    return begins;
}

class StackVolume {
public:
    StackVolume(const fs::path& directory, double side_m, double canopy_m)
        : file_(directory / kStackJson), description_(describe(directory)),
          stack_(read_stack(directory)),
          side_(length(side_m, description_.side_m, "side_m", "--side")),
          canopy_(length(canopy_m, description_.canopy_m, "canopy_m", "--canopy")) {}

    Volume run() {
        const LayerImage& first = stack_.images.front();
        if (first.width != first.height)
            refuse(ExitCode::kBadInput, "pictures",
                   fmt::format("{} x {} texels", first.width, first.height), "squares");
        Volume out;
        out.voxel_m = side_ / first.width;
        const double rows = std::ceil(canopy_ / out.voxel_m - 1e-6);
        if (first.width > kMaxVdbSide || rows > kMaxVdbSide)
            refuse(ExitCode::kOverLimit, "stack",
                   fmt::format("{} x {} x {} voxels", first.width, first.width, rows),
                   fmt::format("at most {} a side", kMaxVdbSide));
        out.cells = {first.width, std::max(1, static_cast<int>(rows)), first.width};
        out.period_m = side_;
        const std::vector<int> begins = slab_rows(heights(), canopy_, out.cells.y);
        for (std::size_t i = 0; i < stack_.images.size(); ++i)
            fill(stack_.images[i], begins[i], begins[i + 1], out);
        return out;
    }

private:
    [[noreturn]] void refuse(ExitCode code, std::string_view what, const std::string& found,
                             const std::string& expected) const {
        throw base::input_error(code, file_, 0, what, found, expected);
    }

    static StackDescription describe(const fs::path& directory) {
        if (auto found = read_stack_json(directory))
            return *found;
        throw base::input_error(ExitCode::kBadInput, directory, 0, "stack",
                                std::string("no ") + kStackJson,
                                "the sizes and heights of its pictures: docs/texgen.md");
    }

    double length(double given, const std::optional<double>& told, const char* key,
                  const char* option) const {
        if (given > 0)
            return given;
        if (!told || !(*told > 0))
            refuse(ExitCode::kBadInput, key, "nothing",
                   fmt::format("metres, here or by {}", option));
        return *told;
    }

    [[nodiscard]] std::vector<double> heights() const {
        std::vector<double> out;
        const auto count = static_cast<double>(description_.layers.size());
        for (const StackLayer& layer : description_.layers)
            out.push_back(
                layer.height_m.value_or((static_cast<double>(out.size()) + 0.5) * canopy_ / count));
        if (out.back() > canopy_)
            refuse(ExitCode::kBadInput, "images: height_m", fmt::format("{}", out.back()),
                   fmt::format("at most canopy_m, {}", canopy_));
        return out;
    }

    void fill(const LayerImage& image, int begin, int end, Volume& out) const {
        if (end <= begin)
            return;
        std::vector<Seen> texels(static_cast<std::size_t>(image.width) *
                                 static_cast<std::size_t>(image.height));
        for (std::size_t t = 0; t < texels.size(); ++t) {
            texels[t] = texel_of(image, t);
            // Rows behind each other hide as much as the picture.
            texels[t].opacity =
                1 - std::pow(1 - texels[t].opacity, 1.0f / static_cast<float>(end - begin));
        }
        for (int y = begin; y < end; ++y)
            for (std::size_t t = 0; t < texels.size(); ++t) {
                if (!(texels[t].opacity > 0))
                    continue;
                if (out.at.size() >= kMaxVoxels)
                    refuse(ExitCode::kOverLimit, "stack", "more voxels",
                           fmt::format("at most {}", kMaxVoxels));
                const auto width = static_cast<std::size_t>(image.width);
                out.at.push_back({static_cast<std::uint16_t>(t % width),
                                  static_cast<std::uint16_t>(y),
                                  static_cast<std::uint16_t>(t / width)});
                out.density.push_back(texels[t].opacity);
                out.colour.push_back(texels[t].colour);
            }
    }

    fs::path file_;
    StackDescription description_;
    LayerStack stack_;
    double side_, canopy_;
};

} // namespace

Volume read_stack_volume(const fs::path& directory, double side_m, double canopy_m) {
    return StackVolume(directory, side_m, canopy_m).run();
}

} // namespace sward::texgen
