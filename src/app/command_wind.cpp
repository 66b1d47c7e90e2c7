// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/io.h"
#include "app/output_names.h"
#include "app/parse.h"
#include "app/world_loader.h"
#include "base/file.h"
#include "base/log.h"
#include "gl/context.h"
#include "terrain/surface.h"
#include "wind/sources.h"
#include "wind/wind.h"

namespace sward::app {
namespace {

constexpr int kMostFrames = 999'999; // as render's --frames

/// The window's north-west cell first, rows from the north: what is stored around a torus, in the
/// order of a picture.
class Cells {
public:
    explicit Cells(const wind::Fluid& fluid) : grid_(fluid.grid()) {
        const auto count =
            static_cast<std::size_t>(grid_.cells) * static_cast<std::size_t>(grid_.cells);
        u_ = grid_.u->read_all<float>(count);
        v_ = grid_.v->read_all<float>(count);
        solid_ = grid_.solid->read_all<std::uint32_t>(count);
        centre_ = fluid.cells().read_all<glm::vec4>(count);
    }

    [[nodiscard]] const wind::FluidGrid& grid() const { return grid_; }
    [[nodiscard]] glm::vec2 velocity(int x, int z) const {
        const glm::vec4& cell = centre_[index(x, z)];
        return {cell.z, cell.w};
    }
    /// Both as the solver counts them; beyond the window's edge the edge goes on.
    [[nodiscard]] float divergence(int x, int z) const {
        return static_cast<float>((u(x + 1, z) - u(x, z) + v(x, z + 1) - v(x, z)) / grid_.cell_m);
    }
    [[nodiscard]] float vorticity(int x, int z) const {
        return 0.25f * (corner(x, z) + corner(x + 1, z) + corner(x, z + 1) + corner(x + 1, z + 1));
    }
    [[nodiscard]] float solid(int x, int z) const { return solid_[index(x, z)] != 0 ? 1.0f : 0.0f; }

private:
    [[nodiscard]] std::size_t index(int x, int z) const {
        const int n = grid_.cells;
        const int column = (std::clamp(x, 0, n - 1) + grid_.offset.x) % n,
                  row = (std::clamp(z, 0, n - 1) + grid_.offset.y) % n;
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(n) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] double u(int x, int z) const { return u_[index(x, z)]; }
    [[nodiscard]] double v(int x, int z) const { return v_[index(x, z)]; }
    /// methods.md W2: dv/dx - du/dz at a cell's north-west corner.
    [[nodiscard]] float corner(int x, int z) const {
        return static_cast<float>((v(x, z) - v(x - 1, z) - u(x, z) + u(x, z - 1)) / grid_.cell_m);
    }

    wind::FluidGrid grid_;
    std::vector<float> u_, v_;
    std::vector<std::uint32_t> solid_;
    std::vector<glm::vec4> centre_;
};

scene::Image image_of(const Cells& cells, double time_s) {
    const wind::FluidGrid& grid = cells.grid();
    scene::Image image;
    image.width = image.height = grid.cells;
    image.channels = {"u", "v", "vorticity", "divergence", "solid"};
    for (int z = 0; z < grid.cells; ++z)
        for (int x = 0; x < grid.cells; ++x) {
            const glm::vec2 velocity = cells.velocity(x, z);
            for (const float value : {velocity.x, velocity.y, cells.vorticity(x, z),
                                      cells.divergence(x, z), cells.solid(x, z)})
                image.texels.push_back(value);
        }
    image.metadata = {{"cell_m", fmt::format("{}", grid.cell_m)},
                      {"origin_x_m", fmt::format("{}", grid.origin_m.x)},
                      {"origin_z_m", fmt::format("{}", grid.origin_m.y)},
                      {"time_s", fmt::format("{}", time_s)}};
    return image;
}

/// Frames of `options`, as OutputNames and the checks of outputs take them.
Options with_frames(Options options) {
    if (options.every_s) {
        const double count = std::floor(options.time_s / *options.every_s + 1e-9);
        if (count > kMostFrames)
            throw option_error("--every", fmt::format("{}", *options.every_s),
                               fmt::format("at most {} pictures in --time", kMostFrames),
                               base::ExitCode::kOverLimit);
        options.frames = FrameRange{0, static_cast<int>(count)};
    } else if (options.output.native().find('%') != std::string::npos) {
        options.frames = FrameRange{0, 0};
    }
    return options;
}

/// Elevation is read when a path above the datum first asks for the ground, if one does.
wind::GroundHeight ground_of(const scene::Scene& scene) {
    auto surface = std::make_shared<std::optional<terrain::Surface>>();
    return [surface, &scene](double x, double z) {
        if (!scene.terrain.surface.empty())
            return 0.0; // as Renderer::ground_height
        if (!*surface)
            surface->emplace(load_elevation(scene.terrain), scene.terrain.detail_m);
        return (*surface)->height(x, z);
    };
}

} // namespace

void run_wind(const Options& given) {
    const Options options = with_frames(given);
    check_outputs(options);
    if (!is_linear(options.output))
        throw option_error("--output", options.output.string(), "a name that ends in .exr");
    scene::Scene scene = load_scene(options);
    settle_paths(scene);
    check_not_inputs(options, scene);
    const wind::Meshes meshes = load_meshes(scene);

    const gl::HeadlessContext context(options.debug_gl);
    auto sources = std::make_unique<wind::Sources>(scene, meshes, ground_of(scene));
    sources->keep_active(); // the ambient wind alone is worth a picture too
    wind::Wind wind(scene.wind, 0, std::move(sources));

    const OutputNames names(options);
    const FrameRange frames = options.frames.value_or(FrameRange{});
    std::optional<base::Progress> progress;
    if (options.every_s)
        progress.emplace("frames", static_cast<std::size_t>(frames.last + 1));
    for (int frame = frames.first; frame <= frames.last; ++frame) {
        const double time_s = options.every_s ? frame * *options.every_s : options.time_s;
        wind.advance(time_s, options.at);
        const wind::Window& window = *wind.window();
        make_parent(names.name(frame));
        write_linear(names.name(frame),
                     image_of(Cells(window.fluid()),
                              static_cast<double>(window.tag().latest) * window.tag().step_s));
        if (progress)
            progress->advance();
    }
}

} // namespace sward::app
