// SPDX-License-Identifier: Apache-2.0
#include "app/fly_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "app/controls.h"
#include "app/model_files.h"
#include "app/paths.h"
#include "app/pilot_seat.h"
#include "app/turn_angles.h"
#include "fly/aeroplane.h"
#include "fly/aeroplane_mesh.h"
#include "render/world.h"

namespace sward::app {
namespace {

constexpr double kNearGround_m = 4; // a pose lower than this begins on its wheels
constexpr double kThrottleStep = 0.05;
constexpr double kBallRadius_m = 0.3; // of a wheel, as the grass feels it
constexpr double kAir = 1.225;        // kg/m3
constexpr double kWashRadii = 8;   // how long the propeller's wash is, and how far it reaches down
constexpr double kWashBelow_m = 8; // higher, no blade feels it

PilotSeat::Feel feel_of(const fly::AeroplaneSpec& spec) {
    return {.lever_step = kThrottleStep,
            .key_follow_per_s = 5,
            .chase = {.back_m = 1.9 * spec.length_m,
                      .up_m = 0.35 * spec.length_m,
                      .per_s = 2.5,
                      .pitch_deg = -8}};
}

class FlySource : public PoseSource {
public:
    explicit FlySource(const fly::AeroplaneSpec& spec) : spec_(spec), seat_(feel_of(spec)) {}

    void advance(ViewPose& pose, const PoseMoment& moment) override {
        if (!aeroplane_) // the land is the same for all of a flight
            aeroplane_.emplace(spec_,
                               fly::FlyLand{moment.land.height,
                                            [this, wind = moment.land.wind](double x, double z) {
                                                return wind_beside_wash(wind, {x, z});
                                            }});
        if (!told_ || *told_ != pose.pose.position) // a camera's key, or the beginning
            begin(pose.pose, moment.land.height(pose.pose.position.x, pose.pose.position.z));
        seat_.take(moment);
        aeroplane_->advance(moment.dt_s, stick_of(moment.input));
        const fly::AeroplaneState state = aeroplane_->state();
        height_m_ = state.position.y - moment.land.height(state.position.x, state.position.z);
        blows_ = height_m_ < kWashBelow_m && state.pull_n > 0;
        seat_.place_eye(pose, moment, {state.position, state.turn, spec_.eye_m});
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
                           state.airspeed_mps * 3600 / 1852, seat_.lever() * 100, word);
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
        double throttle = 0;
        if (pose.position.y - ground > kNearGround_m) {
            aeroplane_->put_in_air(pose.position, pose.yaw_deg);
            throttle = aeroplane_->cruise_throttle();
        } else {
            aeroplane_->put_on_ground(pose.position.x, pose.position.z, pose.yaw_deg);
        }
        seat_.begin(pose.yaw_deg, throttle);
    }

    /// The wheels' brakes hold while the throttle is closed.
    [[nodiscard]] fly::Stick stick_of(const Input& input) const {
        const glm::dvec3 stick = seat_.stick(input);
        const double closed = seat_.lever() < kThrottleStep / 2 ? 1.0 : 0.0;
        return {stick.x, stick.y, stick.z, seat_.lever(input),
                std::max(input.axis(input::Axis::kBrake), closed)};
    }

    fly::AeroplaneSpec spec_;
    std::optional<fly::Aeroplane> aeroplane_;
    std::optional<glm::dvec3> told_; ///< where the eye was put last
    std::size_t first_ = 0;          ///< of its objects in the scene
    PilotSeat seat_;
    double height_m_ = 0; ///< over the ground
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
