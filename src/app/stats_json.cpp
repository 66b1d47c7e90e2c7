// SPDX-License-Identifier: Apache-2.0
#include "app/stats_json.h"

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace sward::app {
namespace {

using Json = nlohmann::ordered_json;

std::string to_text(const Json& json) {
    // A driver's name is not ours: what is not UTF-8 in it must not end the program.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

std::uint64_t process_peak_bytes() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux counts KiB
}

std::string stats_json(const render::FrameStats& stats, const std::string& gpu,
                       const render::FrameSettings& settings) {
    Json passes = Json::array();
    for (const render::PassTime& pass : stats.passes)
        passes.push_back({{"name", pass.name}, {"gpu_ms", pass.gpu_ms}, {"cpu_ms", pass.cpu_ms}});
    Json json;
    json["gpu"] = gpu;
    json["size"] = {settings.width, settings.height};
    json["passes"] = std::move(passes);
    json["blades"] = {{"considered", stats.blades_considered},
                      {"drawn", stats.blades_drawn},
                      {"culled",
                       {{"frustum", stats.culled_by_frustum},
                        {"orientation", stats.culled_by_orientation},
                        {"distance", stats.culled_by_distance},
                        {"occlusion", stats.culled_by_occlusion},
                        {"samples", stats.culled_by_samples}}}};
    json["physics"] = {{"blades", stats.blades_simulated},
                       {"steps", stats.physics_steps},
                       {"patches_stepped", stats.patches_stepped},
                       {"bytes", stats.physics_bytes}};
    if (stats.track_bytes > 0)
        json["tracks"] = {{"pages", stats.track_pages},
                          {"bytes", stats.track_bytes},
                          {"memory_bytes", stats.track_memory_bytes}};
    json["fragments"] = {{"shells", stats.shell_fragments}, {"slices", stats.slice_fragments}};
    if (settings.count_steps)
        json["march"] = {{"steps", stats.march_steps}, {"reads", stats.march_reads}};
    json["bytes"] = {{"gpu", stats.gpu_bytes}, {"process_peak", process_peak_bytes()}};
    return to_text(json);
}

std::string sequence_json(const std::vector<std::string>& frames, int first) {
    Json list = Json::array();
    for (const std::string& text : frames) {
        Json frame = {{"frame", first + static_cast<int>(list.size())}};
        frame.update(Json::parse(text));
        list.push_back(std::move(frame));
    }
    return to_text({{"frames", std::move(list)}});
}

} // namespace sward::app
