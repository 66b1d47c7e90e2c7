// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/arrow_panel.h"
#include "app/capture.h"
#include "app/channels.h"
#include "app/cockpit_line.h"
#include "app/flight_record.h"
#include "app/frame_times.h"
#include "app/panel.h"
#include "app/pose_source.h"
#include "app/recorder.h"
#include "app/sim_clock.h"
#include "app/weather.h"
#include "app/window.h"
#include "render/settings.h"
#include "sward/view.h"

namespace sward::app {

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

class LeadLink;
class FollowLink;

/// What a flight is made of; all of it outlives the flight.
struct FlightParts {
    const Options& options;
    const scene::Scene& scene;
    const std::vector<Channel>&
        channels; ///< pictures of every moment; none: one that fills the window
    scene::Pose start;
    double latitude_deg = SunDay::kUsualLatitude_deg;
    Window& window;
    Panel& panel;
    Field& field;
    PoseSource& source;
    std::string word;                     ///< shown at first; empty: none
    const FlightRecord* replay = nullptr; ///< what `source` shows, where it is a record
    RecordWriter* record = nullptr;       ///< what the flight is kept in, where it is
    LeadLink* lead = nullptr;             ///< to those that follow it, where some may
    FollowLink* follow = nullptr;         ///< to its master, where it has one
};

/// One scene on the screen: what the keys, the panel and the clock change from frame to frame.
class Flight {
public:
    explicit Flight(const FlightParts& parts);

    /// Draws until the window is closed, or for options.exit_after frames: nothing; or until
    /// another scene is asked for, which can be read. Throws Stopped where a picture that takes
    /// long was ended.
    [[nodiscard]] std::optional<scene::Scene> run();

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] double ground() const;
    [[nodiscard]] scene::Pose above_datum(scene::Pose pose) const;
    void advance(const Input& input, double elapsed_s);
    void measure_speed(const SimClock::Tick& tick);
    void draw(glm::ivec2 size, const Input& input);
    [[nodiscard]] std::vector<Camera> cameras(glm::ivec2 size) const;
    void draw_views(const std::vector<Camera>& cameras, glm::ivec2 size);
    void simulate(const std::vector<Camera>& cameras, const Input& input);
    [[nodiscard]] bool by_steps() const;
    [[nodiscard]] RecordedTime& steps();
    void change(const std::variant<Sun, MeanWind>& what);
    void place(feed::LedFrame& frame);
    [[nodiscard]] std::vector<feed::LedFrame> plan(const Input& input);
    void see_as(const feed::LedFrame& frame);
    [[nodiscard]] bool follow(const Input& input);
    [[nodiscard]] bool leave_to_master(Action action);
    void tell_master();
    [[nodiscard]] std::string note() const;
    void take_breath();
    void present();
    void draw_overlays();
    void act(const Press& press);
    void act_on_view(const Press& press);
    void set_weather(const Weather& wanted);
    void go_to_camera(int number);
    void print_pose() const;
    void take_screenshot();
    void toggle_sequence();
    void add_to_sequence();
    void reload();
    void consider(const std::filesystem::path& scene);
    void say(std::string word);
    [[nodiscard]] std::string line() const;

    FlightParts parts_;
    const Options& options_;
    Window& window_;
    Panel& panel_;
    Field& field_;
    PoseSource& source_;
    SimClock clock_;
    const Land land_{[this](double x, double z) { return field_.ground_height(x, z); },
                     [this](double x, double z) { return field_.wind_at(x, z, clock_.time_s()); }};
    std::vector<View> views_; ///< one a channel, or one
    ArrowPanel arrows_;
    Weather weather_;
    render::FrameSettings settings_;
    render::FrameStats stats_;
    FrameTimes times_;
    ViewPose pose_;
    std::string gpu_;
    std::vector<std::string> cameras_, messages_;
    std::vector<std::filesystem::path> recent_;
    std::optional<PictureSequence> sequence_;
    std::optional<RecordedTime> steps_; ///< of a flight that goes by steps
    StepSampler sampler_;
    std::vector<feed::LedChange> changes_; ///< of the weather, that the next step begins with
    feed::LedFrame placed_;                ///< what the source moves, as the field last heard of it
    bool blew_ = false;
    std::optional<std::uint32_t> seen_; ///< the master's frame that is drawn
    std::optional<scene::Scene> next_;
    std::string word_;
    bool flow_ = false, line_ = true;
    double speed_mps_ = 0, frame_ms_ = 0;
    glm::dvec3 before_{0}; ///< where the eye was in the picture before
    Clock::time_point last_, drawing_, drawn_{}, counted_{}, said_;
};

} // namespace sward::app
