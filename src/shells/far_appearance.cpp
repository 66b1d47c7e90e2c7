// SPDX-License-Identifier: Apache-2.0
#include "shells/far_appearance.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <epoxy/gl.h>

#include "shared/bend.h"
#include "shared/bindings.h"
#include "shared/lod.h"

namespace sward::shells {

namespace {

/// What a value at `x` takes of each node (rising): a cubic through the nodes whose slope at a node
/// is that between its neighbours (Catmull-Rom, uneven); held at both ends.
std::vector<float> cubic_weights(const std::vector<float>& nodes, float x) {
    const std::size_t last = nodes.size() - 1;
    std::vector<float> weights(nodes.size(), 0.0f);
    if (x <= nodes.front() || x >= nodes.back()) {
        weights[x <= nodes.front() ? 0 : last] = 1;
        return weights;
    }
    const auto upper = static_cast<std::size_t>(std::ranges::upper_bound(nodes, x) - nodes.begin());
    const std::size_t lower = upper - 1;
    const float gap = nodes[upper] - nodes[lower], t = (x - nodes[lower]) / gap, t2 = t * t,
                t3 = t2 * t;
    const auto add_slope = [&](std::size_t at, float scale) {
        const std::size_t before = at == 0 ? 0 : at - 1, after = std::min(at + 1, last);
        const float w = scale * gap / (nodes[after] - nodes[before]);
        weights[after] += w;
        weights[before] -= w;
    };
    weights[lower] += 2 * t3 - 3 * t2 + 1;
    weights[upper] += 3 * t2 - 2 * t3;
    add_slope(lower, t3 - 2 * t2 + t);
    add_slope(upper, t3 - t2);
    return weights;
}

/// Sun (rgb) and coverage, sky (rgb) and height, of a view.
struct Look {
    glm::vec4 sun{0}, sky{0};
    void add(float weight, const Look& other) {
        sun += weight * other.sun;
        sky += weight * other.sky;
    }
};

/// The table at one bend and one height of the sun.
class CanopyLight {
public:
    CanopyLight(const grass::FarLight& light, float lean, float sun_elevation_deg) : light_(light) {
        const std::vector<float> leans = cubic_weights(light.leans, lean);
        const std::vector<float> suns = cubic_weights(light.sun_elevations_deg, sun_elevation_deg);
        const std::size_t views = light.images() / light.leans.size();
        looks_.resize(views * azimuths());
        for (std::size_t l = 0; l < leans.size(); ++l) {
            for (std::size_t s = 0; s < suns.size(); ++s) {
                for (std::size_t n = 0; leans[l] * suns[s] != 0 && n < looks_.size(); ++n) {
                    const grass::FarSample& f =
                        light.samples[light.at(l * views + n / azimuths(), s, n % azimuths())];
                    looks_[n].add(leans[l] * suns[s], {{f.sun, f.coverage}, {f.sky, f.height}});
                }
            }
        }
        for (auto elevation = light.elevations_deg.rbegin();
             elevation != light.elevations_deg.rend(); ++elevation) {
            sines_.push_back(std::sin(*elevation * shared::kPi / 180));
        }
        // The circle of lean azimuths: one more node beyond each end, mirrored.
        nodes_ = light.lean_azimuths_deg;
        if (nodes_.size() > 1) {
            nodes_.insert(nodes_.begin(), -nodes_[1]);
            nodes_.push_back(360 - nodes_[nodes_.size() - 2]);
        }
    }

    /// At a sine of the view's elevation; azimuths in radians from the direction to the eye.
    [[nodiscard]] Look at(float sine, float sun_azimuth, float lean_azimuth) const {
        const float degrees = std::remainder(lean_azimuth, 2 * shared::kPi) * 180 / shared::kPi;
        // A canopy that leans to the other side, mirrored with its sun.
        const std::vector<float> leans = cubic_weights(nodes_, std::abs(degrees));
        const float sun = degrees < 0 ? -sun_azimuth : sun_azimuth;
        const std::vector<float> rows = cubic_weights(sines_, sine);
        Look look;
        for (std::size_t n = 0; n < leans.size(); ++n) {
            for (std::size_t r = 0; r < rows.size(); ++r) {
                if (leans[n] * rows[r] != 0) {
                    look.add(leans[n] * rows[r], at_node(n, rows.size() - 1 - r, sun));
                }
            }
        }
        // A cubic may swing past 0 and 1.
        const auto within = [](const glm::vec4& v) {
            return glm::vec4(glm::max(glm::vec3(v), glm::vec3(0)), glm::clamp(v.a, 0.0f, 1.0f));
        };
        return {within(look.sun), within(look.sky)};
    }

private:
    [[nodiscard]] std::size_t azimuths() const {
        return static_cast<std::size_t>(light_.sun_azimuths);
    }

