// SPDX-License-Identifier: Apache-2.0
#include "shells/far_appearance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <epoxy/gl.h>

#include "shared/bend.h"
#include "shared/bindings.h"
#include "shared/lod.h"

namespace sward::shells {

namespace {

constexpr int kBlades = 96;   // of the set that stand for all; each costs kPlaces evaluations a texel
constexpr int kPlaces = 5;    // along a blade

struct Part {
    std::size_t species;
    shared::vec3 albedo, tangent;
    float height;
    float area; // relative
};

/// Parts of blades at rest, spread over the first variant.
std::vector<RestPart> parts_of_blades(const grass::GrassSet& set) {
    std::vector<RestPart> parts;
    const std::size_t count = set.variant_begin[1];
    for (int n = 0; n < kBlades; ++n) {
        const shared::BladeRecord& blade = set.blades[count * static_cast<std::size_t>(n) / kBlades];
        const glm::vec3 v1(blade.v1), v2(blade.v2);
        const auto species = static_cast<std::size_t>(blade.shape.w);
        const shared::GrassAppearance& look = set.species[species].look;
        for (int i = 0; i < kPlaces; ++i) {
            const float v = shared::blade_station((static_cast<float>(i) + 0.5f) / kPlaces, look.outline);
            parts.push_back({species, shared::blade_albedo(look, {blade.root.z, blade.root.w}, v, 0), shared::blade_tangent(v1, v2, v),
                             std::clamp(shared::blade_curve(v1, v2, v).y, 0.0f, set.canopy_m),
                             blade.v1.w * shared::blade_width_at(v, look.outline) * blade.shape.y});
        }
    }
    return parts;
}

/// Texels of an array's mip 0 as parts; `image` of `height` in metres, or a slice where that is below 0.
void add_texels(const grass::GrassSet& set, const grass::TextureArray& array, int image, float height, std::vector<RestPart>& parts) {
    const std::size_t texels = static_cast<std::size_t>(array.width) * static_cast<std::size_t>(array.height);
    const std::uint8_t* id = array.mips[0].data() + 4 * texels * static_cast<std::size_t>(image);
    const std::uint8_t* shape = id + 4 * texels;
    for (std::size_t t = 0; t < texels; ++t) {
        if (id[4 * t] == 0) {
            continue;
        }
        const auto species = std::min(static_cast<std::size_t>(shared::decode_species(id[4 * t + 3])), set.species.size() - 1);
        const float v = shared::decode_along(id[4 * t + 3]);
        const float row = (static_cast<float>(t / static_cast<std::size_t>(array.width)) + 0.5f) / static_cast<float>(array.height);
        parts.push_back({species, shared::blade_albedo(set.species[species].look, {0.5f, 0.5f}, v, 0),
                         shared::decode_tangent(glm::vec2(shape[4 * t], shape[4 * t + 1]) / 255.0f),
                         height < 0 ? row * set.canopy_m : height, static_cast<float>(id[4 * t])});
    }
}

/// A far-only set has no blades: the texels of its coarsest level stand for them.
std::vector<RestPart> parts_of_textures(const grass::GrassSet& set) {
    const grass::FarLevel& level = set.levels.back();
    if (level.layers.format != grass::TexelFormat::kRgba8 || level.layers.mips.empty()) {
        return {};
    }
    std::vector<RestPart> all;
    for (int i = 0; i < level.layer_count; ++i) {
        add_texels(set, level.layers, shared::layer_index(0, i, level.layer_count, 0), level.layer_heights[static_cast<std::size_t>(i)], all);
    }
    for (const int axis : {shared::kAxisX, shared::kAxisZ}) {
        for (int i = 0; i < level.slice_count; ++i) {
            add_texels(set, level.slices, shared::slice_index(0, axis, i, level.slice_count, 0), -1, all);
        }
    }
    std::vector<RestPart> parts;
    for (std::size_t n = 0; n < kBlades * kPlaces && !all.empty(); ++n) {
        parts.push_back(all[all.size() * n / (kBlades * kPlaces)]);
    }
    return parts;
}

/// The parts as they stand in the mean wind.
std::vector<Part> bent(const std::vector<RestPart>& rest, float canopy_m, const glm::vec4& wind) {
    std::vector<Part> parts;
    for (const RestPart& part : rest) {
        const glm::vec3 turn = shared::bend_turn(part.y, canopy_m, {wind.x, wind.y}, wind.w);
        parts.push_back({part.species, part.albedo,
                         glm::normalize(glm::vec3(part.upright.x, 0, part.upright.z) + part.upright.y * turn), part.y / canopy_m,
                         part.area});
    }
    return parts;
}

/// Share of a part that the eye sees through the canopy above it, and of its width that faces the eye.
float visible(const Part& part, float extinction, const glm::vec3& to_eye) {
    const float along = glm::dot(part.tangent, to_eye);
    return part.area * std::exp(-extinction * (1 - part.height)) * std::sqrt(std::max(1 - along * along, 0.0f));
}

/// Extinction at which the mean height of what is seen is the rays' mean height.
float fit_extinction(const std::vector<Part>& parts, float mean_height, const glm::vec3& to_eye) {
    float low = 0, high = 40;
    for (int step = 0; step < 20; ++step) {
        const float middle = 0.5f * (low + high);
        float weight = 0, sum = 0;
        for (const Part& part : parts) {
            const float w = visible(part, middle, to_eye);
            weight += w;
            sum += w * part.height;
        }
        (sum < mean_height * weight ? low : high) = middle;
    }
    return 0.5f * (low + high);
}

glm::vec4 radiance(const std::vector<Part>& parts, const grass::GrassSet& set, const shared::Light& light, float azimuth, float sine) {
    const float cosine = std::sqrt(1 - sine * sine);
    const glm::vec2 sun = glm::normalize(glm::vec2(light.to_sun.x, light.to_sun.z) + glm::vec2(1e-5f, 0));
    const glm::vec2 flat(sun.x * std::cos(azimuth) - sun.y * std::sin(azimuth), sun.x * std::sin(azimuth) + sun.y * std::cos(azimuth));
    const glm::vec3 to_eye(flat.x * cosine, sine, flat.y * cosine);
    const glm::vec2 row = far_row_at(set, sine);
    const float extinction = fit_extinction(parts, row.y, to_eye);
    glm::vec3 sum(0);
    float weight = 1e-12f;
    for (const Part& part : parts) {
        const float w = visible(part, extinction, to_eye);
        sum += w * shared::shade_grass(set.species[part.species].look, light, {part.albedo, part.tangent, part.height, light.to_sun.y}, to_eye);
        weight += w;
    }
    return {sum / weight, row.x};
}

} // namespace

namespace {

/// A value of the rows (falling elevation) at `place`, linear in what `place_of` makes of a row's elevation in radians, held at
/// both ends.
template<class PlaceOf, class Value>
auto between_rows(const std::vector<grass::FarRow>& rows, float place, PlaceOf place_of, Value value) {
    const auto at = [&](const grass::FarRow& row) { return place_of(row.elevation_deg * shared::kPi / 180); };
    if (place >= at(rows.front())) {
        return value(rows.front());
    }
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const float low = at(rows[i]);
        if (place >= low) {
            return glm::mix(value(rows[i]), value(rows[i - 1]), (place - low) / (at(rows[i - 1]) - low));
        }
    }
    return value(rows.back());
}

} // namespace

