// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/log.h"
#include "drive/vehicle_spec.h"
#include "feed/udp_socket.h"
#include "render/settings.h"
#include "scene/scene.h"

namespace sward::app {

enum class Command { kHelp, kView, kRender, kWind, kBench, kInfo };

/// Frames of a sequence, both ends included.
struct FrameRange {
    int first = 0;
    int last = 0;
};

/// Where a window stands.
struct WindowPlace {
    int width = 1280, height = 720;
    std::optional<glm::ivec2>
        at; ///< of its upper left corner on the desktop; none: the window manager's choice
};

/// Everything the command line can say, checked as far as that needs no file. Each option is
/// declared once, in options.cpp or an options_*.cpp; the panel of the viewer edits the same
/// `frame`.
struct Options {
    Command command = Command::kHelp;
    base::Verbosity verbosity = base::Verbosity::kNormal;
    std::string help; ///< kHelp: the text for stdout

    std::filesystem::path scene; ///< as given: a scene file, or a directory that holds scene.toml
    std::string camera;          ///< a camera of the scene or a pose; empty: poses.h chooses
    double time_s = 0;
    double step_s = 1.0 / 60.0;    ///< simulated time between two frames
    bool fixed_step = false;       ///< the viewer: time goes by `step_s`, not by the clock
    std::optional<double> density; ///< instead of the scene's
    bool debug_gl = false;         ///< GL debug messages end the program with exit 1
    render::FrameSettings frame;

    // render
    std::filesystem::path output;
    std::filesystem::path stats;
    std::vector<std::string> aovs;
    std::string path; ///< of the scene; empty: the camera stands
    std::optional<FrameRange> frames;
    std::uint32_t frame_index = 0;
    std::optional<scene::Pose> lod_eye;
    std::filesystem::path
        camera_matrices; ///< a file with a camera's matrices; empty: `camera` or `path`
    int warm = 0;
    std::filesystem::path channels; ///< several pictures of every moment; view too. Empty: one
    std::filesystem::path
        replay;       ///< a record that the eye and the weather follow; view too. Empty: none
    bool raw = false; ///< --format rgb24: bytes of the display pictures on stdout
    std::filesystem::path tracks;      ///< what lay at time 0; empty: nothing
    std::filesystem::path save_tracks; ///< what lies at the end; empty: not kept

    // bench
    std::string bench_suite = "all"; ///< or far, near, tracks, wind
    glm::ivec2 bench_size{0, 0};     ///< 0: each suite's own
    bool bench_full = false;
    std::filesystem::path bench_json; ///< empty: none

    // wind
    std::optional<double>
        every_s;         ///< a picture each so many seconds up to time_s; none: one, at time_s
    glm::dvec2 at{0, 0}; ///< world x, z that the window stands around

    // view
    std::optional<feed::Endpoint>
        native_fdm; ///< where net_fdm comes in that moves the eye; none: no port is open
    std::optional<feed::Endpoint> udp_out; ///< whom to tell what lies under it
    std::optional<feed::Endpoint> master;  ///< where followers come to; none: no port is open
    std::optional<feed::Endpoint> follow;  ///< whose flight is drawn
    bool list_joysticks = false;           ///< in the place of a window
    std::filesystem::path record;          ///< written as the flight goes on; empty: none
    std::string drive; ///< a vehicle that ships, or its file; empty: the free camera
    std::string fly;   ///< likewise an aircraft
    std::optional<drive::Surface> tyres; ///< what it stands on all over; none: what lies there
    bool no_wake = false;                ///< what drives and flies moves no air
    std::optional<WindowPlace> window;   ///< none: of `frame`'s size
    int exit_after = 0;                  ///< frames; 0: until it is closed
};

/// Parses a command line. Throws Error: kUsage, kOverLimit for a size past the limit.
[[nodiscard]] Options parse_options(int argc, const char* const* argv);

} // namespace sward::app
