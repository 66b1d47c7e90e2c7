// SPDX-License-Identifier: Apache-2.0
// Behind <sward/field.h> and <sward/view.h>: every call holds the host's state, and throws the
// public error alone.
#include <cmath>

#include <fmt/format.h>

#include "base/error.h"
#include "gl/context.h"
#include "gl/state_guard.h"
#include "render/access.h"
#include "render/load.h"
#include "sward/version.h"

namespace sward {

namespace {

/// Runs a call of the face. base::Error becomes the public class, with the kind that its exit code
/// stands for.
template<class Call> auto faced(Call call) {
    try {
        return call();
    } catch (const base::Error& error) {
        throw Error(static_cast<ErrorKind>(static_cast<int>(error.code()) - 1), error.what());
    }
}
static_assert(static_cast<int>(ErrorKind::kInside) ==
                  static_cast<int>(base::ExitCode::kFailure) - 1 &&
              static_cast<int>(ErrorKind::kNoGpu) == static_cast<int>(base::ExitCode::kNoGpu) - 1);

/// The same for one that draws.
template<class Call> auto drawn(Call call) {
    return faced([&] {
        const gl::StateGuard guard;
        return call();
    });
}

base::Error bad(const std::string& message) {
    return {base::ExitCode::kBadInput, message};
}

void finish(render::FieldInside& field) {
    while (render::load_step(field) > 0) {
    }
}

render::FieldState& ready(const std::shared_ptr<render::FieldInside>& field) {
    if (!field->state || field->done < render::kLoadSteps) {
        finish(*field);
    }
    return *field->state;
}

render::SimulationSettings settings_of(const SimulationLimits& limits, bool wait) {
    if (!(limits.living_radius_m >= 0 && limits.living_radius_m <= 1e6) ||
        limits.most_blade_steps < 0 || limits.most_wind_steps < 0) {
        throw bad(fmt::format("limits: found a radius of {} m, {} and {} steps, expected 0 to 1e6 "
                              "m and steps of 0 or more",
                              limits.living_radius_m, limits.most_blade_steps,
                              limits.most_wind_steps));
    }
    return {limits.living_blades,    limits.living_radius_m, limits.most_living_bytes,
            limits.most_blade_steps, limits.most_wind_steps, wait};
}

} // namespace

const char* version() {
    return SWARD_VERSION;
}

Field::Field(FieldSource source) : inside_(std::make_shared<render::FieldInside>()) {
    inside_->source = std::move(source);
}
Field::~Field() = default;
Field::Field(Field&&) noexcept = default;
Field& Field::operator=(Field&&) noexcept = default;

double Field::prepare() {
    return drawn([&] { return render::load_step(*inside_); });
}

void Field::simulate(double time_s, std::span<const glm::dvec3> eyes,
                     const SimulationLimits& limits) {
    drawn([&] {
        for (const glm::dvec3& eye : eyes) {
            if (!std::isfinite(eye.x) || !std::isfinite(eye.y) || !std::isfinite(eye.z)) {
                throw bad(fmt::format("simulate: eyes: found {}, {}, {}, expected finite numbers",
                                      eye.x, eye.y, eye.z));
            }
        }
        if (!(time_s >= 0 && time_s <= 1e9)) {
            throw bad(fmt::format("simulate: time_s: found {}, expected 0 to 1e9 seconds", time_s));
        }
        ready(inside_).simulate(time_s, eyes, settings_of(limits, inside_->wait_in_passes));
    });
}

void Field::set_sun(const Sun& sun) {
    drawn([&] {
        if (!(std::abs(sun.azimuth_deg) <= 1e6) || !(std::abs(sun.elevation_deg) <= 90)) {
            throw bad(fmt::format(
                "sun: found azimuth {}, elevation {} degrees, expected any and -90 to 90",
                sun.azimuth_deg, sun.elevation_deg));
        }
        ready(inside_).world.scene.sun = {sun.azimuth_deg, sun.elevation_deg};
    });
}

void Field::set_wind(const MeanWind& wind) {
    drawn([&] { ready(inside_).wind.set_mean({wind.speed_mps, wind.direction_deg, wind.gust}); });
}

void Field::set_arrows(std::span<const Arrow> arrows) {
    drawn([&] {
        std::vector<scene::WindArrow> all;
        for (const Arrow& arrow : arrows) {
            all.push_back({arrow.id, arrow.parent, arrow.root, arrow.tip, arrow.strength_mps,
                           arrow.radius_m, arrow.start_s, arrow.end_s});
        }
        render::check_arrows(all);
        ready(inside_).sources().set_arrows(std::move(all));
    });
}

void Field::set_colliders(std::span<const Ball> balls, double time_s) {
    drawn([&] {
        std::vector<blades::HostSphere> all;
        for (const Ball& ball : balls) {
            all.push_back({ball.centre, ball.radius_m});
        }
        ready(inside_).colliders.set_host_spheres(std::move(all), time_s);
    });
}

void Field::set_blowers(std::span<const Blower> blowers, double time_s) {
    drawn([&] {
        std::vector<scene::MovingWindSource> all;
        for (const Blower& blower : blowers)
            all.push_back(render::source_of(blower, time_s));
        ready(inside_).sources().set_moving(std::move(all));
    });
}

void Field::set_density(double share) {
    drawn([&] { ready(inside_).set_density(share); });
}

void Field::set_objects(std::span<const Body> bodies, double time_s) {
    drawn([&] {
        render::FieldState& state = ready(inside_);
        for (const Body& body : bodies) {
            state.check_object(body.object, body.world_from_body);
        }
        for (const Body& body : bodies) {
            state.set_object(body.object, body.world_from_body, time_s);
        }
    });
}

double Field::ground_height(double x, double z) const {
    return faced([&] { return ready(inside_).surface.height(x, z); });
}

glm::dvec2 Field::wind_at(double x, double z, double time_s) const {
    return faced([&] { return ready(inside_).wind.at(x, z, time_s); });
}

Passed Field::tracks_at(double x, double z) const {
    return drawn([&] {
        if (!std::isfinite(x) || !std::isfinite(z)) {
            throw bad(fmt::format("tracks_at: found {}, {}, expected finite numbers", x, z));
        }
        const render::FieldState& state = ready(inside_);
        if (!state.tracks) {
            throw base::Error(base::ExitCode::kUsage,
                              "tracks_at: found a scene without [tracks], expected one with it");
        }
        const tracks::Tracks::Sample sample = state.tracks->at(x, z);
        return Passed{glm::dvec2(sample.theta), glm::dvec2(sample.pressed)};
    });
}

glm::dvec3 eye_of(const Camera& camera) {
    return faced([&] { return render::lens_of(camera).eye; });
}

View::View(Field& field)
    : inside_(drawn([&] {
          std::shared_ptr<render::FieldInside> of = render::Access::share(field);
          static_cast<void>(ready(of));
          return std::unique_ptr<render::ViewInside>(
              new render::ViewInside{of, {}, render::ViewState(of->state)});
      })) {}

View::~View() {
    if (inside_) {
        const gl::StateGuard guard; // deleting what is bound would unbind it
        inside_.reset();
    }
}
View::View(View&&) noexcept = default;
View& View::operator=(View&&) noexcept = default;

void View::set_quality(const Quality& quality) {
    faced([&] {
        if (!(quality.exposure > 0 && quality.exposure <= 1e6f)) {
            throw bad(fmt::format("quality: exposure: found {}, expected a number above 0",
                                  quality.exposure));
        }
        inside_->settings.samples = quality.samples;
        inside_->settings.exposure = quality.exposure;
    });
}

void View::draw(const Camera& camera, const Target& target) {
    drawn([&] {
        render::FrameSettings& settings = inside_->settings;
        settings.width = target.width;
        settings.height = target.height;
        render::HostTextures host{target.colour, target.depth, target.scene_colour,
                                  target.scene_depth};
        render::check_textures(host, target.width, target.height);
        inside_->state.draw(camera, settings, host);
        if (target.framebuffer) {
            inside_->state.present(*target.framebuffer, target.x, target.y);
        }
    });
}

std::vector<std::uint8_t> View::read_picture() const {
    return drawn([&] { return inside_->state.read_picture().rgb; });
}

namespace render {

Field Access::field_of(World world) {
    gl::require_gl45();
    Field field{FieldSource{}};
    field.inside_->state = std::make_shared<FieldState>(std::move(world));
    field.inside_->done = kLoadSteps;
    return field;
}

} // namespace render
} // namespace sward
