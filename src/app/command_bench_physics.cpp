// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <span>

#include "app/bench.h"
#include "app/world_loader.h"
#include "blades/surface_simulation.h"
#include "gl/pass.h"
#include "wind/wind.h"

namespace sward::app {
namespace {

constexpr int kRounds =
    9; // of each, after one step that begins and one that builds what is built late
constexpr double kLeastGain =
    0.62; // of one program for all: what the program without the branches costs
constexpr std::size_t kPool = 192u << 20;

/// The living blades of a scene on a mesh, without its picture.
class Field {
public:
    explicit Field(const render::World& world)
        : grass_(blades::place_surface_grass(world.surface, world.scene.surface_grass,
                                             world.scene.terrain.surface)),
          records_(gl::Buffer::of(std::span<const shared::SurfaceBlade>(grass_.blades))),
          wind_(world.scene.wind, 0), surface_({2, 2, {1000, 1000}, {0, 0, 0, 0}, {}}, 0),
          colliders_(world.scene, world.spheres, [](double, double) { return 0.0; }),
          canopy_m_(world.scene.surface_grass.species.length_m.high) {}

    [[nodiscard]] blades::SurfaceSimulation simulation(blades::StepPrograms programs) const {
        return {{{&records_, grass_.clusters}},
                canopy_m_,
                {{1e6, kPool}, blades::LivingBlades::kStep_s, programs}};
    }
    /// Milliseconds of a step's physics.
    double step(blades::SurfaceSimulation& simulation, double time_s) {
        timers_.begin_frame(true);
        simulation.advance(
            time_s, {wind_, surface_, colliders_, glm::dvec3(0), glm::dvec3(0), 0, 0, &timers_});
        double ms = 0;
        for (const gl::PassTimers::Row& row : timers_.rows())
            ms += row.name == "physics" ? row.cpu_ms : 0;
        return ms;
    }

private:
    blades::SurfaceBlades grass_;
    gl::Buffer records_;
    wind::Wind wind_;
    terrain::Surface surface_;
    blades::Colliders colliders_;
    gl::PassTimers timers_;
    double canopy_m_;
};

/// Blades whose states are not the same bits.
double differing(const blades::SurfaceSimulation& a, const blades::SurfaceSimulation& b) {
    const auto one = a.pass().states().read_all<glm::vec4>(a.slots() * CULL_GROUP),
               other = b.pass().states().read_all<glm::vec4>(b.slots() * CULL_GROUP);
    double count = 0;
    for (std::size_t n = 0; n < one.size(); ++n)
        count += std::memcmp(&one[n], &other[n], sizeof(glm::vec4)) != 0;
    return count;
}

struct Compared {
    Spread three, one;
    double ratio; ///< median of the rounds': the two of a round met the same load of the machine
    double differ;
};

Compared compare(const scene::Scene& scene) {
    Field field(load_world(scene));
    auto three = field.simulation(blades::StepPrograms::kThree),
         one = field.simulation(blades::StepPrograms::kOne);
    std::vector<double> three_ms, one_ms, ratios;
    for (int step = 0; step < kRounds + 2; ++step) {
        const double time_s = step * blades::LivingBlades::kStep_s;
        const bool first = step % 2 == 0;
        double ms[2];
        ms[first ? 0 : 1] = field.step(first ? three : one, time_s);
        ms[first ? 1 : 0] = field.step(first ? one : three, time_s);
        if (step >= 2) {
            three_ms.push_back(ms[0]);
            one_ms.push_back(ms[1]);
            ratios.push_back(ms[0] / ms[1]);
        }
    }
    return {spread_of(three_ms), spread_of(one_ms), spread_of(ratios).median,
            differing(three, one)};
}

} // namespace

void bench_physics(BenchReport& report) {
    scene::Scene scene = near_scene("nature");
    for (const bool spheres : {true, false}) {
        if (!spheres)
            scene.objects.clear();
        const std::string name = spheres ? "nature" : "nature, no spheres";
        const Compared compared = compare(scene);
        report.rows.push_back({name, "three programs", "physics", compared.three, 0});
        report.rows.push_back({name, "one for all", "physics", compared.one, 0});
        report.figures.push_back({name, "three programs", "over one for all", compared.ratio, -1});
        report.checks.push_back(
            {"near: " + name + ", states that differ by the programs", compared.differ, 0});
        if (!spheres)
            report.checks.push_back({"near: physics without spheres, three programs over one",
                                     compared.ratio, kLeastGain});
    }
}

} // namespace sward::app