glm::vec2 far_row_at(const grass::GrassSet& set, float sine) {
    return between_rows(set.far, sine, [](float elevation) { return std::sin(elevation); },
                        [](const grass::FarRow& row) { return glm::vec2(row.coverage, row.height); });
}

float slice_share_at(const grass::GrassSet& set, float elevation) {
    return between_rows(set.far, elevation, [](float e) { return e; }, [](const grass::FarRow& row) { return row.slice_share; });
}

glm::vec4 shell_share_at(const grass::GrassSet& set, float elevation) {
    const int levels = std::min(static_cast<int>(set.levels.size()), shared::kMaxFarLevels);
    return between_rows(set.far, elevation, [](float e) { return e; }, [levels](const grass::FarRow& row) {
        glm::vec4 shares(1);
        for (int k = 0; k < levels; ++k) {
            shares[k] = row.share_at(k);
        }
        return shares;
    });
}

FarAppearance::FarAppearance(const grass::GrassSet& set)
    : set_(set), rest_(set.blades.empty() ? parts_of_textures(set) : parts_of_blades(set)) {}

void FarAppearance::update(const shared::Light& light, const shared::WindField& wind) {
    if (table_.id() && std::memcmp(&light, &light_, sizeof(light)) == 0 && wind.mean == wind_) {
        return;
    }
    light_ = light;
    wind_ = wind.mean;
    const std::vector<Part> parts = bent(rest_, set_.canopy_m, wind_);
    std::vector<glm::vec4> texels;
    for (int e = 0; e < kElevations; ++e) {
        for (int a = 0; a < kAzimuths; ++a) {
            texels.push_back(radiance(parts, set_, light, shared::kPi * static_cast<float>(a) / (kAzimuths - 1),
                                      static_cast<float>(e) / (kElevations - 1)));
        }
    }
    table_ = gl::Texture(GL_RGBA16F, {kAzimuths, kElevations});
    table_.set_filter(GL_LINEAR, GL_LINEAR);
    table_.set_wrap(GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
    table_.upload(0, GL_RGBA, GL_FLOAT, texels.data());
}

void FarAppearance::bind() const { table_.bind(TEX_FAR_APPEARANCE); }

} // namespace sward::shells
