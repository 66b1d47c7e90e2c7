// SPDX-License-Identifier: Apache-2.0
// Structs that cross to the GPU lie in std140 and in std430 where C++ puts them, member by member.
#include <cstddef>
#include <map>

#include "gl/fixture.h"

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
    Members reflect(const std::string& type, const std::string& header, const std::string& layout, std::size_t& stride) const {
        shaders_.write("layout.comp", "#include \"shared/" + header + "\"\nlayout(local_size_x = 1) in;\nlayout(" + layout + ", binding = 0) buffer Probe { " +
                                          type + " probe[]; };\nvoid main() { probe[1] = probe[0]; }\n");
        const gl::Program program(type, {"layout.comp"});
        GLint count = 0;
        glGetProgramInterfaceiv(program.id(), GL_BUFFER_VARIABLE, GL_ACTIVE_RESOURCES, &count);
        Members found;
        for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
            char name[256];
            glGetProgramResourceName(program.id(), GL_BUFFER_VARIABLE, i, sizeof(name), nullptr, name);
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
    void expect_same(const std::string& type, const std::string& header, const Members& members, std::size_t bytes) const {
        for (const char* layout : {"std140", "std430"}) {
            std::size_t stride = 0;
            EXPECT_EQ(reflect(type, header, layout, stride), members) << type << " in " << layout;
            EXPECT_EQ(stride, bytes) << type << " in " << layout;
        }
    }
    ShaderCopy shaders_;
};

#define PLACE(member) {#member, offsetof(Struct, member)}

TEST_F(Layout, FrameConstants) {
    using Struct = shared::FrameConstants;
    expect_same("FrameConstants", "frame.h",
                {PLACE(clip_from_world), PLACE(world_from_clip), PLACE(eye), PLACE(focal_px), PLACE(lod_eye), PLACE(flutter_time), PLACE(patch_offset_m),
                 PLACE(patch_side_m), PLACE(canopy_m), PLACE(anchor_tile), PLACE(patch_variants), PLACE(far_levels), PLACE(offset_range_m), PLACE(density_scale),
                 PLACE(ground_takes_over), PLACE(anchor_height_m), PLACE(handover_mode), PLACE(forced_level), PLACE(far_alone), PLACE(height_coding),
                 PLACE(handover_band), PLACE(width_least_px), PLACE(width_span_px), PLACE(pose_band), PLACE(segment_px), PLACE(blade_width_m), PLACE(far_bands),
                 PLACE(picture_px), PLACE(clip_levels), PLACE(mask_mode), PLACE(clip), PLACE(looks), PLACE(light), PLACE(wind), PLACE(tracks), PLACE(soil),
                 PLACE(soil_cover), PLACE(rock), PLACE(moss), PLACE(litter), PLACE(mask_offset), PLACE(mask_per_m), PLACE(living_band), PLACE(page_blades),
                 PLACE(near_m), PLACE(anchor_x), PLACE(anchor_z), PLACE(unused_a), PLACE(unused_b)},
                sizeof(Struct));
}

TEST_F(Layout, PartsOfTheFrame) {
    {
        using Struct = shared::ClipLevel;
        expect_same("ClipLevel", "frame.h", {PLACE(offset), PLACE(per_m), PLACE(spacing_m)}, sizeof(Struct));
    }
    {
        using Struct = shared::FarBand;
        expect_same("FarBand", "frame.h", {PLACE(incoming), PLACE(outgoing)}, sizeof(Struct));
    }
    {
        using Struct = shared::FarShare;
        expect_same("FarShare", "frame.h", {PLACE(shells), PLACE(slices), PLACE(unused_a), PLACE(unused_b), PLACE(unused_c)}, sizeof(Struct));
    }
}

TEST_F(Layout, BlocksTilesAndInstances) {
    {
        using Struct = shared::TerrainBlock;
        expect_same("TerrainBlock", "frame.h", {PLACE(corner), PLACE(spacing_m), PLACE(level)}, sizeof(Struct));
    }
    {
        using Struct = shared::BlockSample;
        expect_same("BlockSample", "frame.h",
                    {PLACE(height_m), PLACE(density), PLACE(sun_cosine), PLACE(tint), PLACE(slope), PLACE(wind), PLACE(sway), PLACE(bend)}, sizeof(Struct));
    }
    {
        using Struct = shared::BladeTile;
        expect_same("BladeTile", "frame.h", {PLACE(corner), PLACE(end), PLACE(page), PLACE(lie), PLACE(unused_a), PLACE(unused_b), PLACE(unused_c)},
                    sizeof(Struct));
    }
}

} // namespace
} // namespace sward::tests
