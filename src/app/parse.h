// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/options.h"
#include "base/error.h"

namespace sward::app {

/// "<option>: found <text>, expected <expected>" as an Error.
[[nodiscard]] base::Error option_error(std::string_view option, std::string_view found,
                                       std::string_view expected,
                                       base::ExitCode code = base::ExitCode::kUsage);

/// Closed range of a number, and what it counts ("seconds").
struct NumberRange {
    double least;
    double most;
    std::string_view unit;
};

// Values of options. All read the C locale's form whatever the environment says, take the whole
// text, and throw Error(kUsage) that names the option.
[[nodiscard]] double parse_number(std::string_view option, std::string_view text,
                                  NumberRange range);
[[nodiscard]] long long parse_integer(std::string_view option, std::string_view text,
                                      NumberRange range);
/// "1280x720". Throws Error(kOverLimit) above 16384 a side.
[[nodiscard]] std::pair<int, int> parse_size(std::string_view option, std::string_view text);
/// "1280x720", or with the place of its corner "1280x720+100+50" ("+-1920+0": left of the first
/// screen). Throws Error(kOverLimit) as parse_size.
[[nodiscard]] WindowPlace parse_window(std::string_view option, std::string_view text);
/// Seconds from one frame to the next: a number, or a fraction such as 1/144.
[[nodiscard]] double parse_step(std::string_view option, std::string_view text, NumberRange range);
/// "A:B", A <= B.
[[nodiscard]] FrameRange parse_frames(std::string_view option, std::string_view text);
/// "color,depth": names the renderer knows, each once.
[[nodiscard]] std::vector<std::string> parse_aovs(std::string_view option, std::string_view text);
/// "none", or tests of J7, each once: "frustum,occlusion".
[[nodiscard]] blades::CullTests parse_cull(std::string_view option, std::string_view text);
/// "x,z", metres.
[[nodiscard]] glm::dvec2 parse_place(std::string_view option, std::string_view text);
/// "x,y,z" or a whole pose.
[[nodiscard]] scene::Pose parse_eye(const std::string& option, const std::string& text);

/// "udp:PORT" or "udp:HOST:PORT".
[[nodiscard]] feed::Endpoint parse_endpoint(std::string_view option, std::string_view text,
                                            std::string_view expected);

/// The value that `text` names in a table of choices.
template<class T, std::size_t N>
[[nodiscard]] T parse_choice(std::string_view option, std::string_view text,
                             const std::array<std::pair<std::string_view, T>, N>& choices) {
    std::string known;
    for (const auto& [name, value] : choices) {
        if (name == text)
            return value;
        known += (known.empty() ? "" : "|") + std::string(name);
    }
    throw option_error(option, text, known);
}

} // namespace sward::app
