// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "blades/draw_pass.h"
#include "render/mesh_pass.h"
#include "render/screen_passes.h"
#include "shells/far_pass.h"
#include "shells/march_pass.h"
#include "terrain/terrain_pass.h"

namespace sward::render {

/// Draw passes of one variant: with or without AOV outputs. Views of a field share them.
struct DrawPasses {
    DrawPasses(bool aov, bool block_shapes, bool surface, bool land)
        : terrain(aov, land), blades(aov),
          shells(shells::FarPass::Family::kShells, aov, block_shapes),
          slices(shells::FarPass::Family::kSlices, aov, block_shapes), march(aov, surface, land),
          screen(aov), meshes(aov) {}
    terrain::TerrainPass terrain;
    blades::DrawPass blades;
    shells::FarPass shells, slices;
    shells::MarchPass march;
    ScreenPasses screen;
    MeshPass meshes;
    /// The blades of a mesh; made when a scene has one.
    [[nodiscard]] blades::DrawPass& surface(bool aov);
    void reload(std::vector<std::string>& failures);

private:
    std::unique_ptr<blades::DrawPass> surface_;
};

} // namespace sward::render
