// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "scene/scene_sections.h"
#include "shared/track.h"

namespace sward::scene {
namespace {

constexpr std::size_t kMostFeet = 4096;

TrackFoot read_foot(TableReader& table, const std::map<std::string, Path>& paths) {
    TrackFoot foot;
    std::vector<double> n;
    int shapes = 0;
    if (table.numbers("box", n, {kPlace, kPlace, kLength, kLength})) {
        foot.kind = TrackFoot::Kind::kBox, ++shapes;
        foot.place = {n[0], n[1]};
        foot.size = {n[2], n[3]};
    }
    if (table.numbers("wheel", n, {kPlace, kPlace, {0.01, 10, "m"}, {0.01, 10, "m"}})) {
        foot.kind = TrackFoot::Kind::kWheel, ++shapes;
        foot.place = {n[0], n[1]};
        foot.size = {n[2], n[3]};
    }
    table.name("path", foot.path);
    table.number("height_m", foot.height_m, {-10, 1000, "m"});
    table.number("load", foot.load, kShare);
    table.finish();
    table.require("path");
    if (shapes != 1)
        throw table.error("", fmt::format("{} shapes", shapes), "one of box, wheel");
    check_path(table, foot.path, paths);
    return foot;
}

void read_track_mask(TableReader& table, TrackSpec& tracks) {
    table.path("mask", tracks.mask);
    table.path("mask_way", tracks.mask_way);
    const bool way = table.number("mask_way_deg", tracks.mask_way_deg, {-360, 360, "degrees"});
    const bool place = table.place("mask_place", tracks.mask_place);
    std::vector<double> size;
    if (table.numbers("mask_size_m", size, {{0.1, 1e6, "m"}, {0.1, 1e6, "m"}}))
        tracks.mask_size_m = {size[0], size[1]};
    if (place && size.empty())
        throw table.error("mask_size_m", "nothing",
                          "the mask's width and depth (m), beside mask_place");
    if (!size.empty() && !place)
        throw table.error("mask_place", "nothing", "the mask's middle, beside mask_size_m");
    if (way && !tracks.mask_way.empty())
        throw table.error("mask_way_deg", "mask_way beside it", "one of the two");
    if (tracks.mask.empty() && (way || place || !tracks.mask_way.empty()))
        throw table.error("mask", "nothing", "a picture of what lies, for its way and place");
}

} // namespace

void read_tracks(TableReader table, const std::map<std::string, Path>& paths, TrackSpec& tracks) {
    table.number("cell_m", tracks.cell_m, {0.05, 4, "m"});
    table.integer("pages", tracks.pages, 1, 1024);
    table.number("wave_mps", tracks.wave_mps, {1, 10, "m/s"});
    table.number("rate_wave_mps", tracks.rate_wave_mps, {1, 10, "m/s"});
    table.number("wave_gain_m", tracks.wave_gain_m, {0, 1.5, "m"});
    table.number("damping", tracks.damping, {0.01, 1, ""});
    table.number("recovery_per_s2", tracks.recovery_per_s2, {0, 1000, "1/s2"});
    table.number("broken", tracks.broken, kShare);
    table.number("lasting_s", tracks.lasting_s, {1, 1e9, "s"});
    table.number("memory_mb", tracks.memory_mb, {0, 4096, "MB"});
    read_track_mask(table, tracks);
    std::vector<TableReader> feet = table.tables("foot", kMostFeet);
    table.finish();
    // C2 is stable up to here; waves that mu would make faster are held there.
    const double most = static_cast<double>(
        shared::track_greatest_wave(static_cast<float>(tracks.cell_m), shared::kTrackStep_s,
                                    static_cast<float>(tracks.recovery_per_s2)));
    for (const auto& [key, value] :
         {std::pair{"wave_mps", tracks.wave_mps}, std::pair{"rate_wave_mps", tracks.rate_wave_mps}})
        if (value > most)
            throw table.error(
                key, fmt::format("{}", value),
                fmt::format("at most {:.3f} m/s with tracks.cell_m = {} and recovery_per_s2 = {}",
                            most, tracks.cell_m, tracks.recovery_per_s2));
    for (TableReader& foot : feet)
        tracks.feet.push_back(read_foot(foot, paths));
}

} // namespace sward::scene
