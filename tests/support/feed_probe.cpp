// SPDX-License-Identifier: Apache-2.0
// What the feed makes of packets, as text: feed_probe ELEVATION [POLLS_A_SECOND]. Prints "port N",
// then for each packet that it takes "said TIME x y z yaw pitch roll" (TIME: the sender's), "ahead
// ..." the same carried on by a tenth of a second, and at each poll after the first of them "drawn
// CLOCK x y z yaw pitch roll" (CLOCK: the monotonic one, s). Ends a second after the last packet
// with "counts TAKEN REFUSED".
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "assets/assets.h"
#include "assets/place_finder.h"
#include "base/error.h"
#include "feed/pose_track.h"
#include "feed/udp_socket.h"

namespace {

using sward::feed::FeedPose;

double clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

void print(const char* what, double when, const FeedPose& p) {
    std::printf("%s %.6f %.6f %.6f %.6f %.6f %.6f %.6f\n", what, when, p.position.x, p.position.y,
                p.position.z, p.yaw_deg, p.pitch_deg, p.roll_deg);
}

void run(const std::string& elevation, double polls) {
    sward::scene::TerrainSpec spec;
    spec.elevation = elevation;
    sward::feed::PoseTrack track(
        sward::assets::place_finder(sward::assets::load_elevation(spec).origin.value()));
    sward::feed::UdpReceiver receiver({}, "feed_probe");
    std::printf("port %d\n", receiver.port());
    std::fflush(stdout);
    const double begun = clock_s();
    while (track.sample() ? track.age_s(clock_s()) < 1 : clock_s() - begun < 60) {
        const double now = clock_s();
        receiver.receive([&](const sward::feed::Datagram& datagram) {
            const double arrival = now - datagram.age_s;
            if (track.take(datagram.bytes, datagram.sender, arrival) != sward::feed::Packet::kTaken)
                return;
            print("said", track.sample()->time, *track.said());
            print("ahead", track.sample()->time,
                  *track.pose(arrival + sward::feed::kExtrapolated_s));
        });
        if (polls > 0 && track.sample())
            print("drawn", now, *track.pose(now));
        std::this_thread::sleep_for(std::chrono::duration<double>(polls > 0 ? 1 / polls : 0.001));
    }
    std::uint64_t refused = 0;
    for (const std::uint64_t count : track.counts())
        refused += count;
    const std::uint64_t taken = track.count(sward::feed::Packet::kTaken);
    std::printf("counts %llu %llu\n", static_cast<unsigned long long>(taken),
                static_cast<unsigned long long>(refused - taken));
}

} // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 2)
            throw sward::base::Error(sward::base::ExitCode::kUsage,
                                     "feed_probe: found no elevation, expected a file");
        run(argv[1], argc > 2 ? std::atof(argv[2]) : 0);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
}
