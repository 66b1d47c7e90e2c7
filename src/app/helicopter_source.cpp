// SPDX-License-Identifier: Apache-2.0
#include "app/helicopter_source.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include "app/controls.h"
#include "app/model_files.h"
#include "app/pilot_seat.h"
#include "fly/helicopter.h"
#include "fly/helicopter_mesh.h"
#include "render/world.h"

namespace sward::app {
namespace {

constexpr double kNearGround_m = 4;    // a pose lower than this begins on its skids
constexpr double kBallRadius_m = 0.15; // along a skid, as the grass feels it
constexpr double kTailGear = 6;        // turns of the tail rotor in one of the main rotor
constexpr double kBlowsBelow_m = 50, kBlowsStill_m = 60; // higher, no blade feels it
constexpr double kAround = 3;        // radii from where the downwash lands: past its ring
constexpr double kLeastThrust = 0.1; // of the weight

PilotSeat::Feel feel_of(const fly::HelicopterSpec& spec) {
    return {.lever_step = 0.02,
            .key_follow_per_s = 6,
            .chase = {.back_m = 1.5 * spec.length_m,
                      .up_m = 0.35 * spec.length_m,
                      .per_s = 2.5,
                      .pitch_deg = -10}};
}

class HelicopterSource : public PoseSource {
public:
    explicit HelicopterSource(const fly::HelicopterSpec& spec)
        : spec_(spec), seat_(feel_of(spec)) {}

    void advance(ViewPose& pose, const PoseMoment& moment) override {
        if (!model_) // the land is the same for all of a flight
            model_.emplace(spec_, fly::FlyLand{moment.land.height,
                                               [this, wind = moment.land.wind](double x, double z) {
                                                   return wind_above_wash(wind, {x, z});
                                               }});
        if (!told_ || *told_ != pose.pose.position) // a camera's key, or the beginning
            begin(pose.pose, moment.land.height(pose.pose.position.x, pose.pose.position.z));
        seat_.take(moment);
        for (const Press& press : moment.input.presses)
            engine_ ^= press.action == Action::kEngine;
        const glm::dvec3 stick = seat_.stick(moment.input);
        model_->advance(moment.dt_s,
                        {stick.x, stick.y, stick.z, seat_.lever(moment.input), engine_});
        note_height(moment.land);
        const fly::HelicopterState state = model_->state();
        seat_.place_eye(pose, moment, {state.position, state.turn, spec_.eye_m});
        told_ = pose.pose.position;
    }

    [[nodiscard]] std::optional<double> speed_mps() const override {
        return model_ ? std::optional(glm::length(model_->state().velocity_mps)) : std::nullopt;
    }
    [[nodiscard]] std::string note() const override {
        if (!model_)
            return spec_.name;
        const fly::HelicopterState state = model_->state();
        return fmt::format("{} {:.0f} kt, climb {:+.1f} m/s, lever {:.0f} %, rotor {:.0f} %{}",
                           spec_.name, state.airspeed_mps * 3600 / 1852, state.velocity_mps.y,
                           seat_.lever() * 100, state.rotor_share * 100,
                           state.crashed ? ", crashed"
                           : engine_     ? ""
                                         : ", ENGINE OFF");
    }

    /// Its skids.
    [[nodiscard]] std::vector<Ball> bodies() const override {
        if (!model_)
            return {};
        const fly::HelicopterState state = model_->state();
        std::vector<Ball> balls;
        for (const double x : {-0.5, 0.5})
            for (const double z : {-0.5, 0.0, 0.5})
                balls.push_back(
                    {state.position + state.turn * glm::dvec3(x * spec_.skid_track_m,
                                                              kBallRadius_m - spec_.skid_m,
                                                              z * spec_.skid_length_m),
                     kBallRadius_m});
        return balls;
    }

    /// The downwash, where it comes to the ground: behind the hub, and weaker, as speed blows it
    /// back.
    [[nodiscard]] std::vector<Blower> blowers() const override {
        if (!model_ || !blows_)
            return {};
        const fly::HelicopterState state = model_->state();
        const glm::dvec2 over(state.velocity_mps.x, state.velocity_mps.z);
        const double down = std::max(0.1, state.inflow_mps), speed = glm::length(over);
        Blower blower;
        blower.kind = Blower::Kind::kRotor;
        blower.velocity = over;
        blower.place = glm::dvec2(state.position.x, state.position.z) - wash_m_;
        blower.speed_mps = 2 * down * down / std::hypot(down, speed);
        blower.radius_m = spec_.rotor.radius_m;
        blower.height_m = height_m_;
        return {blower};
    }

