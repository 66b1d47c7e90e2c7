// SPDX-License-Identifier: Apache-2.0
#include "shells/march_light.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <epoxy/gl.h>
#include <glm/gtc/packing.hpp>

#include "shared/bend.h"
#include "shared/bindings.h"
#include "shared/march_light.h"
#include "shells/far_appearance.h"

namespace sward::shells {

namespace {

static_assert(MarchLight::kAzimuths == FarAppearance::kAzimuths &&
              MarchLight::kElevations == FarAppearance::kElevations);

constexpr float kLeastSine =
    0.02f; // a lower view is as this one: rays along the ground have no end

glm::vec4 mean_texel(const grass::TextureArray& density, std::size_t image) {
    glm::vec4 texel(0);
    for (int c = 0; c < 4; ++c) {
        std::uint16_t half = 0;
        std::memcpy(&half, &density.mips.back()[8 * image + 2 * static_cast<std::size_t>(c)], 2);
        texel[c] = glm::unpackHalf1x16(half);
    }
    return texel;
}

/// A ray down through a level canopy that the wind has bent.
shared::MarchPath level_path(float canopy, const glm::vec4& wind, const glm::vec3& way) {
    const float speed = glm::length(glm::vec2(wind));
    const glm::vec2 to = speed > 0 ? glm::vec2(wind) / speed : glm::vec2(1, 0);
    shared::MarchPath path;
    path.way = way;
    path.bend = {to, 0.5f * shared::kPi * shared::bend_intensity(speed, wind.w) / canopy, 0};
    path.bend.w = shared::march_bent_height(path, canopy);
    path.from = {0, path.bend.w, 0};
    path.height = {path.bend.w, way.y, 0, -path.bend.w / way.y};
    return path;
}

} // namespace

MeanMarch::MeanMarch(const grass::GrassSet& set)
    : medium_(set.march.medium),
      look_(set.species.empty() ? shared::GrassAppearance{} : set.species.front().look) {
    const grass::TextureArray& density = set.march.columns.density;
    for (std::size_t layer = 0; layer < shared::kMarchLayers; ++layer) {
        glm::vec4 sum(0);
        for (std::size_t variant = 0; variant < static_cast<std::size_t>(set.variants); ++variant) {
            sum += mean_texel(density, variant * shared::kMarchLayers + layer);
        }
        albedo_[layer] = glm::vec3(sum) / std::max(sum.a, 1e-4f);
    }
    constexpr std::size_t kRow =
        (shared::kMarchColumns * shared::kMarchMips + shared::kMarchMips - 1) *
        shared::kMarchElevations;
    for (std::size_t e = 0; e < shared::kMarchElevations; ++e) {
        correction_[e] = set.march.correction[(kRow + e) * grass::kMarchFactors];
    }
}

glm::vec3 MeanMarch::radiance(const shared::Light& light, const glm::vec4& wind,
                              const glm::vec3& to_eye) const {
    constexpr float kFootprint = 10; // patches
    const shared::MarchPath path = level_path(medium_.canopy_m, wind, -to_eye);
    shared::MarchPlan plan =
        shared::march_look(medium_, path, {kFootprint * medium_.side_m / 1000, 1000, 1});
    plan.kind = shared::kMarchColumns;
    shared::march_settle(medium_, plan);
    const float at = std::clamp(plan.elevation / 5, 0.0f, shared::kMarchElevations - 1.001f);
    const auto row = static_cast<std::size_t>(at);
    const float scale =
        glm::mix(correction_[row], correction_[row + 1], at - static_cast<float>(row));
    const glm::vec3 turn = shared::bend_turn(shared::kSwayHeight * medium_.canopy_m,
                                             medium_.canopy_m, glm::vec2(wind), wind.w);
    const shared::Light here =
        shared::light_in_sway(light, shared::canopy_sway(look_, turn, light.to_sun, to_eye));
    const float steepness = shared::march_steepness(medium_, plan, path.way.y);
    shared::GrassSums sums = shared::march_nothing();
    float through = 1;
    shared::MarchWalk walk = shared::march_begin(path);
    for (int n = 0;
         n < shared::kMarchSteps && shared::march_inside(path, walk) && through > shared::kMarchEnd;
         ++n) {
        const shared::MarchStep step =
            shared::march_step(medium_, path, plan, walk, {static_cast<float>(n), scale});
        const float left = through * std::exp(-shared::march_beside(scale * step.depth));
        const auto layer = static_cast<std::size_t>(step.layer);
        const glm::vec3 tangent =
            shared::march_turned(path, step.rest.y, {0, medium_.layers[step.layer].x, 0});
        shared::march_gather(sums, here, light.to_sun.y,
                             {albedo_[layer] * shared::march_tint(medium_, step.layer, steepness),
                              tangent, step.rest.y / medium_.canopy_m, through - left});
        through = left;
    }
    const float elevation = std::asin(std::clamp(to_eye.y, 0.0f, 1.0f)) * 180 / shared::kPi;
    shared::march_stand(medium_, sums, here, {elevation, 0, light.to_sun.y}, to_eye);
    return shared::march_radiance(medium_, here, sums, to_eye) / std::max(1 - through, 1e-4f);
}

std::vector<float> light_factors(const MeanMarch& mean, const grass::FarLight& truth,
                                 const shared::Light& light, const glm::vec4& wind) {
    const std::vector<glm::vec4> seen = canopy_table(truth, light, wind);
    const float to_sun = std::atan2(light.to_sun.z, light.to_sun.x);
    std::vector<float> factors;
    for (int row = 0; row < MarchLight::kElevations; ++row) {
        for (int column = 0; column < MarchLight::kAzimuths; ++column) {
            const float sine =
                std::max(static_cast<float>(row) / (MarchLight::kElevations - 1), kLeastSine);
            const float flat = std::sqrt(std::max(1 - sine * sine, 0.0f));
            const float heading =
                to_sun - 2 * shared::kPi * static_cast<float>(column) / MarchLight::kAzimuths;
            const glm::vec3 marched = mean.radiance(
                light, wind, {flat * std::cos(heading), sine, flat * std::sin(heading)});
            const std::size_t texel = factors.size();
            const glm::vec3 wanted =
                glm::vec3(seen[texel]) + glm::vec3(seen[texel + seen.size() / 2]);
            // One factor for all colours: the march has the blades' own colours, the far light
            // those of their mean.
            const glm::vec3 luminance(0.2126f, 0.7152f, 0.0722f);
            factors.push_back(std::clamp(glm::dot(wanted, luminance) /
                                             std::max(glm::dot(marched, luminance), 1e-6f),
                                         1 / MarchLight::kMost, MarchLight::kMost));
        }
    }
    return factors;
}

namespace {

constexpr float kLowestSun = -0.2f; // surface_view.glsl has it: where no sunlight is left

/// The light over a surface that the sun stands so high over (sine), and that faces as much of the
/// sky as most of a round mesh does.
shared::Light light_from(const shared::Light& light, float sine) {
    constexpr float kOpenSky = 0.75f;
    shared::Light here = shared::light_under(light, kOpenSky);
    const glm::vec2 heading(light.to_sun.x, light.to_sun.z);
    const float flat = glm::length(heading);
    const float level = std::sqrt(std::max(1 - sine * sine, 0.0f));
    const glm::vec2 to = flat > 1e-4f ? heading * (level / flat) : glm::vec2(level, 0);
    here.to_sun = {to.x, sine, to.y};
    return here;
}

} // namespace

MarchLight::MarchLight(const grass::GrassSet& set, bool mesh)
    : far_light_(set.far_light), suns_(mesh ? kSuns : 1) {
    if (!set.march.columns.density.mips.empty()) {
        mean_.emplace_back(set);
    }
}

bool MarchLight::is_of(const shared::Light& light, const shared::WindField& wind) const {
    return mean_.empty() || (table_.id() && std::memcmp(&light, &light_, sizeof(light)) == 0 &&
                             glm::vec4(wind.mean, 0, wind.response) == wind_);
}

void MarchLight::update(const shared::Light& light, const shared::WindField& wind) {
    if (is_of(light, wind)) {
        return;
    }
    begin(light, wind);
    while (!add_part()) {
    }
}

void MarchLight::follow(const shared::Light& light, const shared::WindField& wind) {
    if (!table_.id()) {
        update(light, wind);
        return;
    }
    if (parts_ == 0) {
        if (is_of(light, wind)) {
            return;
        }
        begin(light, wind);
    }
    add_part();
}

void MarchLight::begin(const shared::Light& light, const shared::WindField& wind) {
    next_light_ = light;
    next_wind_ = wind;
    parts_ = 0;
    next_.assign(static_cast<std::size_t>(suns_) * kAzimuths * kElevations, glm::vec4(0));
}

bool MarchLight::add_part() {
    static_assert(shared::kFarWinds < 4, "a channel each");
    const int sun = parts_ / shared::kFarWinds, gust = parts_ % shared::kFarWinds;
    const shared::Light from =
        suns_ == 1 ? next_light_
                   : light_from(next_light_,
                                glm::mix(kLowestSun, 1.0f, static_cast<float>(sun) / (kSuns - 1)));
    const std::vector<float> part =
        light_factors(mean_.front(), far_light_, from,
                      {shared::far_wind(next_wind_, gust), 0, next_wind_.response});
    for (std::size_t i = 0; i < part.size(); ++i) {
        next_[static_cast<std::size_t>(sun) * part.size() + i][gust] = part[i];
    }
    if (++parts_ < suns_ * shared::kFarWinds) {
        return false;
    }
    light_ = next_light_;
    wind_ = {next_wind_.mean, 0, next_wind_.response};
    parts_ = 0;
    if (!table_.id()) {
        table_ = gl::Texture(GL_RGBA16F, {kAzimuths, kElevations, suns_});
        table_.set_filter(GL_LINEAR, GL_LINEAR);
        table_.set_wrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
    }
    table_.upload(0, GL_RGBA, GL_FLOAT, next_.data());
    return true;
}

void MarchLight::bind() const {
    table_.bind(TEX_MARCH_LIGHT);
}

} // namespace sward::shells