    [[nodiscard]] Look at_node(std::size_t node, std::size_t row, float sun_azimuth) const {
        const std::size_t count = light_.lean_azimuths_deg.size();
        const bool mirrored = count > 1 && (node == 0 || node == count + 1);
        const std::size_t azimuth = count == 1          ? 0
                                    : node == 0         ? 1
                                    : node == count + 1 ? count - 2
                                                        : node - 1;
        const std::size_t first = (azimuth * light_.elevations_deg.size() + row) * azimuths();
        const auto n = static_cast<std::ptrdiff_t>(azimuths());
        const float place =
            (mirrored ? -sun_azimuth : sun_azimuth) / (2 * shared::kPi) * static_cast<float>(n);
        const float t = place - std::floor(place);
        const float weights[4] = {0.5f * t * (t * (2 - t) - 1), 0.5f * (t * t * (3 * t - 5) + 2),
                                  0.5f * t * (t * (4 - 3 * t) + 1), 0.5f * t * t * (t - 1)};
        Look look;
        for (std::ptrdiff_t i = 0; i < 4; ++i) {
            const std::ptrdiff_t a =
                ((static_cast<std::ptrdiff_t>(std::floor(place)) + i - 1) % n + n) % n;
            look.add(weights[i], looks_[first + static_cast<std::size_t>(a)]);
        }
        return look;
    }

    const grass::FarLight& light_;
    std::vector<Look> looks_;  ///< [lean azimuth][view elevation][sun azimuth]
    std::vector<float> sines_; ///< of the view's elevations, rising
    std::vector<float> nodes_; ///< lean azimuths in degrees, from before 0 to beyond 180
};

/// Angle from the direction to the eye to that of `to`, from x towards z.
float angle_of(glm::vec2 to) {
    return std::atan2(to.y, to.x);
}

} // namespace

std::vector<glm::vec4> canopy_table(const grass::FarLight& table, const shared::Light& light,
                                    const glm::vec4& wind) {
    const float speed = glm::length(glm::vec2(wind));
    const CanopyLight canopy(table, shared::bend_intensity(speed, wind.w),
                             std::asin(glm::clamp(light.to_sun.y, -1.0f, 1.0f)) * 180 /
                                 shared::kPi);
    const float sun_heading = angle_of({light.to_sun.x, light.to_sun.z});
    const float lean_heading = speed > 0 ? angle_of(glm::vec2(wind)) : 0;
    const glm::vec4 sun(light.sun, 1);
    const glm::vec4 sky(shared::even_sky(light), 1);
    constexpr int kTexels = FarAppearance::kElevations * FarAppearance::kAzimuths;
    std::vector<glm::vec4> texels(2 * kTexels);
    for (int i = 0; i < kTexels; ++i) {
        const float azimuth = 2 * shared::kPi * static_cast<float>(i % FarAppearance::kAzimuths) /
                              FarAppearance::kAzimuths;
        const float sine =
            static_cast<float>(i / FarAppearance::kAzimuths) / (FarAppearance::kElevations - 1);
        const Look look = canopy.at(sine, azimuth, azimuth + lean_heading - sun_heading);
        texels[static_cast<std::size_t>(i)] = sun * look.sun;
        texels[static_cast<std::size_t>(i + kTexels)] = sky * look.sky;
    }
    return texels;
}

void FarAppearance::update(const shared::Light& light, const shared::WindField& wind) {
    if (table_.id() && std::memcmp(&light, &light_, sizeof(light)) == 0 &&
        glm::vec4(wind.mean, 0, wind.response) == wind_) {
        return;
    }
    light_ = light;
    wind_ = {wind.mean, 0, wind.response};
    std::vector<glm::vec4> texels;
    for (int n = 0; n < shared::kFarWinds; ++n) {
        const std::vector<glm::vec4> one =
            canopy_table(set_.far_light, light, {shared::far_wind(wind, n), 0, wind_.w});
        texels.insert(texels.end(), one.begin(), one.end());
    }
    if (!table_.id()) {
        table_ = gl::Texture(GL_RGBA16F, {kAzimuths, kElevations, 2 * shared::kFarWinds});
        table_.set_filter(GL_LINEAR, GL_LINEAR);
        table_.set_wrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
    }
    table_.upload(0, GL_RGBA, GL_FLOAT, texels.data());
}

void FarAppearance::bind() const {
    table_.bind(TEX_FAR_APPEARANCE);
}

} // namespace sward::shells
