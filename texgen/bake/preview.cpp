// SPDX-License-Identifier: Apache-2.0
// A contact sheet that shows at a look whether a set is good: blades in perspective, top view,
// tiling, side view, mips.
#include "texgen/bake/preview.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "assets/assets.h"
#include "base/hash.h"
#include "base/log.h"
#include "shared/shading.h"
#include "texgen/bake/canvas.h"
#include "texgen/far/flat_rays.h"
#include "texgen/patch/rays.h"
#include "texgen/support/parallel.h"

namespace sward::texgen {
namespace {

using glm::dvec3;

constexpr int kMargin = 8;
constexpr int kPanel = 400;
constexpr int kCaption = 22; // pixels above a panel
const dvec3 kPaper(0.01);
const dvec3 kSun = glm::normalize(dvec3(0.5, 0.75, 0.35));
const dvec3 kSoil(0.075, 0.055, 0.038);
const dvec3 kSky(0.45, 0.60, 0.80);
constexpr double kExposure = 1.6;

/// The renderer's own shading (G4), under a fixed sun, seen from above.
class Shader {
public:
    explicit Shader(const grass::GrassSet& set) {
        for (const grass::Species& species : set.species)
            looks_.push_back(species.look);
    }

    /// `blade`: species, rank, seed, place along the blade.
    struct Place {
        std::size_t species;
        double rank, seed, along;
    };
    dvec3 colour(const Place& at, dvec3 tangent, double height) const {
        const shared::GrassAppearance& look = looks_[std::min(at.species, looks_.size() - 1)];
        const shared::vec3 albedo = shared::blade_albedo(look, shared::vec2(at.rank, at.seed),
                                                         static_cast<float>(at.along), 1);
        const auto top = static_cast<float>(std::clamp(height, 0.0, 1.0));
        return shared::shade_grass(
            look, light_, {albedo, shared::vec3(tangent), top, light_.to_sun.y}, {0, 1, 0});
    }
    static dvec3 ground() { return kSoil * 0.5; }
    [[nodiscard]] std::span<const shared::GrassAppearance> looks() const { return looks_; }

private:
    std::vector<shared::GrassAppearance> looks_;
    shared::Light light_{shared::vec3(kSun), 0.55f, {3.4f, 3.2f, 2.8f},  0,
                         {0.2f, 0.4f, 0.8f}, 1.1f,  {0.8f, 0.95f, 1.1f}, 1};
};

/// One image of an array, both planes.
class Image {
public:
    Image(const grass::TextureArray& array, int id_index, int shape_index, int mip)
        : width(std::max(1, array.width >> mip)), height(std::max(1, array.height >> mip)),
          id_(array.mips[static_cast<std::size_t>(mip)].data() +
              bytes() * static_cast<std::size_t>(id_index)),
          shape_(array.mips[static_cast<std::size_t>(mip)].data() +
                 bytes() * static_cast<std::size_t>(shape_index)) {}

    /// Colour and coverage of a texel.
    std::pair<dvec3, double> texel(const Shader& shader, int x, int y, double layer_height) const {
        const std::size_t t = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(x));
        double coverage = id_[t] / 255.0;
        if (coverage == 0)
            return {dvec3(0), 0};
        if (height_coding !=
            shared::kHeightNone) { // B1: the byte is the height of what is seen from above
            layer_height = shared::decode_height(static_cast<float>(coverage), height_coding);
            coverage = 1;
        }
        const shared::vec3 tangent =
            shared::decode_tangent(shared::vec2(shape_[t], shape_[t + 1]) / 255.0f);
        const Shader::Place place{static_cast<std::size_t>(shared::decode_species(id_[t + 3])),
                                  (id_[t + 1] + 0.5) / 256, (id_[t + 2] + 0.5) / 256,
                                  shared::decode_along(id_[t + 3])};
        return {shader.colour(place, tangent, layer_height), coverage};
    }

