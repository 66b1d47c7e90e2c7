// SPDX-License-Identifier: Apache-2.0
// A flight's pictures: what is drawn from frame to frame, and what lies over it.
#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include "app/flight.h"
#include "app/flow_overlay.h"
#include "app/lead_links.h"
#include "app/load_screen.h"
#include "app/view_scene.h"
#include "gl/breath.h"
#include "render/access.h"

namespace sward::app {
namespace {

constexpr int kMostWindSteps =
    4; // of the local window in a frame: a slow GPU slows the wind, not the flight
constexpr int kMostPhysicsSteps = 4;   // likewise of the blades
constexpr double kStatsEvery_s = 0.25; // reading counters waits for the GPU
constexpr int kLargestSide = 16384;
constexpr double kLong_s = 0.3; // a picture that takes longer is worth a word, and may be ended
constexpr GLuint64 kWait_ns = 30'000'000;
constexpr double kWord_s = 4;

} // namespace

/// What each view sees, in their order.
std::vector<Camera> Flight::cameras(glm::ivec2 size) const {
    const Camera middle = camera_of(pose_, size.x, size.y);
    if (parts_.channels.empty())
        return {middle};
    std::vector<Camera> cameras;
    for (const Channel& channel : parts_.channels)
        cameras.push_back(channel_camera(middle, channel));
    return cameras;
}

void Flight::draw_views(const std::vector<Camera>& cameras, glm::ivec2 size) {
    if (!parts_.channels.empty()) { // what lies between them
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    for (std::size_t i = 0; i < views_.size(); ++i) {
        const Channel whole{.name = {},
                            .size = {settings_.width, settings_.height},
                            .at = {0, 0},
                            .turn = {},
                            .rim = {}};
        const Channel& channel = parts_.channels.empty() ? whole : parts_.channels[i];
        render::Access::settings(views_[i]) = settings_;
        // A window larger than any picture keeps a rim.
        views_[i].draw(cameras[i], {channel.size.x, channel.size.y, 0, channel.at.x,
                                    std::max(0, size.y - channel.at.y - channel.size.y)});
    }
}

void Flight::draw(glm::ivec2 size, const Input& input) {
    settings_.width = std::min(size.x, kLargestSide);
    settings_.height = std::min(size.y, kLargestSide);
    settings_.most_wind_steps = options_.fixed_step ? 0 : kMostWindSteps;
    settings_.most_physics_steps = options_.fixed_step ? 0 : kMostPhysicsSteps;
    const std::vector<Camera> seen = cameras({settings_.width, settings_.height});
    drawing_ = Clock::now();
    {
        const gl::BreathScope breath([this] { take_breath(); });
        simulate(seen, input);
        draw_views(seen, size);
    }
    window_.set_title("Sward - " + scene_title(parts_.scene));
    if (seconds_since(counted_) > kStatsEvery_s) {
        stats_ = render::Access::state(views_.front()).stats();
        counted_ = Clock::now();
    }
}

/// Between the passes of a picture: the window is heard, and if the picture takes long it says so
/// and may be ended.
void Flight::take_breath() {
    window_.listen();
    if (parts_.follow != nullptr)
        parts_.follow->exchange(0);
    if (seconds_since(drawing_) < kLong_s)
        return;
    // The passes so far, waited for in pieces: else the last one would wait for all of them, deaf.
    const GLsync fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    while (glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kWait_ns) == GL_TIMEOUT_EXPIRED) {
        window_.listen();
        if (window_.asked_to_end())
            break;
    }
    glDeleteSync(fence);
    if (window_.asked_to_end())
        throw Stopped{};
    window_.set_title(
        fmt::format("Sward - drawing for {:.0f} s, Esc ends", std::ceil(seconds_since(drawing_))));
}

void Flight::present() {
    Weather wanted = weather_;
    PanelEdits edits{settings_, clock_, wanted};
    panel_.begin();
    draw_overlays();
    panel_.draw(edits, {stats_, pose_.pose, ground(), note(), frame_ms_, gpu_, cameras_});
    if (line_)
        Panel::draw_line(line());
    panel_.draw_help();
    const auto chosen = panel_.draw_recent(recent_);
    Panel::draw_messages(messages_);
    if (seconds_since(said_) < kWord_s)
        Panel::draw_word(word_);
    panel_.end();
    window_.swap();
    if (parts_.follow != nullptr)
        return;
    set_weather(wanted);
    if (edits.camera)
        go_to_camera(*edits.camera);
    if (chosen)
        consider(*chosen);
}

void Flight::draw_overlays() {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    if (!parts_.channels.empty())
        return; // they know the window as one picture
    const Eye eye(pose_.pose, {size.x, size.y});
    if (flow_)
        draw_flow(eye, land_, clock_.time_s());
    if (arrows_.draw(eye, land_, clock_.time_s()))
        render::Access::state(field_).sources().set_arrows(arrows_.arrows());
}

} // namespace sward::app
