// SPDX-License-Identifier: Apache-2.0
// Tracks under living blades (J6): one that wakes where stems lie begins pressed, and stays so.
#include <cmath>

#include "blades/simulation.h"
#include "gl/fixture.h"
#include "shared/tile_lie.h"
#include "shared/track_seen.h"
#include "tracks/track_mask.h"
#include "tracks/tracks.h"

namespace sward::tests {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr double kGround_m = 100;
constexpr float kLying = 0.9f;
const glm::dvec3 kEye(70.3, kGround_m + 1.6, -121.7);

class TracksLiving : public GlTest {
protected:
    TracksLiving() : world_(flat_field(kGround_m), 0, even_mask(1), kEye) {}
    SmallWorld world_;
};

TEST_F(TracksLiving, ABladeThatWakesOnATrackBeginsPressedAndStaysSo) {
    scene::Scene scene;
    scene::TrackSpec& spec = scene.tracks.emplace();
    spec.mask_place = {73, -121}; // the ground east of x = 71
    spec.mask_size_m = {4, 12};
    spec.mask_way_deg = 90;
    scene::DensityMask lying;
    lying.width = lying.height = 1;
    lying.density = {kLying};
    tracks::Tracks tracks(scene, static_cast<double>(world_.set.canopy_m),
                          {[](double, double) { return kGround_m; }, nullptr});
    tracks.begin_with(tracks::painted(spec, {lying, {}, {100, 100}, "m.png"}), "m.png");
    tracks.advance(0, {&kEye, 1});
    tracks.bind();
    world_.frame.tracks = tracks.field({world_.anchor.x, world_.anchor.z});
    world_.upload();

    scene::WindSpec calm;
    calm.speed_mps = 0;
    calm.gust = 0;
    wind::Wind wind(calm, 0.1);
    const std::map<std::filesystem::path, scene::SphereSet> none{};
    const blades::Colliders nothing(scene::Scene{}, none, [](double, double) { return kGround_m; });
    const float response = world_.frame.wind.response;
    blades::Simulation simulation(world_.set, response,
                                  {{3, 64ull << 20}, blades::Simulation::kStep_s});
    const blades::Simulation::Inputs inputs{wind, world_.surface, nothing, kEye, world_.anchor, 0,
                                            0,    nullptr};
    const shared::BladeStep rules = shared::plain_blade_step(
        static_cast<float>(blades::Simulation::kStep_s), world_.set.canopy_m, response);
    const vec2 push = shared::sway_wind({0, 0}, response, {0, 0}, {kLying, 0});
    for (const double time_s : {0.0, 1.5}) {
        simulation.advance(time_s, inputs);
        const auto& pages = simulation.pages();
        const auto stride = static_cast<std::size_t>(pages.order().patches_a_page) * CULL_GROUP;
        const auto states =
            simulation.pass().states().read_all<vec4>(pages.slots().size() * stride);
        int pressed = 0, upright = 0;
        double worst = 0, east = 0;
        for (std::size_t slot = 0; slot < pages.slots().size(); ++slot) {
            const auto& page = pages.slots()[slot];
            if (!page.used) {
                continue;
            }
            const std::size_t first =
                world_.set.variant_begin[static_cast<std::size_t>(page.variant)];
            const std::size_t end =
                world_.set.variant_begin[static_cast<std::size_t>(page.variant) + 1];
            for (std::size_t n = first; n < end; ++n) {
                const auto blade = shared::lay_blade(shared::tile_lie(page.tile),
                                                     world_.set.blades[pages.order().blades[n]],
                                                     world_.set.side_m);
                const double x = page.tile.x * static_cast<double>(world_.set.side_m) +
                                 static_cast<double>(blade.root.x);
                const double z = page.tile.y * static_cast<double>(world_.set.side_m) +
                                 static_cast<double>(blade.root.y);
                const bool on = x > 71.3 && x < 74.5 && std::abs(z + 121) < 5, off = x < 70.7;
                if (!on && !off) {
                    continue;
                }
                const auto body = shared::set_blade_body(rules, blade, vec3(0));
                const vec4 begun = shared::grouped_state(body, on ? push : vec2(0), response);
                worst = std::max<double>(
                    worst, glm::distance(vec3(begun), vec3(states[slot * stride + n - first])) /
                               blade.shape.y);
                (on ? pressed : upright) += 1;
                east +=
                    on ? static_cast<double>(states[slot * stride + n - first].x / blade.shape.y)
                       : 0.0;
            }
        }
        EXPECT_GT(pressed, 100);
        EXPECT_GT(upright, 100);
        EXPECT_GT(east / pressed, 0.25); // of their length, as the stems lie
        std::printf("at %.1f s: %d blades on the track, %d beside it; tips %.2f of a blade east; "
                    "farthest from the track's own pose %.4f of a blade\n",
                    time_s, pressed, upright, east / pressed, worst);
        if (time_s == 0) { // later each moves by its own stiffness, as it does in a wind
            EXPECT_LT(worst, 1e-3);
        }
    }
}

} // namespace
} // namespace sward::tests