    const int width, height;
    int height_coding = shared::kHeightNone; ///< of a height map's image

private:
    [[nodiscard]] std::size_t bytes() const {
        return 4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    const std::uint8_t* id_;
    const std::uint8_t* shape_;
};

/// All layers of a level seen from above, front to back, at a mip. `covered`: the mean coverage.
Canvas top_view(const grass::GrassSet& set, const Shader& shader, int level, int variant,
                int mip = 0, double* covered = nullptr) {
    const grass::FarLevel& far = set.levels[static_cast<std::size_t>(level)];
    Canvas canvas(std::max(1, far.layers.width >> mip), std::max(1, far.layers.height >> mip),
                  dvec3(0));
    std::vector<double> clear(canvas.texels.size(), 1.0);
    for (int i = grass::layer_images(set, far) - 1; i >= 0; --i) {
        Image image(far.layers, grass::layer_image(set, far, variant, i, shared::kPlaneId),
                    grass::layer_image(set, far, variant, i, shared::kPlaneShape), mip);
        image.height_coding = set.height_coding;
        for (int y = 0; y < canvas.height; ++y)
            for (int x = 0; x < canvas.width; ++x) {
                const auto [colour, coverage] = image.texel(
                    shader, x, y, far.layer_heights[static_cast<std::size_t>(i)] / set.canopy_m);
                double& open = clear[static_cast<std::size_t>(y * canvas.width + x)];
                canvas.at(x, y) += colour * coverage * open;
                open *= 1 - coverage;
            }
    }
    double open = 0;
    for (std::size_t t = 0; t < clear.size(); ++t) {
        canvas.texels[t] += Shader::ground() * clear[t];
        open += clear[t];
    }
    if (covered)
        *covered = 1 - open / static_cast<double>(clear.size());
    return canvas;
}

/// The z-slices of a quarter of the patch, seen along z against the sky.
Canvas side_view(const grass::GrassSet& set, const Shader& shader) {
    const grass::FarLevel& far = set.levels.front();
    Canvas canvas(far.slices.width, far.slices.height, dvec3(0));
    std::vector<double> clear(canvas.texels.size(), 1.0);
    for (int i = 0; i < std::max(1, far.slice_count / 4); ++i) {
        const Image image(
            far.slices,
            shared::slice_index(0, shared::kAxisZ, i, far.slice_count, shared::kPlaneId),
            shared::slice_index(0, shared::kAxisZ, i, far.slice_count, shared::kPlaneShape), 0);
        for (int y = 0; y < canvas.height; ++y)
            for (int x = 0; x < canvas.width; ++x) {
                const auto [colour, coverage] =
                    image.texel(shader, x, canvas.height - 1 - y, 1 - (y + 0.5) / canvas.height);
                double& open = clear[static_cast<std::size_t>(y * canvas.width + x)];
                canvas.at(x, y) += colour * coverage * open;
                open *= 1 - coverage;
            }
    }
    for (std::size_t t = 0; t < clear.size(); ++t)
        canvas.texels[t] += kSky * 0.3 * clear[t];
    return canvas;
}

/// Nine tiles of hashed variants: no seam may show.
Canvas tiling(const grass::GrassSet& set, const Shader& shader) {
    const int level = std::min<int>(1, static_cast<int>(set.levels.size()) - 1);
    std::vector<Canvas> tops;
    for (int v = 0; v < set.variants; ++v)
        tops.push_back(top_view(set, shader, level, v));
    const int size = tops.front().width;
    Canvas canvas(3 * size, 3 * size, dvec3(0));
    for (int tile = 0; tile < 9; ++tile) {
        const auto& top = tops[base::hash64(5, 5, static_cast<std::uint64_t>(tile)) % tops.size()];
        for (int y = 0; y < size; ++y)
            std::copy_n(&top.at(0, y), size, &canvas.at(tile % 3 * size, tile / 3 * size + y));
    }
    return canvas;
}

/// What a ray sees of the grass: of its blades, or of the textures of a far-only set, upright
/// there.
class Sight {
public:
    Sight(const grass::GrassSet& set, const Shader& shader)
        : set_(set), shader_(shader),
          blades_(std::span(set.blades).subspan(0, set.variant_begin[1]), shader.looks(),
                  set.side_m, set.canopy_m),
          textures_(set, 0, 0, {}) {}

