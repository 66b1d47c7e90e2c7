// SPDX-License-Identifier: Apache-2.0
#include "wind/wind.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "base/log.h"
#include "shared/bindings.h"

namespace sward::wind {

namespace {

constexpr double kTwoPi = 6.283185307179586;
// The two layers: turned by the golden angle against each other and scaled by the golden section,
// so that their sum does not repeat. The squares of the weights add to 1: independent gusts of the
// same strength in the sum.
constexpr double kLayerTurn[shared::kWindLayers] = {0.35, 0.35 + 2.39996322972865};
constexpr double kLayerScale[shared::kWindLayers] = {1, 0.61803398874989};
constexpr double kLayerWeight[shared::kWindLayers] = {0.8, 0.6};
constexpr double kBlendShare =
    0.06; // of the window's side: the width over which it passes into the ambient wind

glm::dvec2 cpu_tap(const shared::WindTap& tap, std::span<const glm::vec4> cells, float latest) {
    const auto fetch = [&](int i) { return cells[static_cast<std::size_t>(i)]; };
    return shared::wind_tap_velocity(tap, fetch(tap.at.x), fetch(tap.at.y), fetch(tap.at.z),
                                     fetch(tap.at.w), latest);
}

glm::dvec2 mean_of(const scene::WindSpec& spec) {
    const double from =
        spec.direction_deg * kTwoPi / 360; // where it comes from, clockwise from north (-z)
    // Gusts lengthen the mean velocity to the mean speed: half of that is taken off, so that both
    // are near speed_mps.
    const double turbulence = AmbientTile::kGustShare * spec.gust;
    return glm::dvec2(-std::sin(from), std::cos(from)) * spec.speed_mps *
           (1 - 0.25 * turbulence * turbulence);
}

constexpr double kMostGain = 3; // faint gusts are no strong ones drawn small

} // namespace

Wind::Wind(const scene::WindSpec& spec, double response, std::unique_ptr<FluidInputs> inputs)
    : spec_(spec), response_(response), mean_(mean_of(spec)), inputs_(std::move(inputs)) {
    glCreateTextures(GL_TEXTURE_BUFFER, 2, textures_);
    begin_gusts(std::make_unique<AmbientTile>(spec));
    for (int layer = 0; layer < shared::kWindLayers; ++layer) {
        const auto random = [&](std::uint64_t n) {
            return base::hash_unit(static_cast<std::uint64_t>(spec.seed), 0x1a7e,
                                   static_cast<std::uint64_t>(layer) * 2 + n);
        };
        shift_[layer] = glm::dvec2(random(0), random(1)) * static_cast<double>(AmbientTile::kCells);
    }
}

Wind::~Wind() {
    glDeleteTextures(2, textures_);
}

void Wind::point_textures() {
    glTextureBuffer(textures_[0], GL_RGBA32F, ambient_->cells().id());
    glTextureBuffer(textures_[1], GL_RGBA32F,
                    window_ ? window_->fluid().cells().id() : ambient_->cells().id());
}

void Wind::bind() const {
    glBindTextureUnit(TEX_WIND_AMBIENT, textures_[0]);
    glBindTextureUnit(TEX_WIND_LOCAL, textures_[1]);
}

shared::WindField Wind::compose(glm::dvec2 anchor, double time_s, const StateTag& ambient,
                                const StateTag& window) const {
    shared::WindField field{};
    field.mean = glm::vec2(mean_);
    field.response = static_cast<float>(response_);
    if (ambient_->strength_mps() > 0) {
        const double n = ambient.cells;
        field.tile_cells = ambient.cells;
        field.tile_share = static_cast<float>(ambient.share(time_s));
        const glm::dvec2 from = anchor - carried(time_s);
        const double gain = gust_gain(time_s);
        for (int layer = 0; layer < shared::kWindLayers; ++layer) {
            const double cell = ambient.cell_m * kLayerScale[layer],
                         c = std::cos(kLayerTurn[layer]) / cell,
                         s = std::sin(kLayerTurn[layer]) / cell;
            const glm::dvec2 place =
                glm::dvec2(c * from.x + s * from.y, -s * from.x + c * from.y) + shift_[layer];
            const glm::dvec2 wrapped = place - n * glm::floor(place / n);
            field.layers[layer] = {
                glm::vec2(wrapped),       {c, s}, static_cast<float>(kLayerWeight[layer] * gain),
                static_cast<float>(cell), 0,      0};
        }
    }
    if (window.cells > 0) {
        const glm::dvec2 corner = glm::dvec2(window.first_cell) * window.cell_m - anchor;
        const glm::ivec2 n(window.cells);
        field.window_corner_m = glm::vec2(corner);
        field.window_per_m = static_cast<float>(1 / window.cell_m);
        field.window_cells = window.cells;
        field.window_first = ((window.first_cell % n) + n) % n;
        field.window_share = static_cast<float>(window.share(time_s));
        const double fade = std::max(window_fade(time_s), 1e-2);
        // A rim as wide as the window and wider leaves little of it.
        field.window_rim = static_cast<float>(kBlendShare * window.cells / (fade * fade * fade));
    }
    return field;
}

shared::WindField Wind::field(glm::dvec2 anchor, double time_s) const {
    return compose(anchor, time_s, ambient_->tag(), window_ ? window_->tag() : StateTag{});
}

glm::dvec2 Wind::at(double x, double z, double time_s) const {
    const bool ambient_landed = ambient_back_->landed(),
               window_landed = window_back_ && window_back_->landed();
    StateTag first;
    first.step_s = AmbientTile::kStep_s;
    first.cells = AmbientTile::kCells;
    first.cell_m = AmbientTile::kCell_m;
    const shared::WindField field =
        compose({x, z}, time_s, ambient_landed ? ambient_back_->tag() : first,
                window_landed ? window_back_->tag() : StateTag{});
    glm::dvec2 sum(field.mean);
    if (field.tile_cells > 0) {
        const std::span<const glm::vec4> cells =
            ambient_landed ? ambient_back_->cells()
                           : std::span<const glm::vec4>(ambient_->initial());
        for (int layer = 0; layer < shared::kWindLayers; ++layer) {
            const shared::WindTap tap =
                shared::wind_tile_tap(static_cast<float>(field.tile_cells),
                                      shared::wind_layer_place(field, layer, glm::vec2(0)));
            sum += glm::dvec2(
                shared::wind_layer_velocity(field, layer, cpu_tap(tap, cells, field.tile_share)));
        }
    }
    const glm::vec2 place = -field.window_corner_m * field.window_per_m;
    const float share = shared::wind_window_share(field, place);
    if (share > 0) {
        sum += (cpu_tap(shared::wind_window_tap(field, place), window_back_->cells(),
                        field.window_share) -
                sum) *
               static_cast<double>(share);
    }
    return sum;
}

void Wind::restart(double time_s) {
    const double start = time_s > kLeap_s ? time_s - kRunUp_s : 0;
    if (start > 0) {
        base::log_info(
            fmt::format("wind: a leap to {:.0f} s begins {:.0f} s before it", time_s, kRunUp_s));
    }
    if (change_ != Change::kNone) { // a new beginning is the new wind's
        begin_gusts(std::make_unique<AmbientTile>(spec_, *ambient_, 0));
    }
    ambient_->begin(static_cast<std::int64_t>(start / AmbientTile::kStep_s));
    window_.reset();
    ambient_back_->clear();
    window_back_.reset();
    eye_.reset();
    time_s_ = start;
    point_textures();
}

void Wind::step_ambient(double time_s) {
    if (ambient_->strength_mps() > 0) {
        while (ambient_->tag().latest < steps_for(time_s, AmbientTile::kStep_s)) {
            ambient_->step();
        }
        glTextureBuffer(textures_[0], GL_RGBA32F, ambient_->cells().id());
    }
}

void Wind::advance(double time_s, glm::dvec2 eye, int most_steps) {
    if (!std::isfinite(time_s) || !std::isfinite(eye.x) || !std::isfinite(eye.y)) {
        throw base::Error(base::ExitCode::kBadInput,
                          fmt::format("wind: found time {} s at {}, {} m, expected finite numbers",
                                      time_s, eye.x, eye.y));
    }
    time_s = std::max(time_s, 0.0);
    const double covered =
        window_ ? std::max(time_s, static_cast<double>(window_->tag().latest) * spec_.step_s)
                : time_s;
    const bool back =
        time_s < time_s_ && (steps_for(covered, AmbientTile::kStep_s) < ambient_->tag().latest ||
                             (window_ && steps_for(time_s, spec_.step_s) < window_->tag().latest));
    if (back || time_s - time_s_ > kLeap_s) {
        restart(time_s);
    }
    const std::int64_t ambient_before = ambient_->tag().latest,
                       window_before = window_ ? window_->tag().latest : -1;
    advance_window(time_s, eye, most_steps);
    step_ambient(time_s);
    settle(time_s);
    if (ambient_->tag().latest != ambient_before) {
        ambient_back_->start(ambient_->cells(), ambient_->tag());
    }
    if (window_ && window_->tag().latest != window_before) {
        if (!window_back_) {
            window_back_ = std::make_unique<ReadBack>(window_->fluid().cells().bytes());
        }
        window_back_->start(window_->fluid().cells(), window_->tag());
    }
    point_textures();
    ambient_back_->poll();
    if (window_back_) {
        window_back_->poll();
    }
    time_s_ = time_s;
    eye_ = eye;
}

void Wind::wait() {
    // A copy may not have found a free slot: what waits is taken first, then the present states
    // follow.
    ambient_back_->poll(true);
    if (!ambient_back_->landed() || ambient_back_->tag().latest != ambient_->tag().latest) {
        ambient_back_->start(ambient_->cells(), ambient_->tag());
        ambient_back_->poll(true);
    }
    if (window_back_) {
        window_back_->poll(true);
        if (!window_back_->landed() || window_back_->tag().latest != window_->tag().latest) {
            window_back_->start(window_->fluid().cells(), window_->tag());
            window_back_->poll(true);
        }
    }
}

double Wind::lag_s(double time_s) const {
    return window_
               ? std::max(0.0, time_s - static_cast<double>(window_->tag().latest) * spec_.step_s)
               : 0;
}

double Wind::gust_gain(double time_s) const {
    const double share = glm::clamp((time_s - change_s_) / kFade_s, 0.0, 1.0);
    switch (change_) {
    case Change::kNone:
        return 1;
    case Change::kBlows:
        return gain_;
    case Change::kFades:
        return gain_ * (1 - share);
    case Change::kComes:
        return share;
    }
    return 1;
}

/// Of a wind that began so, and has blown from time 0 on.
void Wind::begin_gusts(std::unique_ptr<AmbientTile> tile) {
    ambient_ = std::move(tile);
    ambient_back_ = std::make_unique<ReadBack>(ambient_->cells().bytes());
    next_.reset();
    change_ = Change::kNone;
    drift_ = glm::dvec2(0);
    drift_from_s_ = 0;
    gain_ = 1;
    point_textures();
}

void Wind::set_mean(const MeanWind& wind) {
    if (!(wind.speed_mps >= 0 && wind.speed_mps <= 60) || !(std::abs(wind.direction_deg) <= 1e6) ||
        !(wind.gust >= 0 && wind.gust <= 1)) {
        throw base::Error(base::ExitCode::kBadInput,
                          fmt::format("wind: found {} m/s from {} degrees, gust {}, expected 0 to "
                                      "60 m/s, a direction, gust 0 to 1",
                                      wind.speed_mps, wind.direction_deg, wind.gust));
    }
    if (wind.speed_mps == spec_.speed_mps && wind.direction_deg == spec_.direction_deg &&
        wind.gust == spec_.gust) {
        return;
    }
    drift_ = carried(time_s_);
    drift_from_s_ = time_s_;
    // A change within a change goes on from what blows.
    const double share = glm::clamp((time_s_ - change_s_) / kFade_s, 0.0, 1.0);
    const double faded = change_ == Change::kFades   ? 1 - share
                         : change_ == Change::kComes ? share
                                                     : 1;
    spec_.speed_mps = wind.speed_mps;
    spec_.direction_deg = wind.direction_deg;
    spec_.gust = wind.gust;
    mean_ = mean_of(spec_);
    if (time_s_ == 0 && ambient_->tag().latest == 0) {
        begin_gusts(std::make_unique<AmbientTile>(spec_, *ambient_, 0));
    } else {
        const double strength = AmbientTile::kGustShare * spec_.gust * spec_.speed_mps;
        gain_ = ambient_->strength_mps() > 0
                    ? std::min(strength / ambient_->strength_mps(), kMostGain) * faded
                    : 0;
        change_ = Change::kBlows;
        change_s_ = time_s_;
        next_.reset();
    }
    if (window_) {
        window_->set_mean(spec_, mean_);
    }
}

/// The next stage of a change, once it is due.
void Wind::settle(double time_s) {
    const double since = time_s - change_s_;
    const auto now = spec_.gust * spec_.speed_mps > 0 ? steps_for(time_s, AmbientTile::kStep_s)
                                                      : 0; // air without gusts has no states
    if (change_ == Change::kBlows && since >= kSettled_s && !next_) {
        const double start = time_s > kLeap_s ? time_s - kRunUp_s : 0;
        next_ = std::make_unique<AmbientTile>(
            spec_, *ambient_, static_cast<std::int64_t>(start / AmbientTile::kStep_s));
    }
    // One more than fall due: it overtakes, and no frame bears several of the first steps, which
    // are up to eight times as long (Fluid::iterations).
    const std::int64_t due =
        steps_for(time_s, AmbientTile::kStep_s) - steps_for(time_s_, AmbientTile::kStep_s);
    for (std::int64_t i = 0; next_ && i <= due && next_->tag().latest < now; ++i) {
        next_->step();
    }
    if (change_ == Change::kBlows && next_ && next_->tag().latest >= now) {
        change_ = Change::kFades;
        change_s_ = time_s;
    } else if (change_ == Change::kFades && since >= kFade_s && next_->tag().latest >= now) {
        begin_gusts(std::move(next_));
        change_ = Change::kComes;
        change_s_ = time_s;
    } else if (change_ == Change::kComes && since >= kFade_s) {
        change_ = Change::kNone;
    }
}

void Wind::reload() {
    ambient_->reload();
    if (window_) {
        window_->reload();
    }
}

} // namespace sward::wind
