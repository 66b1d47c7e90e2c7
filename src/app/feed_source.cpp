// SPDX-License-Identifier: Apache-2.0
#include "app/feed_source.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "app/controls.h"
#include "base/error.h"
#include "base/log.h"
#include "feed/ground_report.h"
#include "feed/pose_track.h"

namespace sward::app {
namespace {

constexpr double kLongPicture_s =
    1; // in which the socket may have run over: what it holds then is old, and says nothing of now

double clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

class FeedSource : public PoseSource {
public:
    FeedSource(std::shared_ptr<feed::UdpReceiver> in, const scene::PlaceOnEarth& on_earth)
        : in_(std::move(in)), track_(on_earth) {}

    void advance(ViewPose& pose, const PoseMoment& moment) override {
        const double now = clock_s();
        in_->receive([&](const feed::Datagram& datagram) {
            const feed::Packet packet =
                track_.take(datagram.bytes, datagram.sender, now - datagram.age_s);
            if (packet != feed::Packet::kTaken && packet != feed::Packet::kDoubled)
                last_refused_ = packet;
        });
        const bool asleep = now - now_ > kLongPicture_s;
        now_ = now;
        if (!asleep)
            tell();
        const std::optional<feed::FeedPose> at = track_.pose(now);
        if (!at)
            return;
        pose.pose.position = at->position;
        pose.pose.yaw_deg = at->yaw_deg;
        pose.pose.pitch_deg = at->pitch_deg;
        pose.roll_deg = at->roll_deg;
        // A flight model on flat ground does not know the hill.
        keep_above_ground(pose.pose, moment.land.height(at->position.x, at->position.z));
    }

    [[nodiscard]] bool in_real_time() const override { return true; }
    [[nodiscard]] std::string note() const override {
        std::string text;
        switch (track_.stream(now_)) {
        case feed::Stream::kWaiting:
            text = fmt::format("feed: nothing yet at {}", in_->address());
            break;
        case feed::Stream::kLive:
            text = fmt::format("feed {:.3g} m/s", glm::length(track_.pose(now_)->velocity_mps));
            break;
        case feed::Stream::kPaused:
            text = fmt::format("feed stands since {:.0f} s: it says the same", track_.age_s(now_));
            break;
        case feed::Stream::kSilent:
            text = fmt::format("feed stands since {:.0f} s: it is silent", track_.age_s(now_));
            break;
        }
        if (const std::uint64_t count = refused(); count > 0)
            text += fmt::format(", {} refused (the last {})", count, feed::name_of(last_refused_));
        return text;
    }

    [[nodiscard]] const feed::PoseTrack& track() const { return track_; }
    [[nodiscard]] bool stands() const { return track_.stream(now_) != feed::Stream::kLive; }

private:
    [[nodiscard]] std::uint64_t refused() const {
        std::uint64_t sum = 0;
        for (const std::uint64_t count : track_.counts())
            sum += count;
        return sum - track_.count(feed::Packet::kTaken) - track_.count(feed::Packet::kDoubled);
    }

    /// On stderr when the stream begins, stands and goes on.
    void tell() {
        const feed::Stream stream = track_.stream(now_);
        if (stream == told_)
            return;
        told_ = stream;
        if (stream == feed::Stream::kLive)
            base::log_info("native-fdm: packets come in");
        else
            base::log_warning("native-fdm: the stream stands: " +
                              std::string(stream == feed::Stream::kPaused
                                              ? "every packet says the same"
                                              : "no packet for half a second"));
    }

    std::shared_ptr<feed::UdpReceiver> in_;
    feed::PoseTrack track_;
    feed::Packet last_refused_ = feed::Packet::kTaken;
    feed::Stream told_ = feed::Stream::kWaiting;
    double now_ = clock_s();
};

class Reporting : public PoseSource {
public:
    Reporting(std::unique_ptr<PoseSource> source, std::shared_ptr<feed::UdpSender> out,
              CoverAt cover)
        : source_(std::move(source)), feed_(dynamic_cast<const FeedSource*>(source_.get())),
          out_(std::move(out)), cover_(std::move(cover)) {}

    void advance(ViewPose& pose, const PoseMoment& moment) override {
        source_->advance(pose, moment);
        feed::GroundReport report;
        report.count = count_++;
        report.time_s = moment.time_s;
        report.place = {pose.pose.position.x, pose.pose.position.z};
        // What answers a packet is true of the place in that packet, not of where the picture has
        // gone on to.
        if (const feed::FdmSample* sample = feed_ ? feed_->track().sample() : nullptr) {
            const glm::dvec3 said = feed_->track().said()->position;
            report.fed = true;
            report.latitude_deg = sample->latitude_deg;
            report.longitude_deg = sample->longitude_deg;
            report.fdm_time = sample->time;
            report.place = {said.x, said.z};
        }
        report.stands = feed_ && feed_->stands();
        describe(report, moment.land);
        out_->send(feed::encode_report(report)); // a lost one is followed by the next
    }
    [[nodiscard]] bool in_real_time() const override { return source_->in_real_time(); }
    [[nodiscard]] std::vector<Ball> bodies() const override { return source_->bodies(); }
    [[nodiscard]] std::vector<Blower> blowers() const override { return source_->blowers(); }
    void add_objects(render::World& world) override { source_->add_objects(world); }
    [[nodiscard]] std::vector<Body> objects() const override { return source_->objects(); }
    [[nodiscard]] std::optional<double> speed_mps() const override { return source_->speed_mps(); }
    [[nodiscard]] std::string note() const override { return source_->note(); }

private:
    void describe(feed::GroundReport& report, const Land& land) const {
        report.ground_m = land.height(report.place.x, report.place.y);
        report.normal = normal_at(land, report.place);
        report.surface = feed::class_of(cover_(report.place, glm::vec3(report.normal)));
        const glm::dvec2 wind = land.wind(report.place.x, report.place.y);
        report.wind_mps = {wind.x, 0, wind.y};
    }

    std::unique_ptr<PoseSource> source_;
    const FeedSource* feed_; ///< null: the eye flies by other means
    std::shared_ptr<feed::UdpSender> out_;
    CoverAt cover_;
    std::uint32_t count_ = 0;
};

} // namespace

FeedLinks open_feed(const Options& options) {
    FeedLinks links;
    if (options.native_fdm) {
        links.in = std::make_shared<feed::UdpReceiver>(*options.native_fdm, "--native-fdm");
        base::log_info("native-fdm: listening on udp:" + links.in->address());
    }
    if (options.udp_out)
        links.out = std::make_shared<feed::UdpSender>(*options.udp_out, "--udp-out");
    return links;
}

std::unique_ptr<PoseSource> make_feed_source(std::shared_ptr<feed::UdpReceiver> in,
                                             const scene::PlaceOnEarth& on_earth) {
    if (!on_earth)
        throw base::Error(base::ExitCode::kUsage,
                          "--native-fdm: found a terrain without a place on Earth, expected "
                          "elevation with a CRS, or .hgt");
    return std::make_unique<FeedSource>(std::move(in), on_earth);
}

std::unique_ptr<PoseSource> with_report(std::unique_ptr<PoseSource> source,
                                        std::shared_ptr<feed::UdpSender> out, CoverAt cover) {
    return std::make_unique<Reporting>(std::move(source), std::move(out), std::move(cover));
}

} // namespace sward::app