    [[nodiscard]] std::optional<dvec3> colour(dvec3 eye, dvec3 direction, std::uint64_t ray) const {
        if (set_.blades.empty()) {
            const auto hit = textures_.cast(eye, direction, ray);
            return hit ? std::optional(shader_.colour({0, 0.5, 0.5, hit->along}, dvec3(0, 1, 0),
                                                      hit->height / set_.canopy_m))
                       : std::nullopt;
        }
        const auto hit = blades_.cast(eye, direction);
        if (!hit)
            return std::nullopt;
        const shared::BladeRecord& blade = set_.blades[hit->blade];
        const dvec3 tangent = shared::blade_tangent(shared::vec3(blade.v1), shared::vec3(blade.v2),
                                                    static_cast<float>(hit->along));
        return shader_.colour({species_of(blade), blade.root.z, blade.root.w, hit->along}, tangent,
                              hit->position.y / set_.canopy_m);
    }

private:
    const grass::GrassSet& set_;
    const Shader& shader_;
    BladeField blades_;
    FlatField textures_;
};

/// Rays through the grass from knee height.
Canvas perspective(const grass::GrassSet& set, const Shader& shader, int threads) {
    constexpr int kSide = 2; // samples
    Canvas canvas(kPanel * 3 / 2, kPanel, dvec3(0));
    const Sight sight(set, shader);
    const double canopy = set.canopy_m;
    const dvec3 eye(0.3, canopy * 3.2, 0.2);
    const double pitch = -0.50, focal = 1.4;
    base::Progress progress("preview", static_cast<std::size_t>(canvas.height));
    parallel_for(
        static_cast<std::size_t>(canvas.height), resolve_threads(threads),
        [&](std::size_t row, int) {
            for (int x = 0; x < canvas.width; ++x)
                for (int s = 0; s < kSide * kSide; ++s) {
                    const double u = (x + (s % kSide + 0.5) / kSide - canvas.width / 2.0) /
                                     (canvas.height / 2.0);
                    const double v = 1 - (static_cast<double>(row) + (s / kSide + 0.5) / kSide) /
                                             (canvas.height / 2.0);
                    const dvec3 ahead(0.5, 0, -0.866), right(0.866, 0, 0.5), up(0, 1, 0);
                    const dvec3 view = focal * (std::cos(pitch) * ahead + std::sin(pitch) * up) +
                                       u * right +
                                       v * (std::cos(pitch) * up - std::sin(pitch) * ahead);
                    const dvec3 direction = glm::normalize(view);
                    dvec3 colour = direction.y > -0.02 ? kSky * 0.3 : Shader::ground();
                    if (direction.y < -0.02)
                        colour = sight
                                     .colour(eye, direction,
                                             row * 4096 + static_cast<std::uint64_t>(4 * x + s))
                                     .value_or(colour);
                    canvas.at(x, static_cast<int>(row)) +=
                        colour / static_cast<double>(kSide * kSide);
                }
            progress.advance();
        });
    return canvas;
}

scene::Picture encode(const Canvas& canvas) {
    scene::Picture picture{canvas.width, canvas.height, {}};
    picture.rgb.reserve(canvas.texels.size() * 3);
    for (const dvec3& texel : canvas.texels)
        for (int c = 0; c < 3; ++c) {
            const double v = std::clamp(texel[c] * kExposure, 0.0, 1.0);
            const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
            picture.rgb.push_back(static_cast<std::uint8_t>(std::lround(s * 255)));
        }
    return picture;
}

/// "2 m", "25 cm", "4 mm".
std::string readable_length(double metres) {
    if (metres >= 1)
        return fmt::format("{:.3g} m", metres);
    return metres >= 0.01 ? fmt::format("{:.3g} cm", metres * 100)
                          : fmt::format("{:.2g} mm", metres * 1000);
}

/// The sheet, filled panel by panel from the top left.
class Sheet {
public:
    Sheet(int width, int height) : canvas(width, height, kPaper) {}

    /// A picture with a caption above it and a scale bar in its corner, where `pixels_per_m` is
    /// known.
    void panel(const Canvas& picture, glm::ivec4 box, const std::string& caption,
               double pixels_per_m = 0) {
        canvas.text(caption, box.x, box.y - kCaption + 3);
        canvas.place(picture, box.x, box.y, box.z, box.w);
        if (pixels_per_m > 0)
            scale_bar(box, pixels_per_m);
    }