    void add_objects(render::World& world) override {
        first_ = world.scene.objects.size();
        add_model_mesh(world, "aircraft/body", fly::helicopter_mesh(spec_), {0.36, 0.06, 0.05});
        add_model_mesh(world, "aircraft/rotor", fly::rotor_mesh(spec_), {0.05, 0.05, 0.055});
        add_model_mesh(world, "aircraft/tail rotor", fly::tail_rotor_mesh(spec_),
                       {0.05, 0.05, 0.055});
    }

    [[nodiscard]] std::vector<Body> objects() const override {
        if (!model_)
            return {};
        const fly::HelicopterState state = model_->state();
        const glm::dmat4 one(1);
        const glm::dmat4 whole = glm::translate(one, state.position) * glm::mat4_cast(state.turn);
        const glm::dquat disc = glm::angleAxis(state.tilt_back, glm::dvec3(1, 0, 0)) *
                                glm::angleAxis(-state.tilt_right, glm::dvec3(0, 0, 1)) *
                                glm::angleAxis(state.rotor_rad, glm::dvec3(0, 1, 0));
        const glm::dquat tail = glm::angleAxis(kTailGear * state.rotor_rad, glm::dvec3(1, 0, 0));
        return {
            {first_, whole},
            {first_ + 1,
             whole * glm::translate(one, glm::dvec3(0, spec_.hub_m, 0)) * glm::mat4_cast(disc)},
            {first_ + 2, whole * glm::translate(one, fly::tail_hub(spec_)) * glm::mat4_cast(tail)}};
    }

private:
    /// The wind is the ground's, where its own downwash flows out to all sides, below it: what is
    /// the same on four sides of that is the wind that it flies in.
    [[nodiscard]] glm::dvec2 wind_above_wash(const std::function<glm::dvec2(double, double)>& wind,
                                             glm::dvec2 at) const {
        if (!blows_)
            return wind(at.x, at.y);
        glm::dvec2 sum(0);
        const double away = kAround * spec_.rotor.radius_m;
        for (const glm::dvec2& side : {glm::dvec2(away, 0), glm::dvec2(-away, 0),
                                       glm::dvec2(0, away), glm::dvec2(0, -away)}) {
            const glm::dvec2 there = at - wash_m_ + side;
            sum += wind(there.x, there.y);
        }
        return sum / 4.0;
    }

    void begin(const scene::Pose& pose, double ground) {
        double lever = 0;
        engine_ = true;
        if (pose.position.y - ground > kNearGround_m) {
            model_->put_in_air(pose.position, pose.yaw_deg);
            lever = model_->hover_lever();
        } else {
            model_->put_on_ground(pose.position.x, pose.position.z, pose.yaw_deg);
        }
        seat_.begin(pose.yaw_deg, lever);
    }

    void note_height(const Land& land) {
        const fly::HelicopterState state = model_->state();
        height_m_ = std::max(0.0, state.position.y + spec_.hub_m -
                                      land.height(state.position.x, state.position.z));
        wash_m_ = glm::dvec2(state.velocity_mps.x, state.velocity_mps.z) *
                  (height_m_ / (2 * std::max(0.5, state.inflow_mps)));
        blows_ = height_m_ < (blows_ ? kBlowsStill_m : kBlowsBelow_m) &&
                 state.thrust_n > kLeastThrust * spec_.mass_kg * 9.81;
    }

    fly::HelicopterSpec spec_;
    std::optional<fly::Helicopter> model_;
    std::optional<glm::dvec3> told_; ///< where the eye was put last
    std::size_t first_ = 0;          ///< of its objects in the scene
    PilotSeat seat_;
    double height_m_ = 0;  ///< of the hub over the ground
    glm::dvec2 wash_m_{0}; ///< how far behind the hub the downwash comes to the ground
    bool engine_ = true, blows_ = false;
};

} // namespace

std::unique_ptr<PoseSource> make_helicopter_source(const fly::HelicopterSpec& spec) {
    return std::make_unique<HelicopterSource>(spec);
}

} // namespace sward::app
