// SPDX-License-Identifier: Apache-2.0
#include "app/fly_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "app/controls.h"
#include "app/model_eye.h"
#include "app/model_files.h"
#include "app/paths.h"
#include "app/turn_angles.h"
#include "fly/aeroplane.h"
#include "fly/aeroplane_mesh.h"
#include "render/world.h"

namespace sward::app {
namespace {

constexpr double kNearGround_m = 4;    // a pose lower than this begins on its wheels
constexpr double kKeyThrow = 0.45;     // of the whole: keys know no half
constexpr double kKeyFollow_per_s = 5; // how fast the stick goes where a key sends it
constexpr double kThrottleStep = 0.05;
constexpr double kChaseBack = 1.9, kChaseUp = 0.35; // of its length
constexpr double kChaseFollow_per_s = 2.5, kChasePitch_deg = -8;
constexpr double kBallRadius_m = 0.3; // of a wheel, as the grass feels it
constexpr double kAir = 1.225;        // kg/m3
constexpr double kWashRadii = 8;   // how long the propeller's wash is, and how far it reaches down
constexpr double kWashBelow_m = 8; // higher, no blade feels it
constexpr std::array<const char*, 2> kCameras = {"pilot", "chase"};

class FlySource : public PoseSource {
public:
    explicit FlySource(fly::AeroplaneSpec spec) : spec_(std::move(spec)) {}

    void advance(ViewPose& pose, const PoseMoment& moment) override {
        if (!aeroplane_) // the land is the same for all of a flight
            aeroplane_.emplace(spec_,
                               fly::FlyLand{moment.land.height,
                                            [this, wind = moment.land.wind](double x, double z) {
                                                return wind_beside_wash(wind, {x, z});
                                            }});
        if (!told_ || *told_ != pose.pose.position) // a camera's key, or the beginning
            begin(pose.pose, moment.land.height(pose.pose.position.x, pose.pose.position.z));
        for (const Press& press : moment.input.presses) {
            if (press.action == Action::kDriveCamera) {
                camera_ = (camera_ + 1) % kCameras.size();
                eye_.look_ahead();
            } else if (press.action == Action::kMoreThrottle) {
                throttle_ += kThrottleStep;
            } else if (press.action == Action::kLessThrottle) {
                throttle_ -= kThrottleStep;
            }
        }
        throttle_ = std::clamp(throttle_ + kThrottleStep * moment.input.wheel, 0.0, 1.0);
        aeroplane_->advance(moment.dt_s, stick_of(moment));
        const fly::AeroplaneState state = aeroplane_->state();
        height_m_ = state.position.y - moment.land.height(state.position.x, state.position.z);
        blows_ = height_m_ < kWashBelow_m && state.pull_n > 0;
        eye_.look_aside(moment.input.look_px);
        place_eye(pose, moment);
        told_ = pose.pose.position;
    }

    [[nodiscard]] std::optional<double> speed_mps() const override {
        return aeroplane_ ? std::optional(glm::length(aeroplane_->state().velocity_mps))
                          : std::nullopt;
    }
    [[nodiscard]] std::string note() const override {
        if (!aeroplane_)
            return spec_.name;
        const fly::AeroplaneState state = aeroplane_->state();
        const char* const word = state.crashed                       ? ", crashed"
                                 : state.stalled && !state.on_ground ? ", STALL"
                                                                     : "";
        return fmt::format("{} {:.0f} kt, throttle {:.0f} %{}", spec_.name,
                           state.airspeed_mps * 3600 / 1852, throttle_ * 100, word);
    }

    /// Its wheels.
    [[nodiscard]] std::vector<Ball> bodies() const override {
        if (!aeroplane_)
            return {};
        const fly::AeroplaneState state = aeroplane_->state();
        const double low = kBallRadius_m - spec_.gear_m, half = spec_.gear_track_m / 2;
        std::vector<Ball> balls;
        for (const glm::dvec3& at :
             {glm::dvec3(0, low, -spec_.gear_ahead_m), glm::dvec3(-half, low, spec_.gear_back_m),
              glm::dvec3(half, low, spec_.gear_back_m)})
            balls.push_back({state.position + state.turn * at, kBallRadius_m});
        return balls;
    }