    Canvas canvas;

private:
    /// A round length of a tenth to a quarter of the panel.
    void scale_bar(glm::ivec4 box, double pixels_per_m) {
        const double most = box.z * 0.3 / pixels_per_m;
        double length = std::pow(10, std::floor(std::log10(most)));
        for (const double step : {5.0, 2.0})
            if (length * step <= most) {
                length *= step;
                break;
            }
        const int pixels = static_cast<int>(std::lround(length * pixels_per_m));
        const std::string words = readable_length(length);
        const int x = box.x + box.z - pixels - 12, y = box.y + box.w - 12;
        const int wide = std::max(pixels, text_width(words, 1));
        canvas.fill(box.x + box.z - wide - 18, y - 14, wide + 14, 24, dvec3(0.01));
        canvas.fill(x, y, pixels, 3, dvec3(0.5));
        canvas.text(words, box.x + box.z - wide - 12, y - 10, {1, dvec3(0.5)});
    }
};

constexpr int kMips = 5;

/// Mips of level 0, one beside the other: the same colour and coverage, ever coarser.
void place_mips(Sheet& sheet, const grass::GrassSet& set, const Shader& shader, glm::ivec2 corner,
                int side) {
    for (int m = 0; m < std::min<int>(kMips, static_cast<int>(set.levels[0].layers.mips.size()));
         ++m) {
        double covered = 0;
        const Canvas picture = top_view(set, shader, 0, 0, m, &covered);
        sheet.panel(picture, {corner.x + m * (side + kMargin), corner.y, side, side},
                    fmt::format("mip {}: covers {:.1f} %", m, 100 * covered));
    }
}

std::string title(const grass::GrassSet& set) {
    const int texels = set.levels[0].layers.width;
    return fmt::format(
        "{}: {} m, {} variants, {:.0f} blades/m2, canopy {}, {} texels of {}, seed {}", set.name,
        set.side_m, set.variants, set.density_per_m2, readable_length(set.canopy_m), texels,
        readable_length(static_cast<double>(set.side_m) / texels), set.seed);
}

std::string species_line(const grass::GrassSet& set) {
    std::string words;
    for (const grass::Species& species : set.species)
        words += fmt::format("{}{} {:.0f} %", words.empty() ? "" : ", ", species.name,
                             100 * species.share);
    return words;
}

} // namespace

void write_preview(const grass::GrassSet& set, const std::filesystem::path& path, int threads) {
    const Shader shader(set);
    constexpr int kWidth = kPanel * 3 / 2 + 2 * kPanel + 4 * kMargin;
    constexpr int kFull = kWidth - 2 * kMargin;
    const int side_rows =
        std::clamp(static_cast<int>(kFull * set.canopy_m / set.side_m), 24, kPanel);
    const int mip_side = (kFull - (kMips - 1) * kMargin) / kMips;
    const int top = 2 * kMargin + 3 * kCaption, middle = top + kPanel + kMargin + kCaption,
              bottom = middle + side_rows + kMargin + kCaption;
    Sheet sheet(kWidth, bottom + mip_side + kMargin);
    sheet.canvas.text(title(set), kMargin, kMargin + 2);
    const std::string species =
        species_line(set); // eight long names pass the sheet's edge: smaller then
    sheet.canvas.text(species, kMargin, kMargin + 2 + kCaption,
                      {text_width(species, 2) < kFull ? 2 : 1});
    const double patch_scale = kPanel / static_cast<double>(set.side_m);
    sheet.panel(perspective(set, shader, threads), {kMargin, top, kPanel * 3 / 2, kPanel},
                "blades in perspective");
    sheet.panel(top_view(set, shader, 0, 0), {kPanel * 3 / 2 + 2 * kMargin, top, kPanel, kPanel},
                "layers from above, variant 0", patch_scale);
    sheet.panel(tiling(set, shader), {kPanel * 5 / 2 + 3 * kMargin, top, kPanel, kPanel},
                "3 x 3 tiles, mixed variants", patch_scale / 3);
    const double side_scale = kFull / static_cast<double>(set.side_m);
    const double stretch = side_rows / (set.canopy_m * side_scale);
    sheet.panel(side_view(set, shader), {kMargin, middle, kFull, side_rows},
                std::abs(stretch - 1) < 0.05
                    ? "slices across z from the side, a quarter of the patch deep"
                    : fmt::format("slices across z from the side, height x {:.2f}", stretch),
                side_scale);
    place_mips(sheet, set, shader, {kMargin, bottom}, mip_side);
    assets::write_png(path, encode(sheet.canvas));
}

} // namespace sward::texgen
