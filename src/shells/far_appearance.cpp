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
    shared::vec3 albedo, tangent;
    float height;
    float area; // relative
};

/// Parts of blades as they stand in the mean wind, spread over the first variant.
std::vector<Part> parts_of(const grass::GrassSet& set, const glm::vec4& wind) {
    std::vector<Part> parts;
    const std::size_t count = set.variant_begin[1];
    for (int n = 0; n < kBlades; ++n) {
        const shared::BladeRecord& blade = set.blades[count * static_cast<std::size_t>(n) / kBlades];
        const glm::vec3 v1(blade.v1), v2(blade.v2);
        for (int i = 0; i < kPlaces; ++i) {
            const float v = (static_cast<float>(i) + 0.5f) / kPlaces;
            const float y = std::clamp(shared::blade_curve(v1, v2, v).y, 0.0f, set.canopy_m);
            const glm::vec3 upright = shared::blade_tangent(v1, v2, v);
            const glm::vec3 turn = shared::bend_turn(y, set.canopy_m, {wind.x, wind.y}, wind.w);
            parts.push_back({shared::blade_albedo(set.appearance, {blade.root.z, blade.root.w}, v, 0),
                             glm::normalize(glm::vec3(upright.x, 0, upright.z) + upright.y * turn), y / set.canopy_m,
                             blade.v1.w * (1 - v * v) * blade.shape.y});
        }
    }
    return parts;
}

/// Sunlight, and where the mean wind turns an upright blade.
struct Air {
    const shared::Light& light;
    glm::vec3 turn;
};

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

glm::vec4 radiance(const std::vector<Part>& parts, const grass::GrassSet& set, const Air& air, float azimuth, float sine) {
    const float cosine = std::sqrt(1 - sine * sine);
    const glm::vec2 sun = glm::normalize(glm::vec2(air.light.to_sun.x, air.light.to_sun.z) + glm::vec2(1e-5f, 0));
    const glm::vec2 flat(sun.x * std::cos(azimuth) - sun.y * std::sin(azimuth), sun.x * std::sin(azimuth) + sun.y * std::cos(azimuth));
    const glm::vec3 to_eye(flat.x * cosine, sine, flat.y * cosine);
    const shared::Light light = shared::light_in_sway(air.light, shared::canopy_sway(set.appearance, air.turn, air.light.to_sun, to_eye));
    const glm::vec2 row = far_row_at(set, sine);
    const float extinction = fit_extinction(parts, row.y, to_eye);
    glm::vec3 sum(0);
    float weight = 1e-12f;
    for (const Part& part : parts) {
        const float w = visible(part, extinction, to_eye);
        sum += w * shared::shade_grass(set.appearance, light, {part.albedo, part.tangent, part.height, light.to_sun.y}, to_eye);
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

void FarAppearance::update(const shared::Light& light, const shared::WindField& wind) {
    if (table_.id() && std::memcmp(&light, &light_, sizeof(light)) == 0 && wind.mean == wind_) {
        return;
    }
    light_ = light;
    wind_ = wind.mean;
    const std::vector<Part> parts = parts_of(set_, wind_);
    const float canopy = set_.canopy_m;
    const Air air{light, shared::bend_turn(shared::kSwayHeight * canopy, canopy, {wind_.x, wind_.y}, wind_.w)};
    std::vector<glm::vec4> texels;
    for (int e = 0; e < kElevations; ++e) {
        for (int a = 0; a < kAzimuths; ++a) {
            texels.push_back(radiance(parts, set_, air, shared::kPi * static_cast<float>(a) / (kAzimuths - 1),
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