    /// The propeller's wash, where it comes to the ground.
    [[nodiscard]] std::vector<Blower> blowers() const override {
        if (!aeroplane_ || !blows_)
            return {};
        const fly::AeroplaneState state = aeroplane_->state();
        const glm::dvec3 ahead = state.ahead();
        const double area = glm::pi<double>() * spec_.propeller_m * spec_.propeller_m / 4;
        const double speed = std::max(0.0, glm::dot(state.velocity_mps, ahead));
        // Momentum theory: what a disc that pulls so adds to the air behind it.
        const double wash = std::sqrt(speed * speed + 2 * state.pull_n / (kAir * area)) - speed;
        const glm::dvec3 begin = state.position + ahead * (0.35 * spec_.length_m);
        Blower blower;
        blower.kind = Blower::Kind::kJet;
        blower.place = {begin.x, begin.z};
        blower.velocity = {state.velocity_mps.x, state.velocity_mps.z};
        blower.yaw_deg = angles_of(state.turn).yaw + 180;
        blower.radius_m = spec_.propeller_m / 2;
        blower.speed_mps = wash * std::clamp(1 - height_m_ / kWashBelow_m, 0.0, 1.0);
        blower.length_m = kWashRadii * spec_.propeller_m;
        return {blower};
    }

    void add_objects(render::World& world) override {
        first_ = world.scene.objects.size();
        add_model_mesh(world, "aircraft/whole", fly::aeroplane_mesh(spec_), {0.62, 0.62, 0.6});
    }

    [[nodiscard]] std::vector<Body> objects() const override {
        if (!aeroplane_)
            return {};
        const fly::AeroplaneState state = aeroplane_->state();
        return {
            {first_, glm::translate(glm::dmat4(1), state.position) * glm::mat4_cast(state.turn)}};
    }

private:
    /// The wind without its own propeller's wash, which blows between the two places.
    [[nodiscard]] glm::dvec2 wind_beside_wash(const std::function<glm::dvec2(double, double)>& wind,
                                              glm::dvec2 at) const {
        if (!blows_)
            return wind(at.x, at.y);
        const glm::dvec3 right = aeroplane_->state().turn * glm::dvec3(spec_.span_m, 0, 0);
        return (wind(at.x + right.x, at.y + right.z) + wind(at.x - right.x, at.y - right.z)) / 2.0;
    }

    void begin(const scene::Pose& pose, double ground) {
        stick_ = {0, 0, 0};
        if (pose.position.y - ground > kNearGround_m) {
            aeroplane_->put_in_air(pose.position, pose.yaw_deg);
            throttle_ = aeroplane_->cruise_throttle();
        } else {
            aeroplane_->put_on_ground(pose.position.x, pose.position.z, pose.yaw_deg);
            throttle_ = 0;
        }
        eye_.begin(pose.yaw_deg);
    }

    /// Keys move the stick some way, and it goes there in a moment; a device moves it as far as it
    /// is moved.
    fly::Stick stick_of(const PoseMoment& moment) {
        using input::Axis;
        const Input& asked = moment.input;
        const glm::dvec3 wanted = glm::dvec3(asked.move.x, -asked.move.z, asked.move.y) * kKeyThrow;
        stick_ += (wanted - stick_) * (1 - std::exp(-kKeyFollow_per_s * moment.dt_s));
        const auto with = [&](double key, Axis axis) {
            return std::clamp(key + asked.axis(axis), -1.0, 1.0);
        };
        return {with(stick_.x, Axis::kRoll), with(stick_.y, Axis::kPitch),
                with(stick_.z, Axis::kYaw),
                std::clamp(throttle_ + asked.axis(Axis::kThrottle), 0.0, 1.0),
                std::max(asked.axis(Axis::kBrake), throttle_ < kThrottleStep / 2 ? 1.0 : 0.0)};
    }

    void place_eye(ViewPose& view, const PoseMoment& moment) {
        const fly::AeroplaneState state = aeroplane_->state();
        const Angles sight = angles_of(state.turn);
        const ModelEye::Chase chase{kChaseBack * spec_.length_m, kChaseUp * spec_.length_m,
                                    kChaseFollow_per_s, kChasePitch_deg};
        if (camera_ == 1) {
            eye_.come_round(sight.yaw, chase, moment.dt_s);
            eye_.put_behind(view, state.position, chase, moment.land);
        } else
            eye_.put_on_board(view, state.position + state.turn * spec_.eye_m, sight, moment.land);
    }

    fly::AeroplaneSpec spec_;
    std::optional<fly::Aeroplane> aeroplane_;
    std::optional<glm::dvec3> told_;     ///< where the eye was put last
    std::size_t camera_ = 0, first_ = 0; ///< of its objects in the scene
    glm::dvec3 stick_{0};                ///< as the keys have it: roll, pitch, yaw
    ModelEye eye_;
    double throttle_ = 0, height_m_ = 0; ///< over the ground
    bool blows_ = false;
};

} // namespace

fly::AircraftSpec find_aircraft(const std::string& name) {
    return fly::load_aircraft(find_model("--fly", aircraft_directory(), name));
}

std::unique_ptr<PoseSource> make_fly_source(const fly::AeroplaneSpec& spec) {
    return std::make_unique<FlySource>(spec);
}

} // namespace sward::app
