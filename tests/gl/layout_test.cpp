// SPDX-License-Identifier: Apache-2.0
// Structs that cross to the GPU lie in std140 and in std430 where C++ puts them, member by member.
#include <cstddef>
#include <map>

#include "gl/fixture.h"
#include "shared/blade_pages.h"
#include "shared/blade_physics.h"
#include "shared/march_medium.h"
#include "shared/surface.h"
#include "shared/track.h"
#include "shared/wind_force.h"
#include "shared/wind_grid.h"
#include "shared/wind_solid.h"

namespace sward::tests {
namespace {

/// Members of a struct by their first names, with their places in C++.
using Members = std::map<std::string, std::size_t>;

GLint value_of(GLuint program, GLuint variable, GLenum what) {
    GLint value = -1;
    glGetProgramResourceiv(program, GL_BUFFER_VARIABLE, variable, 1, &what, 1, nullptr, &value);
    return value;
}

class Layout : public GlTest {
protected:
    /// The driver's places of the members of `type` from `header`; `stride`: of an array of it.
    Members reflect(const std::string& type, const std::string& header, const std::string& layout,
                    std::size_t& stride) const {
        shaders_.write("layout.comp", "#include \"shared/" + header +
                                          "\"\nlayout(local_size_x = 1) in;\nlayout(" + layout +
                                          ", binding = 0) buffer Probe { " + type +
                                          " probe[]; };\nvoid main() { probe[1] = probe[0]; }\n");
        const gl::Program program(type, {"layout.comp"});
        GLint count = 0;
        glGetProgramInterfaceiv(program.id(), GL_BUFFER_VARIABLE, GL_ACTIVE_RESOURCES, &count);
        Members found;
        for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
            char name[256];
            glGetProgramResourceName(program.id(), GL_BUFFER_VARIABLE, i, sizeof(name), nullptr,
                                     name);
            std::string member(name);
            member = member.substr(member.find('.') + 1); // after probe[0]
            member = member.substr(0, member.find_first_of(".["));
            const auto place = static_cast<std::size_t>(value_of(program.id(), i, GL_OFFSET));
            const auto [at, fresh] = found.emplace(member, place);
            at->second = std::min(at->second, place); // of a struct or an array: its first
            stride = static_cast<std::size_t>(value_of(program.id(), i, GL_TOP_LEVEL_ARRAY_STRIDE));
        }
        return found;
    }
    void expect_same(const std::string& type, const std::string& header, const Members& members,
                     std::size_t bytes) const {
        std::vector<std::string> layouts = {"std430"};
        if (bytes % 16 == 0) { // else std140 rounds it up: records of storage blocks alone
            layouts.emplace_back("std140");
        }
        for (const std::string& layout : layouts) {
            std::size_t stride = 0;
            EXPECT_EQ(reflect(type, header, layout, stride), members) << type << " in " << layout;
            EXPECT_EQ(stride, bytes) << type << " in " << layout;
        }
    }
    ShaderCopy shaders_;
};

#define PLACE(member)                                                                              \
    { #member, offsetof(Struct, member) }

TEST_F(Layout, FrameConstants) {
    {
        using Struct = shared::FrameConstants;
        expect_same("FrameConstants", "frame.h",
                    {PLACE(clip_from_world),
                     PLACE(world_from_clip),
                     PLACE(eye),
                     PLACE(focal_px),
                     PLACE(lod_eye),
                     PLACE(flutter_time),
                     PLACE(patch_offset_m),
                     PLACE(patch_side_m),
                     PLACE(canopy_m),
                     PLACE(anchor_tile),
                     PLACE(patch_variants),
                     PLACE(far_levels),
                     PLACE(offset_range_m),
                     PLACE(density_scale),
                     PLACE(ground_takes_over),
                     PLACE(anchor_height_m),
                     PLACE(handover_mode),
                     PLACE(forced_level),
                     PLACE(far_alone),
                     PLACE(height_coding),
                     PLACE(handover_band),
                     PLACE(width_least_px),
                     PLACE(width_span_px),
                     PLACE(pose_band),
                     PLACE(segment_px),
                     PLACE(blade_width_m),
                     PLACE(far_bands),
                     PLACE(picture_px),
                     PLACE(clip_levels),
                     PLACE(mask_mode),
                     PLACE(clip),
                     PLACE(looks),
                     PLACE(light),
                     PLACE(wind),
                     PLACE(tracks),
                     PLACE(soil),
                     PLACE(soil_cover),
                     PLACE(rock),
                     PLACE(moss),
                     PLACE(litter),
                     PLACE(mask_offset),
                     PLACE(mask_per_m),
                     PLACE(living_band),
                     PLACE(page_blades),
                     PLACE(near_m),
                     PLACE(anchor_x),
                     PLACE(anchor_z),
                     PLACE(unused_a),
                     PLACE(unused_b),
                     PLACE(air),
                     PLACE(shadow_offset),
                     PLACE(shadow_per_m),
                     PLACE(has_shadow),
                     PLACE(land_texel_m),
                     PLACE(land_highest),
                     PLACE(land_uneven)},
                    sizeof(Struct));
    }
}

TEST_F(Layout, FrameParts) {
    {
        using Struct = shared::ClipLevel;
        expect_same("ClipLevel", "frame.h", {PLACE(offset), PLACE(per_m), PLACE(spacing_m)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::FarBand;
        expect_same("FarBand", "frame.h", {PLACE(incoming), PLACE(outgoing)}, sizeof(Struct));
    }
    {
        using Struct = shared::FarShare;
        expect_same(
            "FarShare", "frame.h",
            {PLACE(shells), PLACE(slices), PLACE(unused_a), PLACE(unused_b), PLACE(unused_c)},
            sizeof(Struct));
    }
    {
        using Struct = shared::FarShares;
        expect_same("FarShares", "frame.h", {PLACE(steps)}, sizeof(Struct));
    }
}

TEST_F(Layout, BlocksTilesAndInstances) {
    {
        using Struct = shared::TerrainBlock;
        expect_same("TerrainBlock", "frame.h", {PLACE(corner), PLACE(spacing_m), PLACE(level)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::BlockSample;
        expect_same("BlockSample", "frame.h",
                    {PLACE(height_m), PLACE(density), PLACE(sun_cosine), PLACE(tint), PLACE(slope),
                     PLACE(wind), PLACE(sway), PLACE(bend)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::BladeTile;
        expect_same("BladeTile", "frame.h",
                    {PLACE(corner), PLACE(end), PLACE(page), PLACE(lie), PLACE(unused_a),
                     PLACE(unused_b), PLACE(unused_c)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::DrawCommand;
        expect_same("DrawCommand", "frame.h",
                    {PLACE(vertices), PLACE(instances), PLACE(first), PLACE(base_instance)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::FarInstance;
        expect_same("FarInstance", "frame.h",
                    {PLACE(place_m), PLACE(block), PLACE(along), PLACE(across), PLACE(image),
                     PLACE(planes), PLACE(axis), PLACE(level)},
                    sizeof(Struct));
    }
}

TEST_F(Layout, LightAndLooks) {
    {
        using Struct = shared::Light;
        expect_same("Light", "shading.h",
                    {PLACE(to_sun), PLACE(sun_extinction), PLACE(sun), PLACE(unused_a),
                     PLACE(zenith), PLACE(sky_extinction), PLACE(horizon), PLACE(unused_b)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::Air;
        expect_same("Air", "air.h",
                    {PLACE(to_sun), PLACE(molecules_per_m), PLACE(level_sun), PLACE(haze_per_m),
                     PLACE(molecules), PLACE(haze), PLACE(disc), PLACE(disc_radius), PLACE(sky)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::GrassGloss;
        expect_same("GrassGloss", "grass_layout.h",
                    {PLACE(diffuse), PLACE(diffuse_power), PLACE(specular), PLACE(specular_power)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::BladeOutline;
        expect_same("BladeOutline", "blade.h",
                    {PLACE(taper), PLACE(stalk), PLACE(head_from), PLACE(fullness)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::GrassAppearance;
        expect_same("GrassAppearance", "grass_layout.h",
                    {PLACE(root), PLACE(dry_share), PLACE(tip), PLACE(variation), PLACE(dry),
                     PLACE(translucency), PLACE(gloss), PLACE(head), PLACE(unused), PLACE(outline)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::MarchMedium;
        expect_same("MarchMedium", "march_medium.h",
                    {PLACE(edges), PLACE(layers), PLACE(level_tint), PLACE(steep_tint),
                     PLACE(views), PLACE(slopes), PLACE(gloss), PLACE(side_m), PLACE(canopy_m),
                     PLACE(translucency), PLACE(variants)},
                    sizeof(Struct));
    }
}

TEST_F(Layout, Wind) {
    {
        using Struct = shared::WindLayer;
        expect_same("WindLayer", "wind.h",
                    {PLACE(place), PLACE(turn), PLACE(weight), PLACE(cell_m), PLACE(unused_a),
                     PLACE(unused_b)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::WindField;
        expect_same("WindField", "wind.h",
                    {PLACE(mean), PLACE(response), PLACE(tile_cells), PLACE(layers),
                     PLACE(window_corner_m), PLACE(window_per_m), PLACE(window_cells),
                     PLACE(window_first), PLACE(window_share), PLACE(window_rim), PLACE(tile_share),
                     PLACE(unused_a), PLACE(unused_b), PLACE(unused_c)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::WindLevel;
        expect_same("WindLevel", "wind_grid.h",
                    {PLACE(stored), PLACE(cells), PLACE(row), PLACE(first), PLACE(unused_a),
                     PLACE(unused_b), PLACE(unused_c)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::WindGrid;
        expect_same("WindGrid", "wind_grid.h",
                    {PLACE(stored), PLACE(cells), PLACE(has_solids), PLACE(inner_first),
                     PLACE(inner_cells), PLACE(level_count), PLACE(cell_m), PLACE(per_m),
                     PLACE(step_s), PLACE(step_per_m), PLACE(confinement), PLACE(diffusion),
                     PLACE(kept), PLACE(brake_mps), PLACE(rim_cells), PLACE(mean), PLACE(rim_share),
                     PLACE(unused), PLACE(levels)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::WindForce;
        expect_same("WindForce", "wind_force.h",
                    {PLACE(place), PLACE(along), PLACE(radius_m), PLACE(reach_m), PLACE(speed_mps),
                     PLACE(rate_per_s), PLACE(velocity), PLACE(wave_number), PLACE(wave_phase),
                     PLACE(kind), PLACE(inflow), PLACE(unused_a), PLACE(unused_b)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::WindSolid;
        expect_same("WindSolid", "wind_solid.h",
                    {PLACE(place), PLACE(heading), PLACE(velocity), PLACE(half_size), PLACE(corner),
                     PLACE(bits), PLACE(bit_m), PLACE(first_word), PLACE(turn_rad_s), PLACE(kind)},
                    sizeof(Struct));
    }
}

TEST_F(Layout, BladesAndGround) {
    {
        using Struct = shared::BladeRecord;
        expect_same("BladeRecord", "blade.h", {PLACE(root), PLACE(v1), PLACE(v2), PLACE(shape)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::BladeStep;
        expect_same("BladeStep", "blade_physics.h",
                    {PLACE(down), PLACE(gravity_mps2), PLACE(centre), PLACE(centre_mps2),
                     PLACE(memory_loss), PLACE(memory_gain), PLACE(memory_most),
                     PLACE(centre_share), PLACE(step_s), PLACE(canopy_m), PLACE(response),
                     PLACE(run_up)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::BladePage;
        expect_same(
            "BladePage", "blade_pages.h",
            {PLACE(origin), PLACE(side_m), PLACE(first), PLACE(blades), PLACE(records), PLACE(lie)},
            sizeof(Struct));
    }
    {
        using Struct = shared::PatchState;
        expect_same("PatchState", "blade_pages.h", {PLACE(wind), PLACE(status), PLACE(steps)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::AwakePatch;
        expect_same("AwakePatch", "blade_pages.h",
                    {PLACE(page), PLACE(colliders), PLACE(number), PLACE(status)}, sizeof(Struct));
    }
    {
        using Struct = shared::SurfaceParams;
        expect_same("SurfaceParams", "surface.h",
                    {PLACE(posts), PLACE(post_m), PLACE(anchor), PLACE(first), PLACE(level),
                     PLACE(spacing_m), PLACE(relief_m), PLACE(detail_from_m), PLACE(zoom),
                     PLACE(unused_a), PLACE(unused_b), PLACE(unused_c)},
                    sizeof(Struct));
    }
}

TEST_F(Layout, Tracks) {
    {
        using Struct = shared::TrackField;
        expect_same("TrackField", "track_field.h",
                    {PLACE(place), PLACE(per_m), PLACE(left), PLACE(page), PLACE(table_mask),
                     PLACE(wave_mps), PLACE(least), PLACE(most), PLACE(wave_gain_m),
                     PLACE(unused_a), PLACE(unused_b), PLACE(unused_c)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::TrackPlace;
        expect_same("TrackPlace", "track.h", {PLACE(place), PLACE(heading)}, sizeof(Struct));
    }
    {
        using Struct = shared::TrackPrint;
        expect_same("TrackPrint", "track.h",
                    {PLACE(now), PLACE(before), PLACE(half_width_m), PLACE(half_depth_m),
                     PLACE(underside_m), PLACE(load), PLACE(kind), PLACE(map), PLACE(tilt)},
                    sizeof(Struct));
    }
    {
        using Struct = shared::TrackBlock;
        expect_same("TrackBlock", "track.h",
                    {PLACE(slot), PLACE(first_print), PLACE(prints), PLACE(own), PLACE(beside),
                     PLACE(first_cell), PLACE(slope)},
                    sizeof(Struct));
    }
}

#undef PLACE

} // namespace
} // namespace sward::tests
